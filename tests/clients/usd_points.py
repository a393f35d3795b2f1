#!/usr/bin/env python3
"""tools/usd/firn_to_usd.py: what it writes is read back with OpenUSD and passes the rules of usdchecker.

    usd_points.py [USD_FILE_OF_THE_L PLY_FILE...]     the files that `firn export` made of l_shape.toml, y up

OpenUSD's usdchecker is a command around UsdValidation, in versions before 25.5 around UsdUtils.ComplianceChecker; the
wheel usd-core has these, not the command.
"""

import pathlib
import subprocess
import sys
import tempfile

import numpy
from checks import L_FRAME_RATE, L_VELOCITY, Checks, l_box, read_ply_points, write_ply_points
from pxr import Sdf, Usd, UsdGeom, UsdUtils

TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "usd" / "firn_to_usd.py"


def complaints(path):
    """What usdchecker has to say about a file."""
    try:
        from pxr import UsdValidation
    except ImportError:
        checker = UsdUtils.ComplianceChecker(skipARKitRootLayerCheck=True)
        checker.CheckCompliance(str(path))
        return checker.GetErrors() + checker.GetFailedChecks() + checker.GetWarnings()
    registry = UsdValidation.ValidationRegistry()
    context = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators())
    return [f"{error.GetName()}: {error.GetMessage()}" for error in context.Validate(Usd.Stage.Open(str(path)))]


def convert(*arguments):
    return subprocess.run([sys.executable, str(TOOL), *map(str, arguments)], capture_output=True, text=True)


def points_of(stage):
    return UsdGeom.Points(stage.GetPrimAtPath("/Firn/points"))


def linear(byte):
    value = byte / 255.0
    return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4


def check_stage(checks, stage, up, fps, first, last):
    checks.equal(str(UsdGeom.GetStageUpAxis(stage)), up, "upAxis")
    checks.equal(UsdGeom.GetStageMetersPerUnit(stage), 1.0, "metersPerUnit")
    checks.equal(stage.GetTimeCodesPerSecond(), fps, "timeCodesPerSecond")
    checks.equal((stage.GetStartTimeCode(), stage.GetEndTimeCode()), (first, last), "time codes")
    checks.equal(str(stage.GetDefaultPrim().GetPath()), "/Firn", "defaultPrim")


def check_growing_cloud(checks, folder):
    """Numbers that grow from none, ids as doubles, radius, colour and a scalar of one's own."""
    random = numpy.random.default_rng(1)
    files, frames = [], []
    for number, count in enumerate((0, 5, 9, 7), 1):
        files.append(folder / f"cloud.{number:04}.ply")
        frame = {name: random.normal(size=count).astype(numpy.float32) for name in ("x", "y", "z", "vx", "vy", "vz", "heat")}
        frame["id"] = random.permutation(100)[:count].astype(float)
        frame["radius"] = random.uniform(0.01, 0.02, count).astype(numpy.float32)
        for name in ("red", "green", "blue"):
            frame[name] = random.integers(0, 256, count).astype(numpy.uint8)
        kinds = {"id": "double", "red": "uchar", "green": "uchar", "blue": "uchar"}
        write_ply_points(files[-1], [(name, kinds.get(name, "float"), values) for name, values in frame.items()])
        frames.append(frame)
    target = folder / "cloud.usdc"
    times = [0.0, 0.04, 0.08, 0.12]
    result = convert("--ply", *files, "--times", *times, "--fps", 25, "--up", "Z", "-o", target)
    checks.equal(result.returncode, 0, f"converts four files ({result.stderr.strip()})")
    checks.equal(complaints(target), [], "usdchecker's complaints about a cloud that grows")
    stage = Usd.Stage.Open(str(target))
    check_stage(checks, stage, "Z", 25.0, 1.0, 4.0)
    points = points_of(stage)
    for number, frame in enumerate(frames, 1):
        check_sample(checks, points, number, frame, f"frame {number} of {len(frame['x'])} points")
        widths = numpy.array(points.GetWidthsAttr().Get(number))
        checks.that(numpy.array_equal(widths, 2 * frame["radius"]), f"frame {number}: widths are diameters")
        heat = numpy.array(UsdGeom.PrimvarsAPI(points).GetPrimvar("heat").Get(number))
        checks.that(numpy.array_equal(heat, frame["heat"]), f"frame {number}: a scalar of one's own is a primvar")
    cache = UsdGeom.BBoxCache(Usd.TimeCode(1), [UsdGeom.Tokens.default_])
    checks.that(cache.ComputeWorldBound(stage.GetDefaultPrim()).GetRange().IsEmpty(), "a frame without points has an empty box")
    return target


def check_plain_cloud(checks, folder):
    """One width for all, ids of the other types, neither velocities nor colours: what is not there is not written."""
    for kind in ("int", "uint", "double"):
        ply, target = folder / f"{kind}.ply", folder / f"{kind}.usda"
        ids = numpy.array([7, 3, 2**31 - 1])
        write_ply_points(ply, [("id", kind, ids), *((name, "float", numpy.array([1, 2, 4])) for name in "xyz")])
        result = convert("--ply", ply, "--times", 0.5, "--fps", 24, "--widths", 0.25, "-o", target)
        checks.equal((result.returncode, complaints(target)), (0, []), f"converts ids of the type {kind}")
        stage = Usd.Stage.Open(str(target))
        points = points_of(stage)
        checks.equal(list(points.GetIdsAttr().Get(13)), ids.tolist(), f"ids of the type {kind}, at time code 13")
        checks.equal((list(points.GetWidthsAttr().Get()), str(points.GetWidthsInterpolation())), ([0.25], "constant"), "widths")
        checks.near(points.GetExtentAttr().Get(13), [[0.875] * 3, [4.125] * 3], 1e-6, "extent has the widths in it")
        checks.equal((points.GetVelocitiesAttr().HasAuthoredValue(), points.GetDisplayColorAttr().HasAuthoredValue()),
                     (False, False), "no velocities and no colours out of nothing")


