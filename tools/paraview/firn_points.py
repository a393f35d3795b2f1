"""Shows the particles of a Firn run in ParaView as lit balls of their true size.

As a macro: open particles/particles.hdf.series of a run, select it, and choose Macros > Import new macro..., this file;
then its button. Or in a terminal, with a picture as the result:

    pvbatch firn_points.py out/x/particles/particles.hdf.series --color speed --frame 24 -o picture.png

--color is material (default), speed, or the name of any column. A ball has the volume of its particle: the volume it was
made with, which the frames tell, times J. Written for ParaView 5.11.
"""

import argparse
import math
import os
import re
import sys

import numpy
from paraview import simple

# Colours of materials by preset or model, linear RGB: those of `firn render`.
LOOKS = {
    "snow": (0.90, 0.925, 0.95), "wet_snow": (0.74, 0.79, 0.85), "powder_snow": (0.92, 0.935, 0.95),
    "jelly": (0.55, 0.035, 0.05), "yogurt": (0.80, 0.77, 0.70), "whipped_cream": (0.84, 0.80, 0.71),
    "toothpaste": (0.38, 0.70, 0.66), "foam": (0.84, 0.86, 0.88), "honey": (0.50, 0.19, 0.01),
    "water": (0.06, 0.20, 0.30), "rubber": (0.10, 0.095, 0.09), "mud": (0.115, 0.070, 0.038),
    "clay": (0.34, 0.29, 0.225), "plasticine": (0.10, 0.22, 0.52), "steel": (0.28, 0.285, 0.29),
    "copper": (0.475, 0.23, 0.13), "sand": (0.52, 0.37, 0.20), "wet_sand": (0.30, 0.20, 0.11),
    "concrete": (0.36, 0.355, 0.34), "lava": (0.035, 0.024, 0.021), "neo_hookean": (0.06, 0.36, 0.12),
    "fixed_corotated": (0.60, 0.25, 0.05), "hencky": (0.08, 0.16, 0.46), "linear_corotated": (0.36, 0.10, 0.42),
    "oldroyd_b": (0.16, 0.44, 0.05), "newtonian_fluid": (0.06, 0.20, 0.30), "herschel_bulkley": (0.66, 0.55, 0.44),
    "von_mises": (0.34, 0.35, 0.36), "drucker_prager": (0.46, 0.34, 0.22), "cam_clay": (0.24, 0.15, 0.09),
    "rankine_damage": (0.40, 0.40, 0.39),
}  # fmt: skip
NEUTRAL = (0.6, 0.6, 0.58)


class Refusal(Exception):
    """What is asked cannot be done; the message says why."""


def srgb(color):
    """Linear reflectance to the values that ParaView's colour tables hold."""
    return [12.92 * c if c <= 0.0031308 else 1.055 * c ** (1 / 2.4) - 0.055 for c in color]


def scene_of(reader):
    """The resolved scene beside the frames: ("y" or "z", [(name, preset or model) of each material]); empty without it."""
    names = reader.FileName if hasattr(reader, "FileName") else ""
    first = names if isinstance(names, str) else (names[0] if len(names) else "")
    path = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(first))), "scene.resolved.toml")
    up, materials, section = "y", [], ""
    try:
        with open(path, encoding="utf-8") as stream:
            lines = stream.read().splitlines()
    except OSError:
        return up, materials
    for line in lines:
        if match := re.match(r'\[material\.(?:"([^"]+)"|([^\]]+))\]$', line):
            section = "material"
            materials.append([match[1] or match[2], ""])
        elif line.startswith("["):
            section = line
        elif match := re.match(r'(\w+) = "([^"]*)"$', line):
            if section == "material" and (match[1] == "preset" or match[1] == "model" and not materials[-1][1]):
                materials[-1][1] = match[2]
            elif section == "" and match[1] == "up":
                up = match[2]
    return up, materials


