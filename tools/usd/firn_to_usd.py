#!/usr/bin/env python3
"""Point clouds from PLY files to one USD file with time samples.

    python3 firn_to_usd.py --ply points.0001.ply points.0002.ply --times 0 0.0416666 --fps 24 --up Y -o points.usdc

Needs the Python packages usd-core and numpy: python3 -m pip install usd-core numpy

Reads binary little-endian PLY files as `firn export` writes them: x y z, and as far as they are there vx vy vz (m/s),
id, radius, red green blue (sRGB bytes), and any other scalar. Writes one UsdGeom.Points prim, /Firn/points:

- points, velocities (per second, as USD wants them), ids, widths (diameters), displayColor (linear), extent; every other
  scalar of the files as a primvar of its name. All have samples at the same time codes, one per file, so that the
  number of points may change from frame to frame.
- Frame 1 is t = 0: the time code of a file is its time * fps + 1, and timeCodesPerSecond is fps.
- Coordinates are taken as they are; --up says which axis of theirs points up.

Ends with 0; with 2 for a wrong command line or a file that it cannot use, 3 if the result cannot be written, and 5 if a
package is missing. The result appears under its name only when it is complete.
"""

import argparse
import os
import pathlib
import sys

PLY_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip
COLORS = ("red", "green", "blue")
VELOCITY = ("vx", "vy", "vz")
SPOKEN_FOR = {"x", "y", "z", *VELOCITY, "id", "radius", *COLORS, "alpha"}
SAVE_EVERY_BYTES = 512 << 20  # samples wait in memory until then


class Refusal(Exception):
    """A file that cannot be used: the message says which, where and why."""


def read_ply(path):
    """The vertices of a binary little-endian PLY file as a structured array, a field per property."""
    import numpy

    try:
        data = pathlib.Path(path).read_bytes()
    except OSError as error:
        raise Refusal(f"{path}: cannot be read: {error.strerror}") from error
    end = data.find(b"end_header\n")
    if not data.startswith(b"ply\n") or end < 0:
        raise Refusal(f"{path}: not a PLY file, or one without the end of its header")
    count, fields, element, binary = None, [], None, False
    for number, line in enumerate(data[:end].decode("latin-1").splitlines(), 1):
        words = line.split()
        if not words or words[0] in ("ply", "comment", "obj_info"):
            continue
        where = f"{path}:{number}: "
        if words[0] == "format":
            binary = words[1:] == ["binary_little_endian", "1.0"]
        elif words[0] == "element" and len(words) == 3 and words[2].isdigit():
            if element is None and words[1] != "vertex":
                raise Refusal(f'{where}the first element is "{words[1]}", not "vertex"')
            element = words[1]
            count = int(words[2]) if element == "vertex" else count
        elif words[0] == "property" and element == "vertex":
            if len(words) != 3 or words[1] not in PLY_TYPES:
                raise Refusal(f'{where}vertices with "{line}" cannot be read; only scalars can')
            if words[2] in (name for name, _ in fields):
                raise Refusal(f'{where}the property "{words[2]}" is there twice')
            fields.append((words[2], "<" + PLY_TYPES[words[1]]))
        elif words[0] != "property":
            raise Refusal(f'{where}"{line}" is not a line of a PLY header')
    if not binary:
        raise Refusal(f"{path}: only PLY files in binary_little_endian are read")
    if count is None or not {"x", "y", "z"} <= {name for name, _ in fields}:
        raise Refusal(f"{path}: has no vertices with x, y and z")
    layout = numpy.dtype(fields)
    start = end + len(b"end_header\n")
    if len(data) - start < count * layout.itemsize:
        raise Refusal(f"{path}: cut short: {count} vertices need {count * layout.itemsize} bytes, {len(data) - start} are there")
    return numpy.frombuffer(data, layout, count, start)


def stack(vertices, names):
    import numpy

    return numpy.stack([vertices[name].astype(numpy.float32) for name in names], axis=1)


def linear(color):
    """sRGB bytes to the linear values that USD's displayColor holds."""
    import numpy

    value = color.astype(numpy.float64) / 255
    return numpy.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4).astype(numpy.float32)


def time_code(time, fps):
    """Frame 1 is t = 0; a whole number where rounding of the time is all that keeps it from one."""
    code = time * fps + 1
    return float(round(code)) if abs(code - round(code)) < 1e-4 else code