def check_sample(checks, points, code, frame, text):
    """The sample at a time code is the frame, value by value."""
    stacked = {key: numpy.stack([frame[name] for name in names], axis=1) for key, names in
               (("points", "xyz"), ("velocities", ("vx", "vy", "vz")))}
    shape = lambda value: numpy.array(value).reshape(-1, 3)  # noqa: E731
    checks.that(numpy.array_equal(shape(points.GetPointsAttr().Get(code)), stacked["points"]), f"{text}: points")
    checks.that(numpy.array_equal(shape(points.GetVelocitiesAttr().Get(code)), stacked["velocities"]), f"{text}: velocities")
    checks.that(numpy.array_equal(numpy.array(points.GetIdsAttr().Get(code)), frame["id"].astype(numpy.int64)), f"{text}: ids")
    if "red" in frame:
        color = shape(points.GetDisplayColorPrimvar().Get(code))
        wanted = [[linear(byte) for byte in row] for row in zip(frame["red"], frame["green"], frame["blue"])]
        checks.near(color if len(color) else 0, wanted if wanted else 0, 1e-6, f"{text}: displayColor is linear")
    if len(frame["x"]):
        width = 2 * frame["radius"] if "radius" in frame else points.GetWidthsAttr().Get()[0]
        low = (stacked["points"].T - width / 2).min(axis=1)
        high = (stacked["points"].T + width / 2).max(axis=1)
        checks.near(shape(points.GetExtentAttr().Get(code)), [low, high], 1e-5, f"{text}: extent")


def check_l(checks, usd, plys):
    checks.equal(complaints(usd), [], "usdchecker's complaints about the L")
    stage = Usd.Stage.Open(str(usd))
    check_stage(checks, stage, "Y", L_FRAME_RATE, 1.0, float(len(plys)))
    points = points_of(stage)
    for number, ply in enumerate(plys, 1):
        frame = read_ply_points(ply)
        checks.that(len(frame["x"]) > 3000, f"frame {number} has {len(frame['x'])} points")
        check_sample(checks, points, number, frame, f"the L, frame {number}")
        place = numpy.array(points.GetPointsAttr().Get(number))
        checks.l_lies_right(place, number, "y", 0.002, f"the L, frame {number}")
        checks.near(numpy.array(points.GetVelocitiesAttr().Get(number)).mean(axis=0), L_VELOCITY, 1e-3, "mean velocity")
    middle = points.ComputePointsAtTime(1.5, 1.0)  # what a renderer does for motion blur, from velocities
    low, high = l_box(1.5, "y")
    checks.near(numpy.array(middle).min(axis=0), low, 0.002, "between frames the velocities carry the points")
    width = points.GetWidthsAttr().Get(1)
    checks.that(0.01 < width[0] < 0.06, f"widths are diameters of particles: {width[0]:.4f} m")


def check_refusals(checks, folder, good):
    """The rules find what is wrong, and so does the program."""
    for field, text in ((UsdGeom.Tokens.metersPerUnit, "metersPerUnit"), ("defaultPrim", "defaultPrim")):
        layer = Sdf.Layer.FindOrOpen(str(good))
        bad = folder / f"without_{text}.usda"
        layer.Export(str(bad))
        layer = Sdf.Layer.FindOrOpen(str(bad))
        layer.pseudoRoot.ClearInfo(field)
        layer.Save()
        checks.that(complaints(bad), f"usdchecker complains about a file without {text}")
    ply = folder / "cloud.0002.ply"
    common = ["--times", 0, "--fps", 24, "-o", folder / "bad.usdc"]
    cut = folder / "cut.ply"
    cut.write_bytes(ply.read_bytes()[:-1])
    text_ply = folder / "text.ply"
    text_ply.write_text("ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n")
    flat = folder / "flat.ply"
    write_ply_points(flat, [("x", "float", [1]), ("y", "float", [1])])
    cases = [
        (["--ply", folder / "none.ply", *common], 2, "cannot be read"),
        (["--ply", cut, *common], 2, "cut short"),
        (["--ply", text_ply, *common], 2, "binary_little_endian"),
        (["--ply", flat, *common], 2, "no vertices with x, y and z"),
        (["--ply", ply, "--times", 0, 1, "--fps", 24, "-o", "a.usdc"], 2, "2 times"),
        (["--ply", ply, ply, "--times", 1, 1, "--fps", 24, "-o", "a.usdc"], 2, "must grow"),
        (["--ply", ply, "--times", 0, "--fps", 0, "-o", "a.usdc"], 2, "positive"),
        (["--ply", ply, "--times", 0, "--fps", 24, "-o", "a.abc"], 2, ".usdc"),
        (["--ply", ply, "--times", 0, "--fps", 24, "-o", ply / "bad.usdc"], 3, "cannot be written"),
    ]
    for arguments, code, words in cases:
        result = convert(*arguments)
        checks.that(result.returncode == code and words in result.stderr,
                    f"refuses with {code}: {result.stderr.strip().splitlines()[-1] if result.stderr else 'no text'}")
    checks.equal([path.name for path in folder.glob("*bad*")] + [path.name for path in folder.glob("*part*")], [],
                 "refusals leave no file")


def main():
    checks = Checks("usd")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        good = check_growing_cloud(checks, folder)
        check_plain_cloud(checks, folder)
        check_refusals(checks, folder, good)
        if len(sys.argv) > 1:
            check_l(checks, sys.argv[1], sys.argv[2:])
    checks.finish()


if __name__ == "__main__":
    main()
