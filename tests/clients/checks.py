"""What the checks of this folder share; runs in the Python of ParaView, of Blender and of the system alike."""

import os
import sys

import numpy

SKIP = 77  # ctest's SKIP_RETURN_CODE of these tests

# The object of l_shape.toml: where its box is at t = 0, how it flies, what it is made of.
L_LOW, L_HIGH = numpy.array([0.1, 0.2, 0.3]), numpy.array([0.7, 1.2, 0.7])
L_VELOCITY = numpy.array([1.2, 2.4, 0.6])
L_SPACING = 0.0311  # m, between particles
L_FRAME_RATE, L_FRAMES = 24.0, 3
JELLY_COLOR = numpy.array([0.1, 0.55, 0.2])  # linear


def to_up(points, up):
    """Coordinates with y up to coordinates with `up` ("y" or "z") up: a turn about x."""
    points = numpy.asarray(points, dtype=float)
    return points if up == "y" else numpy.stack([points[..., 0], -points[..., 2], points[..., 1]], axis=-1)


def l_time(frame):
    return (frame - 1) / L_FRAME_RATE


def l_box(frame, up):
    """The corners of the L's box in a frame, with y or z up."""
    corners = to_up(numpy.stack([L_LOW, L_HIGH]) + L_VELOCITY * l_time(frame), up)
    return corners.min(axis=0), corners.max(axis=0)


def box_error(points, frame, up):
    """The largest difference between the box of the points and that of the L, in m."""
    points = numpy.asarray(points, dtype=float).reshape(-1, 3)
    low, high = l_box(frame, up)
    return max(numpy.abs(points.min(axis=0) - low).max(), numpy.abs(points.max(axis=0) - high).max())


class Checks:
    """Counts and prints checks; `finish` ends the program."""

    def __init__(self, title):
        self.title, self.passed, self.failed = title, 0, 0

    def that(self, condition, text):
        if condition:
            self.passed += 1
        else:
            self.failed += 1
        print(f"{'ok  ' if condition else 'FAIL'}  {text}", flush=True)
        return bool(condition)

    def equal(self, found, wanted, text):
        return self.that(found == wanted, f"{text}: {found}" + ("" if found == wanted else f", not {wanted}"))

    def near(self, found, wanted, tolerance, text):
        error = float(numpy.abs(numpy.asarray(found, dtype=float) - numpy.asarray(wanted, dtype=float)).max())
        return self.that(error <= tolerance, f"{text}: off by {error:.3g}, allowed {tolerance:.3g}")

    def l_lies_right(self, points, frame, up, tolerance, text):
        """Its box must fit in one orientation, and must not in the other one: else the check could not fail."""
        right, wrong = box_error(points, frame, up), box_error(points, frame, "z" if up == "y" else "y")
        self.that(right <= tolerance, f"{text}: box off by {right:.3g} m, allowed {tolerance:.3g} m")
        self.that(wrong > 0.2, f"{text}: with the other axis up it would be off by {wrong:.3g} m")

    def finish(self):
        print(f"{self.title}: {self.passed} checks passed, {self.failed} failed", flush=True)
        sys.stdout.flush()
        os._exit(1 if self.failed or not self.passed else 0)  # hosts have exit codes, and crashes at exit, of their own


def read_ply_points(path):
    """Vertices of a binary PLY file as a dictionary of arrays; written apart from the readers that are checked."""
    types = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4", "uint": "<u4", "short": "<i2", "ushort": "<u2", "char": "i1"}
    with open(path, "rb") as stream:
        names, formats, count, inside = [], [], 0, False
        while (line := stream.readline().split()) != [b"end_header"]:
            if not line:
                raise ValueError(f"{path}: no end of the header")
            if line[0] == b"element":
                inside = line[1] == b"vertex"
                count = int(line[2]) if inside else count
            elif line[0] == b"property" and inside:
                names.append(line[2].decode())
                formats.append(types[line[1].decode()])
        vertices = numpy.fromfile(stream, dtype={"names": names, "formats": formats}, count=count)
    return {name: vertices[name] for name in names}


def write_ply_points(path, columns):
    """Columns of (name, PLY type, values) as a binary PLY file."""
    types = {"float": "<f4", "double": "<f8", "uchar": "u1", "int": "<i4", "uint": "<u4"}
    count = len(columns[0][2])
    rows = numpy.empty(count, dtype=[(name, types[kind]) for name, kind, _ in columns])
    for name, _, values in columns:
        rows[name] = values
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {count}"]
    header += [f"property {kind} {name}" for name, kind, _ in columns] + ["end_header", ""]
    with open(path, "wb") as stream:
        stream.write("\n".join(header).encode() + rows.tobytes())