class PointsWriter:
    """One UsdGeom.Points prim that gets a sample of all its attributes per frame."""

    def __init__(self, stage, prim_path, layout, width):
        from pxr import UsdGeom

        self.points = UsdGeom.Points.Define(stage, prim_path)
        self.layout, self.width = layout, width
        self.velocities = all(name in layout.names for name in VELOCITY)
        self.colored = all(name in layout.names for name in COLORS)
        self.primvars = {}
        if "radius" not in layout.names and width is not None:
            from pxr import Vt

            self.points.CreateWidthsAttr(Vt.FloatArray([width]))
            self.points.SetWidthsInterpolation(UsdGeom.Tokens.constant)
        elif "radius" in layout.names:
            self.points.SetWidthsInterpolation(UsdGeom.Tokens.vertex)
        if self.colored:
            self.color = self.points.CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex)
        for name in layout.names:
            if name not in SPOKEN_FOR:
                self.primvars[name] = self.create_primvar(name)

    def create_primvar(self, name):
        from pxr import Sdf, Tf, UsdGeom

        whole = self.layout[name].kind in "iu"
        kind = Sdf.ValueTypeNames.IntArray if whole else Sdf.ValueTypeNames.FloatArray
        interface = UsdGeom.PrimvarsAPI(self.points)
        return interface.CreatePrimvar(Tf.MakeValidIdentifier(name), kind, UsdGeom.Tokens.vertex)

    def add(self, vertices, code):
        """Returns the bytes that the samples hold."""
        import numpy
        from pxr import Vt

        place = stack(vertices, "xyz")
        radius = numpy.float32((self.width or 0) / 2)
        self.points.CreatePointsAttr().Set(Vt.Vec3fArray.FromNumpy(place), code)
        if self.velocities:
            self.points.CreateVelocitiesAttr().Set(Vt.Vec3fArray.FromNumpy(stack(vertices, VELOCITY)), code)
        if "id" in self.layout.names:
            ids = numpy.rint(vertices["id"]).astype(numpy.int64)
            self.points.CreateIdsAttr().Set(Vt.Int64Array.FromNumpy(ids), code)
        if "radius" in self.layout.names:
            radius = vertices["radius"].astype(numpy.float32)[:, None]
            self.points.CreateWidthsAttr().Set(Vt.FloatArray.FromNumpy(2 * radius[:, 0]), code)
        if self.colored:
            color = linear(numpy.stack([vertices[name] for name in COLORS], axis=1))
            self.color.Set(Vt.Vec3fArray.FromNumpy(color), code)
        for name, primvar in self.primvars.items():
            whole = self.layout[name].kind in "iu"
            kind, array = (numpy.int32, Vt.IntArray) if whole else (numpy.float32, Vt.FloatArray)
            primvar.Set(array.FromNumpy(vertices[name].astype(kind)), code)
        if len(vertices) > 0:
            extent = numpy.stack([(place - radius).min(axis=0), (place + radius).max(axis=0)])
        else:  # an empty range: its least corner lies above its greatest one
            extent = numpy.array([[1], [-1]], numpy.float32) * numpy.full(3, numpy.finfo(numpy.float32).max)
        self.points.CreateExtentAttr().Set(Vt.Vec3fArray.FromNumpy(extent), code)
        return 8 * len(vertices) * len(self.layout.names)


def convert(options, target):
    from pxr import Usd, UsdGeom

    first = read_ply(options.ply[0])
    codes = [time_code(time, options.fps) for time in options.times]
    stage = Usd.Stage.CreateNew(str(target))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y if options.up == "Y" else UsdGeom.Tokens.z)
    UsdGeom.SetStageMetersPerUnit(stage, options.meters_per_unit)
    stage.SetTimeCodesPerSecond(options.fps)
    stage.SetFramesPerSecond(options.fps)
    stage.SetStartTimeCode(codes[0])
    stage.SetEndTimeCode(codes[-1])
    root = UsdGeom.Xform.Define(stage, "/Firn")
    stage.SetDefaultPrim(root.GetPrim())
    root.GetPrim().SetMetadata("comment", "A simulation by Firn; frame 1 is t = 0, lengths in metres times metersPerUnit")
    writer = PointsWriter(stage, "/Firn/points", first.dtype, options.widths)
    waiting = 0
    for path, code in zip(options.ply, codes):
        vertices = read_ply(path)
        if vertices.dtype.names != first.dtype.names:
            raise Refusal(f"{path}: has the properties {', '.join(vertices.dtype.names)}; "
                          f"{options.ply[0]} has {', '.join(first.dtype.names)}")
        waiting += writer.add(vertices, code)
        if waiting > SAVE_EVERY_BYTES:
            stage.GetRootLayer().Save()
            waiting = 0
    stage.GetRootLayer().Save()


def positive(text):
    value = float(text)
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text} is not a positive number")
    return value


def parse_options(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ply", nargs="+", required=True, metavar="FILE", help="a file per frame, in their order in time")
    parser.add_argument("--times", nargs="+", type=float, required=True, metavar="T", help="their times, in s")
    parser.add_argument("--fps", type=positive, required=True, help="frames per second")
    parser.add_argument("--up", choices=("Y", "Z"), default="Y", help="the axis of the coordinates that points up")
    parser.add_argument("--meters-per-unit", type=positive, default=1, help="1 for coordinates in m, which is what Firn writes")
    parser.add_argument("--widths", type=positive, help="diameter of all points, in m; a radius in the files comes first")
    parser.add_argument("-o", "--output", required=True, help="a new .usdc, .usda or .usd file")
    options = parser.parse_args(arguments)
    if len(options.ply) != len(options.times):
        parser.error(f"{len(options.ply)} files, but {len(options.times)} times")
    if any(not late > early for early, late in zip(options.times, options.times[1:])):
        parser.error("the times must grow from file to file")
    if pathlib.Path(options.output).suffix not in (".usdc", ".usda", ".usd"):
        parser.error(f"{options.output}: the name must end in .usdc, .usda or .usd")
    return options


def main(arguments=None):
    options = parse_options(arguments)
    try:
        import numpy  # noqa: F401
        import pxr  # noqa: F401
    except ImportError as error:
        print(f'firn_to_usd: needs the Python package "{error.name}", which {sys.executable} does not have; '
              f"install it with: {sys.executable} -m pip install usd-core numpy", file=sys.stderr)
        return 5
    from pxr import Tf

    target = pathlib.Path(options.output)
    part = target.with_name(f"{target.stem}.part{os.getpid()}{target.suffix}")
    try:
        convert(options, part)
        os.replace(part, target)
    except Refusal as refusal:
        print(f"firn_to_usd: {refusal}", file=sys.stderr)
        return 2
    except (OSError, Tf.ErrorException) as error:
        print(f"firn_to_usd: {target}: cannot be written: {' '.join(str(error).split())}", file=sys.stderr)
        return 3
    finally:
        if part.exists():
            part.unlink()
    print(f"firn_to_usd: {target}: {len(options.ply)} frames")
    return 0


if __name__ == "__main__":
    sys.exit(main())