def field_number(reader, name):
    array = reader.FieldData.GetArray(name)
    if array is None:
        raise Refusal(f'these data do not tell their "{name}": select the frames of a run of Firn (particles.hdf.series) first')
    return array.GetRange(0)[0]


def particle_radius(reader):
    """The formula of a particle's radius (m) for ParaView's calculator, and a number that is about as large."""
    spacing, dimension = field_number(reader, "particle_spacing"), int(field_number(reader, "dimension"))
    ball = math.pi if dimension == 2 else 4 * math.pi / 3  # area or volume of a ball of radius 1
    radius = spacing * (1 / ball) ** (1 / dimension)
    if reader.PointData.GetArray("J") is None:
        return f"{radius:.9g}", radius
    return f"{radius:.9g}*exp(ln(max(J,1e-9))/{dimension})", radius


def color_by_material(display, view, materials):
    simple.ColorBy(display, ("POINTS", "material"))
    table = simple.GetColorTransferFunction("material")
    table.InterpretValuesAsCategories = 1
    table.AnnotationsInitialized = 1
    table.Annotations = [text for number, (name, _) in enumerate(materials) for text in (str(number), name)]
    colors = []
    for _, look in materials:
        colors += srgb(LOOKS.get(look, NEUTRAL))
    table.IndexedColors = colors
    table.IndexedOpacities = [1.0] * len(materials)
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = "material", ""


def color_by_column(display, view, columns, column):
    """columns: the number of components of each."""
    name = "velocity" if column == "speed" else column
    if name not in columns:
        raise Refusal(f'there is no column "{column}"; there are speed, {", ".join(sorted(columns))}')
    if columns[name] > 1:
        simple.ColorBy(display, ("POINTS", name, "Magnitude"))
    else:
        simple.ColorBy(display, ("POINTS", name))
    table = simple.GetColorTransferFunction(name)
    table.ApplyPreset("Viridis (matplotlib)", True)
    bar = simple.GetScalarBar(table, view)
    bar.Title, bar.ComponentTitle = ("speed [m/s]", "") if column == "speed" else (column, "")


def telling_time(reader, time):
    """A frame without particles tells nothing of its columns; the last one does."""
    reader.UpdatePipeline(time)
    times = list(getattr(reader, "TimestepValues", None) or [])
    return time if reader.GetDataInformation().GetNumberOfPoints() > 0 or not times else times[-1]


def show(reader, view, color="material"):
    """Adds a calculator of the radius to the frames and shows it; returns (filter, display)."""
    reader.UpdatePipeline(telling_time(reader, view.ViewTime))
    up, materials = scene_of(reader)
    formula, radius = particle_radius(reader)
    balls = simple.Calculator(registrationName="Firn points", Input=reader)
    balls.ResultArrayName, balls.Function = "radius", formula
    balls.UpdatePipeline(telling_time(reader, view.ViewTime))
    columns = {array.GetName(): array.GetNumberOfComponents() for array in balls.PointData}
    simple.Hide(reader, view)
    display = simple.Show(balls, view)
    display.SetRepresentationType("Point Gaussian")
    display.ShaderPreset = "Sphere"
    display.GaussianRadius = 1
    display.ScaleByArray = 1
    display.UseScaleFunction = 0
    display.SetScaleArray = ["POINTS", "radius"]
    if color == "material" and materials:
        color_by_material(display, view, materials)
    else:
        color_by_column(display, view, columns, color)
    display.SetScalarBarVisibility(view, True)
    look_at(balls, view, up, radius)
    balls.UpdatePipeline(view.ViewTime)
    if balls.GetDataInformation().GetNumberOfPoints() > 0:
        display.RescaleTransferFunctionToDataRange(False, True)
    print(f"firn_points: {balls.GetDataInformation().GetNumberOfPoints()} particles, radius about {radius:.4g} m")
    return balls, display


