#!/usr/bin/env python3
"""Exported files by readers that know nothing of Firn: plain_readers.py FILES

meshio reads PLY and OBJ, pyopenvdb volumes, numpy CSV, h5py the frames that they came from. Every number is compared, and in every file the
L must lie where the format or the client has it: Blender z up, Houdini y up, ParaView and CSV as in the scene (y), OBJ
always y up.
"""

import json
import pathlib
import sys

import h5py
import meshio
import numpy
import pyopenvdb
from checks import JELLY_COLOR, L_FRAMES, L_SPACING, L_VELOCITY, Checks, l_time, to_up

UPS = {"blender": "z", "houdini": "y", "paraview": "y"}


def frame_of(files, frame):
    with h5py.File(files / "l_shape" / "particles" / f"particles.{frame:04}.hdf") as file:
        data = {name: column[:] for name, column in file["VTKHDF/PointData"].items()}
        return file["VTKHDF/Points"][:], data


def check_points(checks, files):
    for client, up in UPS.items():
        for frame in range(1, L_FRAMES + 1):
            text = f"PLY for {client}, frame {frame}"
            mesh = meshio.read(files / client / f"particles.{frame:04}.ply")
            place, data = frame_of(files, frame)
            checks.that(numpy.array_equal(mesh.points.astype(numpy.float32), to_up(place, up).astype(numpy.float32)), f"{text}: positions equal")
            velocity = numpy.stack([mesh.point_data[name] for name in ("vx", "vy", "vz")], axis=1)
            checks.that(numpy.array_equal(velocity, to_up(data["velocity"], up).astype(numpy.float32)), f"{text}: velocities equal")
            same = all(numpy.array_equal(mesh.point_data[name], data[name]) for name in ("id", "material"))
            checks.that(same, f"{text}: ids and materials equal")
            first = numpy.argmax(data["body"] == 0)  # meshio 7.0 takes unsigned bytes for signed ones
            color = numpy.array([mesh.point_data[name].astype(numpy.uint8)[first] for name in ("red", "green", "blue")]) / 255
            linear = numpy.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)
            checks.near(linear, JELLY_COLOR, 0.005, f"{text}: colour")
            checks.l_lies_right(mesh.points, frame, up, 0.002, text)


def check_surfaces(checks, files):
    for client, up in UPS.items():
        for ending in ("obj", "ply"):
            for frame in range(1, L_FRAMES + 1):
                mesh = meshio.read(files / client / "surface" / f"surface.{frame:04}.{ending}")
                text = f"{ending.upper()} surface for {client}, frame {frame}"
                place = mesh.points[:, :3]  # meshio has the colours of OBJ files behind them
                checks.l_lies_right(place, frame, "y" if ending == "obj" else up, 0.6 * L_SPACING, text)
                if ending == "ply":
                    velocity = numpy.stack([mesh.point_data[name] for name in ("vx", "vy", "vz")], axis=1)
                    checks.near(velocity.mean(axis=0), to_up(L_VELOCITY, up), 0.01, f"{text}: mean velocity")


def voxels(grid, wanted):
    """Places of the voxels whose value fulfils a condition, and their values; of tiles the corners."""
    places, values = [], []
    for item in grid.iterOnValues():
        if wanted(item.value):
            for index in {item.min, item.max}:
                places.append(grid.transform.indexToWorld(index))
                values.append(item.value)
    return numpy.array(places), numpy.array(values)


def check_volumes(checks, files):
    cases = [("volume", "density", lambda value: value > 0.5), ("surface/surface", "surface", lambda value: value < 0)]
    for client, up in UPS.items():
        vector = "velocity" if client == "blender" else "v"
        for name, main, inside in cases:
            for frame in range(1, L_FRAMES + 1):
                path = files / client / f"{name}.{frame:04}.vdb"
                text = f"{main} for {client}, frame {frame}"
                grids = {grid.name: grid for grid in pyopenvdb.readAll(str(path))[0]}
                if checks.equal(sorted(grids), sorted([main, vector]), f"{text}: grids"):
                    checks.l_lies_right(voxels(grids[main], inside)[0], frame, up, 2 * L_SPACING, text)
                    velocities = voxels(grids[vector], lambda value: numpy.linalg.norm(value) > 0.1)[1]
                    checks.near(velocities.mean(axis=0), to_up(L_VELOCITY, up), 0.02, f"{text}: mean velocity")


def check_csv(checks, files):
    for frame in range(1, L_FRAMES + 1):
        path = files / "plain" / f"particles.{frame:04}.csv"
        table = numpy.genfromtxt(path, delimiter=",", names=True)
        place, data = frame_of(files, frame)
        at = numpy.stack([table[name] for name in "xyz"], axis=1)
        checks.that(numpy.array_equal(at.astype(numpy.float32), place), f"CSV, frame {frame}: positions equal to the last bit")
        missing = [name for name, column in data.items() if column.ndim == 1 and name not in table.dtype.names]
        checks.equal(missing, [], f"CSV, frame {frame}: columns that are not there")
        checks.l_lies_right(at, frame, "y", 0.002, f"CSV, frame {frame}")


def check_descriptions(checks, files):
    for client, up in UPS.items():
        told = json.loads((files / client / "particles.series.json").read_text(encoding="utf-8"))
        checks.equal((told["up"], told["frames_per_second"], told["materials"]), (up, 24, ["jelly", "snow"]), f"description for {client}")
        checks.near([file["time"] for file in told["files"]], [l_time(frame) for frame in range(1, L_FRAMES + 1)], 1e-12, f"times for {client}")


def main():
    files = pathlib.Path(sys.argv[1])
    checks = Checks("readers")
    check_points(checks, files)
    check_surfaces(checks, files)
    check_volumes(checks, files)
    check_csv(checks, files)
    check_descriptions(checks, files)
    checks.finish()


if __name__ == "__main__":
    main()
