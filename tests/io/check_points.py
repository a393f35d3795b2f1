#!/usr/bin/env python3
"""Reads exported points with NumPy alone, compares them with the sample, writes them again and compares the bytes.

    check_points.py FILE PARTICLES

The sample is sample_snapshot() of frame_samples.h, with PARTICLES of the first material.
"""

import re
import sys

import numpy


def read_ply(data):
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:end].decode().splitlines()
    assert lines[:2] == ["ply", "format binary_little_endian 1.0"], lines[:2]
    count = int(lines[2].removeprefix("element vertex "))
    types = {"uchar": "u1", "int": "<i4", "float": "<f4", "double": "<f8"}
    fields = [(line.split()[2], types[line.split()[1]]) for line in lines[3:-1]]
    rows = numpy.frombuffer(data, numpy.dtype(fields), count, end)
    assert end + rows.nbytes == len(data), "bytes behind the last point"
    again = data[:end] + rows.tobytes()
    return {name: rows[name] for name, _ in fields}, again


def read_csv(data):
    lines = data.decode().splitlines()
    names = lines[0].split(",")
    rows = [line.split(",") for line in lines[1:]]
    assert all(len(row) == len(names) for row in rows)
    columns = {name: numpy.array([float(row[i]) for row in rows]) for i, name in enumerate(names)}
    again = "\n".join([",".join(names)] + [",".join(row) for row in rows]).encode() + b"\n"
    return columns, again


def read_vtp(data):
    start = data.index(b'<AppendedData encoding="raw">\n_') + len(b'<AppendedData encoding="raw">\n_')
    xml = data[:start].decode()
    assert 'byte_order="LittleEndian" header_type="UInt64"' in xml
    types = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8", "UInt8": "u1"}
    pattern = r'<DataArray type="(\w+)" Name="([^"]*)" NumberOfComponents="(\d+)" format="appended" offset="(\d+)"/>'
    arrays, again = {}, data[:start]
    for kind, name, components, offset in re.findall(pattern, xml):
        at = start + int(offset)
        assert len(again) == at, "a gap before " + name
        size = int(numpy.frombuffer(data, "<u8", 1, at)[0])
        values = numpy.frombuffer(data, types[kind], size // numpy.dtype(types[kind]).itemsize, at + 8)
        again += numpy.uint64(size).tobytes() + values.tobytes()
        arrays[name] = values.reshape(-1, int(components))
    points = int(re.search(r'NumberOfPoints="(\d+)"', xml)[1])
    verts = int(re.search(r'NumberOfVerts="(\d+)"', xml)[1])
    assert verts == (1 if points else 0)
    assert arrays["connectivity"].ravel().tolist() == list(range(points))
    assert arrays["offsets"].ravel().tolist() == ([points] if points else [])
    assert float(re.search(r'Name="TimeValue"[^>]*>([^<]*)<', xml)[1]) == 0.125
    columns = {}
    for name, values in arrays.items():
        for c in range(values.shape[1]):
            axis = "xyz"[c] if values.shape[1] == 3 else ""
            short = {"Points": axis, "velocity": "v" + axis}.get(name, name + ("" if values.shape[1] == 1 else f"_{c}"))
            columns[short] = values[:, c]
    return columns, again + data[len(again):]


def main():
    path, count = sys.argv[1], int(sys.argv[2])
    data = open(path, "rb").read()
    read = {"ply": read_ply, "csv": read_csv, "vtp": read_vtp}[path.rsplit(".", 1)[1]]
    columns, again = read(data)
    assert again == data, "written again, the bytes differ"
    total = count + count // 2
    i = numpy.arange(total)
    single = lambda values: values.astype(numpy.float32)
    for c, axis in enumerate("xyz"):
        assert numpy.array_equal(columns[axis], single(i + 0.25 * c)), axis
        velocity = -i.astype(float) / 3 + c
        stored = columns["v" + axis]
        expected = single(velocity) if path.endswith("ply") else velocity
        assert numpy.array_equal(stored, expected), "v" + axis
    assert numpy.array_equal(columns["id"].astype(numpy.int64), (1 << 40) + i), "id"
    assert numpy.array_equal(columns["material"], (i >= count).astype(int)), "material"
    assert numpy.array_equal(columns["pressure"].astype(numpy.float32), single(1e5 - i)), "pressure"


if __name__ == "__main__":
    main()