def look_at(source, view, up, radius):
    """The run's own axis upwards, seen from the front and a little from above, as near as all of it fits in."""
    bounds = source.GetDataInformation().GetBounds()
    if bounds[0] > bounds[1]:  # no particles yet
        return
    low, high = (numpy.array(bounds[side::2]) for side in (0, 1))
    upward = numpy.array((0.0, 1.0, 0.0) if up == "y" else (0.0, 0.0, 1.0))
    front = numpy.array((0.0, 0.0, 1.0) if up == "y" else (0.0, -1.0, 0.0))
    toward = front if (low == high).any() else front + 0.3 * upward + (0.35, 0, 0)  # two dimensions: straight on
    toward = toward / numpy.linalg.norm(toward)
    right = numpy.cross(upward, toward) / numpy.linalg.norm(numpy.cross(upward, toward))
    corners = numpy.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    offsets = corners - (low + high) / 2
    slope = 0.9 * math.tan(math.radians(view.CameraViewAngle) / 2)  # a tenth is left as a margin
    wide = slope * view.ViewSize[0] / view.ViewSize[1]
    tall = (numpy.abs(offsets @ numpy.cross(toward, right)) + radius) / slope
    away = (numpy.maximum(tall, (numpy.abs(offsets @ right) + radius) / wide) + offsets @ toward).max()
    view.CameraFocalPoint = (low + high) / 2
    view.CameraPosition = (low + high) / 2 + away * toward
    view.CameraViewUp = upward


def scene_time(reader, frame):
    times = list(getattr(reader, "TimestepValues", None) or [])
    if frame is None:
        return times[-1] if times else 0.0
    if not 1 <= frame <= len(times):
        raise Refusal(f"there is no frame {frame}; the frames are 1 to {len(times)}")
    return times[frame - 1]


def open_series(path):
    if not os.path.exists(path):
        raise Refusal(f"{path}: no such file")
    try:
        reader = simple.OpenDataFile(os.path.abspath(path))
    except RuntimeError:
        reader = None
    if reader is None:
        raise Refusal(f"{path}: ParaView does not know such files; give particles/particles.hdf.series of a run")
    reader.UpdatePipelineInformation()
    return reader


def draw(arguments):
    """The command line's way: file to picture."""
    parser = argparse.ArgumentParser(prog="firn_points.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("series", help="particles/particles.hdf.series of a run")
    parser.add_argument("--color", default="material", help="material, speed, or a column")
    parser.add_argument("--frame", type=int, help="1 is t = 0; the last one if not given")
    parser.add_argument("--size", type=int, nargs=2, default=(960, 540), metavar=("WIDTH", "HEIGHT"), help="of the picture")
    parser.add_argument("-o", "--output", required=True, help="the picture, a .png or .jpg file")
    options = parser.parse_args(arguments)
    reader = open_series(options.series)
    view = simple.CreateView("RenderView")
    view.ViewSize = list(options.size)
    view.OrientationAxesVisibility = 0
    view.UseColorPaletteForBackground = 0
    view.Background = [0.32, 0.34, 0.36]
    view.ViewTime = scene_time(reader, options.frame)
    show(reader, view, options.color)
    simple.SaveScreenshot(options.output, view, ImageResolution=list(options.size))


def main():
    arguments = list(getattr(sys, "argv", []))
    try:
        if arguments and os.path.basename(arguments[0]) == "firn_points.py" and len(arguments) > 1:
            draw(arguments[1:])
            return 0
        reader = simple.GetActiveSource()  # a macro
        if reader is None:
            raise Refusal("open the frames of a run (particles/particles.hdf.series) and select them first")
        view = simple.GetActiveViewOrCreate("RenderView")
        show(reader, view)
        simple.Render(view)
    except Refusal as refusal:
        print(f"firn_points: {refusal}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    status = main()
    if status and os.path.basename(getattr(sys, "argv", [""])[0] or "") == "firn_points.py":
        sys.exit(status)  # in a macro this would end ParaView
