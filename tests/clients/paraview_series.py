"""Frames and exported files in ParaView: pvbatch paraview_series.py FILES PICTURE

FILES is the folder that run_clients.py fills. Needs a display with OpenGL (Xvfb will do).
"""

import glob
import os
import sys

import h5py
import numpy

FOLDER = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [FOLDER, os.path.join(FOLDER, "..", "..", "tools", "paraview")]

import firn_points  # noqa: E402
from checks import L_FRAMES, L_SPACING, L_VELOCITY, Checks, box_error, l_time  # noqa: E402
from paraview import servermanager, simple  # noqa: E402
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402
from vtkmodules.vtkIOImage import vtkPNGReader  # noqa: E402


PVBATCH = os.environ.get("PVBATCH", "pvbatch")


def arrays_of(source, time):
    """Points and point data as ParaView holds them at a time."""
    source.UpdatePipeline(time)
    data = servermanager.Fetch(source)
    if data.IsA("vtkMultiBlockDataSet"):
        data = data.GetBlock(0)
    if data.GetNumberOfPoints() == 0:
        return data, numpy.zeros((0, 3)), {}
    points = data.GetPointData()
    arrays = {points.GetArrayName(k): vtk_to_numpy(points.GetArray(k)) for k in range(points.GetNumberOfArrays())}
    return data, vtk_to_numpy(data.GetPoints().GetData()), arrays


def check_frames(checks, run):
    """The series as Open gives it: times, and every value of every column."""
    reader = firn_points.open_series(os.path.join(run, "particles", "particles.hdf.series"))
    checks.near(list(reader.TimestepValues), [l_time(frame) for frame in range(1, L_FRAMES + 1)], 1e-12, "times of the series")
    for frame in range(1, L_FRAMES + 1):
        data, points, arrays = arrays_of(reader, l_time(frame))
        with h5py.File(os.path.join(run, "particles", f"particles.{frame:04}.hdf")) as file:
            stored = {name: column[:] for name, column in file["VTKHDF/PointData"].items()}
            place = file["VTKHDF/Points"][:]
        checks.equal(sorted(arrays), sorted(stored), f"frame {frame}: columns")
        same = [name for name in stored if arrays[name].dtype == stored[name].dtype and numpy.array_equal(arrays[name], stored[name])]
        checks.equal((len(same), numpy.array_equal(points, place)), (len(stored), True), f"frame {frame}: columns equal bit for bit, and positions")
        checks.equal(data.GetNumberOfCells(), 2, f"frame {frame}: a cell per material")
        checks.l_lies_right(points, frame, "y", 0.002, f"frame {frame}")
        checks.near(arrays["velocity"].mean(axis=0), L_VELOCITY, 1e-3, f"frame {frame}: mean velocity")
        checks.near(reader.FieldData["TimeValue"].GetRange()[0], l_time(frame), 1e-12, f"frame {frame}: TimeValue")
    checks.near(reader.FieldData["particle_spacing"].GetRange()[0], L_SPACING, 1e-4, "particle_spacing")
    return reader


def check_exports(checks, folder):
    """What `firn export` and `firn surface` write for ParaView: a .pvd with its times, PLY and OBJ."""
    reader = simple.OpenDataFile(os.path.join(folder, "paraview", "particles.pvd"))
    reader.UpdatePipelineInformation()
    checks.near(list(reader.TimestepValues), [l_time(frame) for frame in range(1, L_FRAMES + 1)], 1e-12, "times of the .pvd")
    for frame in range(1, L_FRAMES + 1):
        data, points, arrays = arrays_of(reader, l_time(frame))
        checks.equal(data.GetNumberOfCells() > 0, True, f".pvd, frame {frame}: has cells, without which nothing is drawn")
        with h5py.File(os.path.join(folder, "l_shape", "particles", f"particles.{frame:04}.hdf")) as file:
            stored = {name: column[:] for name, column in file["VTKHDF/PointData"].items()}
            place = file["VTKHDF/Points"][:]
        different = [name for name in stored if name not in arrays or not numpy.array_equal(arrays[name], stored[name])]
        checks.equal((different, numpy.array_equal(points, place)), ([], True), f".pvd, frame {frame}: columns that differ, positions equal")
    for name, tolerance in (("particles.0002.ply", 0.002), ("surface/surface.0002.ply", 0.6 * L_SPACING), ("surface/surface.0002.obj", 0.6 * L_SPACING)):
        source = simple.OpenDataFile(os.path.join(folder, "paraview", name))
        checks.l_lies_right(arrays_of(source, 0)[1], 2, "y", tolerance, name)


