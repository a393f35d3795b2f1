#!/usr/bin/env python3
"""Checks with NumPy alone that the L of l_shape.toml lies where it should: its box, and its velocity.

    check_l.py FILE y|z      the axis that is up in the file: .ply, .csv, .vtp or .obj
"""

import sys

import numpy

sys.path.insert(0, __file__.rsplit("/", 2)[0] + "/io")
import check_points


def read_obj(data):
    rows = numpy.array([[float(x) for x in line.split()[1:]] for line in data.decode().splitlines() if line[0] == "v"])
    assert rows.shape[1] == 6, "vertices without colours"
    return {"x": rows[:, 0], "y": rows[:, 1], "z": rows[:, 2], "red": 255 * rows[:, 3], "blue": 255 * rows[:, 5]}


def read_ply(data):
    head = data[: data.index(b"end_header\n")].decode()
    if "element face" not in head:
        return check_points.read_ply(data)[0]
    # As points: the header without faces, and as many bytes as the vertices take.
    lines = head.splitlines()
    kept = lines[: next(i for i, line in enumerate(lines) if line.startswith("element face"))]
    sizes = {"uchar": 1, "int": 4, "float": 4, "double": 8}
    row = sum(sizes[line.split()[1]] for line in kept[3:])
    start = data.index(b"end_header\n") + 11
    count = int(kept[2].split()[2])
    return check_points.read_ply("\n".join(kept + ["end_header\n"]).encode() + data[start : start + row * count])[0]


def close(values, expected, tolerance, what):
    assert numpy.allclose(values, expected, rtol=0, atol=tolerance), f"{what}: {values}, expected {expected}"


def main():
    path, up = sys.argv[1], sys.argv[2]
    data = open(path, "rb").read()
    if path.endswith("vtp"):
        # The reader of the sample wants the sample's time.
        start = data.index(b'Name="TimeValue"')
        begin, end = data.index(b">", start) + 1, data.index(b"<", start)
        assert float(data[begin:end]) == 0
        # As long as before, because offsets count bytes behind the XML only.
        columns = check_points.read_vtp(data[:begin] + b"0.125" + data[end:])[0]
    elif path.endswith("ply"):
        columns = read_ply(data)
    elif path.endswith("csv"):
        columns = check_points.read_csv(data)[0]
    else:
        columns = read_obj(data)
    x, y, z = (columns[name] for name in "xyz")
    low, high = [0, 0, 0], [0.6, 1, 0.3]
    velocity = [1, 2, 3]
    if up == "z":
        low, high = [0, -0.3, 0], [0.6, 0, 1]
        velocity = [1, -3, 2]
    close([x.min(), y.min(), z.min()], low, 0.03, "the lower corner")
    close([x.max(), y.max(), z.max()], high, 0.03, "the upper corner")
    if "vx" in columns:
        for name, expected in zip(("vx", "vy", "vz"), velocity):
            close(columns[name], expected, 1e-3, name)
    height, depth = (y, z) if up == "y" else (z, -y)
    assert (height[x > 0.25] < 0.25).all(), "the foot is not at the bottom"
    assert (height[depth > 0.22] < 0.25).all(), "the toe is not at the bottom"
    if "red" in columns:
        assert (columns["red"][height > 0.4] > 200).all(), "the leg is not red"
        assert (columns["blue"][depth > 0.28] > 150).all(), "the toe is not blue"
    return 0


if __name__ == "__main__":
    sys.exit(main())
