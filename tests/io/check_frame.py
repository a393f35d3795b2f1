"""Checks a frame file of frame_samples.h with h5py, an independent reader: check_frame.py FILE COUNT."""

import sys

import h5py
import numpy as np


def strings(dataset):
    return [value.decode("utf-8") for value in dataset[:]]


def main(path, count):
    total = count + count // 2
    index = np.arange(total)
    with h5py.File(path, "r") as file:
        grid = file["VTKHDF"]
        assert list(grid.attrs["Version"]) == [1, 0]
        kind = grid.attrs.get_id("Type").get_type()
        assert not kind.is_variable_str() and kind.get_cset() == h5py.h5t.CSET_ASCII
        assert grid.attrs["Type"] == b"UnstructuredGrid"
        for name, value in (("NumberOfPoints", total), ("NumberOfConnectivityIds", total), ("NumberOfCells", 2)):
            assert grid[name].shape == (1,) and grid[name][0] == value, name
        assert grid["Connectivity"].dtype == np.int64 and np.array_equal(grid["Connectivity"], index)
        assert grid["Offsets"].dtype == np.int64 and list(grid["Offsets"]) == [0, count, total]
        assert grid["Types"].dtype == np.uint8 and list(grid["Types"]) == [2, 2]

        told = {name: grid["FieldData"][name] for name in ("TimeValue", "particle_spacing", "dimension")}
        assert all(array.shape == (1,) for array in told.values())
        assert told["TimeValue"][0] == 0.125 and told["dimension"][0] == 3 and told["particle_spacing"][0] == 0.01

        points = grid["Points"]
        assert points.dtype == np.float32 and points.shape == (total, 3)
        assert np.array_equal(points, index[:, None] + 0.25 * np.arange(3))
        data = grid["PointData"]
        assert sorted(data) == ["F", "body", "id", "material", "pressure", "velocity"]
        assert data["velocity"].dtype == np.float64
        assert np.array_equal(data["velocity"], -index[:, None] / 3 + np.arange(3))
        assert data["id"].dtype == np.int64 and np.array_equal(data["id"], 2**40 + index)
        assert data["material"].dtype == np.int32 and np.array_equal(data["material"], index >= count)
        assert data["body"].dtype == np.int32 and np.array_equal(data["body"], index % 2)
        assert data["F"].shape == (total, 9) and np.allclose(data["F"], np.arange(9) + np.sin(index)[:, None], atol=1e-5)
        assert np.array_equal(data["pressure"], np.float32(1e5) - index.astype(np.float32))
        for dataset in [points, grid["Offsets"], *data.values()]:
            assert dataset.fletcher32 and dataset.shuffle and dataset.compression == "gzip", dataset.name

        firn = file["Firn"]
        assert firn.attrs["format_version"] == 1 and firn.attrs["frame"] == 6 and firn.attrs["time"] == 0.125
        assert firn.attrs["dimension"] == 3 and firn.attrs["cell_size"] == 0.02
        assert strings(firn["columns/name"]) == ["position", "velocity", "id", "body", "material", "F", "pressure"]
        assert strings(firn["columns/unit"]) == ["m", "m/s", "", "", "", "", "Pa"]
        assert strings(firn["materials/name"]) == ["powder", "gelée"]
        assert strings(firn["materials/model"]) == ["snow", "neo_hookean"]
        assert strings(firn["bodies"]) == ["cube", "ball"]


main(sys.argv[1], int(sys.argv[2]))