def check_tap(checks, run):
    """Particles that come out of a tap: their number changes, and the first frame has none."""
    reader = firn_points.open_series(os.path.join(run, "particles", "particles.hdf.series"))
    counts = [len(arrays_of(reader, time)[1]) for time in reader.TimestepValues]
    checks.that(counts[0] == 0 and 0 < counts[1] < counts[2], f"the tap's numbers of particles: {counts}")
    view = simple.CreateView("RenderView")
    view.ViewTime = reader.TimestepValues[0]
    balls, _ = firn_points.show(reader, view, "speed")  # nothing to see, and no complaint
    last = arrays_of(balls, reader.TimestepValues[-1])[2]
    checks.that(last["radius"].min() > 0, f"the tap's radii after a first frame without particles: {last['radius'].mean():.4f} m")
    simple.Delete(view)


def pixels(view, path):
    simple.SaveScreenshot(path, view, ImageResolution=view.ViewSize)
    reader = vtkPNGReader()
    reader.SetFileName(path)
    reader.Update()
    image = reader.GetOutput()
    width, height = image.GetDimensions()[:2]
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[:, :, :3].astype(int)


def check_macro(checks, reader, run, picture):
    """The size of the balls is measured in a picture without perspective; colours of materials are looked for."""
    view = simple.CreateView("RenderView")
    view.ViewSize = [600, 800]
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0, 0, 0]
    view.ViewTime = l_time(L_FRAMES)
    balls, display = firn_points.show(reader, view)
    display.SetScalarBarVisibility(view, False)
    checks.equal((display.Representation, display.ShaderPreset), ("Point Gaussian", "Sphere"), "representation")
    _, points, arrays = arrays_of(balls, view.ViewTime)
    checks.near(arrays["radius"], L_SPACING * (3 / (4 * numpy.pi)) ** (1 / 3) * numpy.cbrt(arrays["J"]), 2e-5, "radius is that of the volume")
    half = 0.7
    low, high = points.min(axis=0), points.max(axis=0)
    center = (low + high) / 2
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = center
    view.CameraPosition = center + [0, 0, 5]
    view.CameraViewUp = [0, 1, 0]
    view.CameraParallelScale = half
    seen = pixels(view, picture + ".measure.png")
    lit = numpy.argwhere(seen.sum(axis=2) > 0)
    scale = view.ViewSize[1] / (2 * half)
    found = (lit.max(axis=0) - lit.min(axis=0) + 1)[::-1]
    radius = arrays["radius"].mean()
    wanted = ((high - low)[:2] + 2 * radius) * scale
    checks.near(found, wanted, 3.0, f"the L with its balls is {found[0]} x {found[1]} pixels")
    checks.that(abs(found - wanted - 0.5 * radius * scale).max() > 3, "balls a quarter larger would be noticed")
    red, white = seen[:, :, 0] > 2 * seen[:, :, 1] + 20, (seen.min(axis=2) > 150)
    checks.that(red.sum() > 20000 and white.sum() > 1000, f"jelly is red ({red.sum()} pixels), snow white ({white.sum()})")
    table = simple.GetColorTransferFunction("material")
    checks.equal(list(table.Annotations), ["0", "jelly", "1", "snow"], "names of the materials in the legend")
    os.remove(picture + ".measure.png")
    simple.Delete(view)
    status = os.system(f"'{PVBATCH}' '{firn_points.__file__}' "
                       f"'{run}/particles/particles.hdf.series' --color speed --frame 3 -o '{picture}' >/dev/null 2>&1")
    checks.that(status == 0 and os.path.getsize(picture) > 5000, "the command line draws a picture")
    status = os.system(f"'{PVBATCH}' '{firn_points.__file__}' "
                       f"'{run}/particles/particles.hdf.series' --color speeed -o '{picture}.no.png' >/dev/null 2>&1")
    checks.that(status != 0 and not os.path.exists(picture + ".no.png"), "a column that there is not is refused")


def main():
    folder, picture = sys.argv[1], sys.argv[2]
    checks = Checks("paraview")
    reader = check_frames(checks, os.path.join(folder, "l_shape"))
    check_exports(checks, folder)
    check_tap(checks, os.path.join(folder, "tap"))
    check_macro(checks, reader, os.path.join(folder, "l_shape"), picture)
    checks.finish()


if __name__ == "__main__":
    main()
