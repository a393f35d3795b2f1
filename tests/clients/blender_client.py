"""What Firn writes, in Blender:

    blender -b --factory-startup --python blender_client.py -- FILES PICTURE [FIRN]

FILES is the folder that run_clients.py fills, PICTURE a .png file to render, FIRN the program, which the add-on calls.
Runs as well in the Python module bpy.
"""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

import bpy
import numpy
from mathutils import Vector

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
from checks import (  # noqa: E402
    JELLY_COLOR, L_FRAMES, L_SPACING, L_VELOCITY, Checks, box_error, read_ply_points, to_up, write_ply_points,
)  # fmt: skip

ADDON = HERE.parents[1] / "tools" / "blender" / "import_firn.py"
RADIUS = L_SPACING * (3 / (4 * numpy.pi)) ** (1 / 3)
SURFACE_TOLERANCE = 0.6 * L_SPACING  # a surface lies about half a spacing outside the outermost particles


def load_addon():
    spec = importlib.util.spec_from_file_location("import_firn", ADDON)
    module = importlib.util.module_from_spec(spec)
    sys.modules["import_firn"] = module
    spec.loader.exec_module(module)
    module.register()
    return module


def empty_scene():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    for collection in list(bpy.data.collections):
        bpy.data.collections.remove(collection)
    bpy.context.scene.frame_set(1)


def import_firn(path, **options):
    """The objects that the add-on makes, or the text of its refusal."""
    before = set(bpy.data.objects)
    try:
        bpy.ops.import_scene.firn_run(filepath=str(path), **options)
    except RuntimeError as error:
        return str(error)
    return sorted(set(bpy.data.objects) - before, key=lambda thing: thing.name)


def places(things):
    """Vertices of all the objects, where they are in the world."""
    found = [numpy.zeros((0, 3))]
    for thing in things:
        local = numpy.empty(3 * len(thing.data.vertices), numpy.float32)
        thing.data.vertices.foreach_get("co", local)
        matrix = numpy.array(thing.matrix_world)
        found.append(local.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3])
    return numpy.concatenate(found)


def attribute(thing, name):
    data = thing.data.attributes[name].data
    field = {"FLOAT_VECTOR": "vector", "FLOAT_COLOR": "color"}.get(thing.data.attributes[name].data_type, "value")
    width = {"vector": 3, "color": 4}.get(field, 1)
    values = numpy.empty(len(data) * width, numpy.int32 if thing.data.attributes[name].data_type == "INT" else numpy.float32)
    data.foreach_get(field, values)
    return values.reshape(-1, width) if width > 1 else values


def check_points(checks, files):
    scene = bpy.context.scene
    scene.render.fps = 60
    things = import_firn(files / "blender" / "particles.0001.ply")
    checks.equal([thing.name for thing in things], ["particles jelly", "particles snow"], "the add-on makes an object per material")
    checks.equal((scene.frame_start, scene.frame_end, scene.render.fps), (1, L_FRAMES, 24), "frame range and rate")
    for frame in (1, 3, 2):
        scene.frame_set(frame)
        file = read_ply_points(files / "blender" / f"particles.{frame:04}.ply")
        checks.equal(sum(len(thing.data.vertices) for thing in things), len(file["x"]), f"frame {frame}: particles")
        checks.l_lies_right(places(things), frame, "z", 0.002, f"frame {frame}")
        velocity = numpy.concatenate([attribute(thing, "velocity") for thing in things])
        checks.near(velocity.mean(axis=0), to_up(L_VELOCITY, "z"), 1e-3, f"frame {frame}: mean velocity")
        ids = numpy.concatenate([attribute(thing, "id") for thing in things])
        checks.that(sorted(ids) == sorted(file["id"]), f"frame {frame}: ids")
    checks.near(attribute(things[0], "Color")[:, :3], JELLY_COLOR, 0.005, "colour of the body, linear")
    checks.near(attribute(things[0], "radius"), RADIUS, 1e-4, "radius of a ball with the particle's volume")
    checks.equal([thing.material_slots[0].material.name for thing in things], ["Firn jelly balls (colours)", "Firn snow balls (colours)"], "materials")
    scene.frame_set(50)
    checks.that(box_error(places(things), L_FRAMES, "z") < 0.002, "after the last frame it stays")


def check_shifted(checks, files):
    """Another first frame, an odd frame rate, gaps in the sequence and a file that goes while it plays."""
    empty_scene()
    folder = files / "shifted"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for frame in (1, 3):
        shutil.copy(files / "blender" / f"particles.{frame:04}.ply", folder / f"p_{frame:06}.ply")
    (folder / "p.series.json").write_text('{"frames_per_second": 29.97, "particle_spacing": 0.0311, "up": "z"}')
    scene = bpy.context.scene
    things = import_firn(folder / "p_000001.ply", start=11)
    checks.near(scene.render.fps / scene.render.fps_base, 29.97, 1e-4, "an odd frame rate")
    checks.equal((scene.frame_start, scene.frame_end), (11, 13), "a run that starts at scene frame 11")
    for shown, frame in ((13, 3), (12, 1), (11, 1), (5, 1)):
        scene.frame_set(shown)
        checks.that(box_error(places(things), frame, "z") < 0.002, f"scene frame {shown} shows file {frame}")
    (folder / "p_000003.ply").write_bytes(b"ply")
    scene.frame_set(13)
    checks.that(box_error(places(things), 1, "z") < 0.002, "where a file is damaged the last shape stays")


def check_axes(checks, files):
    """Files for another program say which axis is up, and the add-on turns them; who overrules that is noticed."""
    for client in ("houdini", "paraview"):
        empty_scene()
        things = import_firn(files / client / "particles.0001.ply")
        checks.l_lies_right(places(things), 1, "z", 0.002, f"the L exported for {client}")
        velocity = numpy.concatenate([attribute(thing, "velocity") for thing in things])
        checks.near(velocity.mean(axis=0), to_up(L_VELOCITY, "z"), 1e-3, f"mean velocity of the one for {client}")
    empty_scene()
    wrong = places(import_firn(files / "houdini" / "particles.0001.ply", up="Z"))
    checks.that(box_error(wrong, 1, "z") > 0.2 and box_error(wrong, 1, "y") < 0.002, "y taken for z is detected")


def check_tap(checks, files):
    empty_scene()
    things = import_firn(files / "tap")  # the run's folder: its export is found
    counts = []
    for frame in (1, 2, 3):
        bpy.context.scene.frame_set(frame)
        counts.append(sum(len(thing.data.vertices) for thing in things))
    checks.that(counts[0] == 0 < counts[1] < counts[2], f"the tap's numbers of particles: {counts}")


def check_calls_firn(checks, files, firn):
    """A run that has not been exported: the add-on calls the program, for each kind; and says so if it cannot."""
    run = files / "fresh"
    shutil.rmtree(run, ignore_errors=True)
    subprocess.run([firn, "run", str(HERE / "l_shape.toml"), "-o", str(run)], check=True, stdout=subprocess.DEVNULL)
    empty_scene()
    text = import_firn(run, firn=str(files / "no_such_firn"))
    checks.that("no_such_firn cannot be started" in text, f"refusal: {str(text).strip()}")
    text = import_firn(run, export=False)
    checks.that("firn export" in text, f"refusal: {str(text).strip()}")
    checks.l_lies_right(places(import_firn(run, firn=firn)), 1, "z", 0.002, "particles exported by the add-on")
    surfaces = import_firn(run, kind="surface", firn=firn)
    checks.equal([thing.name for thing in surfaces], ["fresh jelly.001", "fresh snow.001"], "surfaces made by the add-on")
    checks.l_lies_right(places(surfaces), 1, "z", SURFACE_TOLERANCE, "surfaces made by the add-on")
    volumes = import_firn(run, kind="volume", firn=firn)
    checks.equal([thing.type for thing in volumes], ["VOLUME"], "a volume made by the add-on")


def check_installs(checks, files, firn):
    """As a user does it: install the file, tick it, set the path of firn, import. Only where nobody's settings change."""
    if "BLENDER_USER_SCRIPTS" not in os.environ:
        print("skipped: installing the add-on, because BLENDER_USER_SCRIPTS does not name a folder for it")
        return
    sys.modules.pop("import_firn").unregister()
    checks.that(not hasattr(bpy.types, "IMPORT_SCENE_OT_firn_run"), "the add-on can be taken away")
    bpy.ops.preferences.addon_install(filepath=str(ADDON), overwrite=True)
    bpy.ops.preferences.addon_enable(module="import_firn")
    settings = bpy.context.preferences.addons["import_firn"].preferences
    settings.firn = str(firn)
    run = files / "fresh"
    shutil.rmtree(run / "export", ignore_errors=True)
    empty_scene()
    checks.l_lies_right(places(import_firn(run)), 1, "z", 0.002, "the installed add-on, by the firn of its preferences")


def check_refusals(checks, files):
    whole = (files / "blender" / "particles.0001.ply").read_bytes()
    folder = files / "bad"
    folder.mkdir(exist_ok=True)
    cases = {
        "cut.0001.ply": (whole[:-1], "cut short"),
        "text.0001.ply": (b"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nend_header\n", "binary"),
        "header.0001.ply": (whole[:40], "no end"),
        "none.0001.ply": (b"solid", "not a PLY"),
        "face.0001.obj": (b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "vertex that there is not"),
    }
    for name, (content, words) in cases.items():
        (folder / name).write_bytes(content)
        text = import_firn(folder / name)
        checks.that(isinstance(text, str) and words in text and name in text, f"refusal: {str(text).strip()}")
    checks.equal([thing.name for thing in bpy.data.objects if str(folder) in thing.get("firn_folder", "")], [], "refusals leave no objects")
    text = import_firn(files / "nowhere" / "else")
    checks.that(isinstance(text, str) and "no such file or folder" in text, f"refusal: {str(text).strip()}")
    write_ply_points(folder / "lone.0001.ply", [(name, "float", numpy.arange(9.0)) for name in "xyz"])
    lone = import_firn(folder / "lone.0001.ply")
    checks.that(len(lone) == 1 and 0.3 < attribute(lone[0], "radius")[0] < 1.5, "points without any description get a radius from their distances")


def blender_ply(path):
    if hasattr(bpy.ops.wm, "ply_import") and bpy.app.version >= (3, 6, 0):
        bpy.ops.wm.ply_import(filepath=str(path))
    else:
        bpy.ops.import_mesh.ply(filepath=str(path))


def check_meshes(checks, files):
    """The surface by Blender's own importers and by the add-on, all frames."""
    for frame in range(1, L_FRAMES + 1):
        for ending, read in (("obj", lambda path: bpy.ops.wm.obj_import(filepath=str(path))), ("ply", blender_ply)):
            empty_scene()
            read(files / "blender" / "surface" / f"surface.{frame:04}.{ending}")
            bpy.context.view_layer.update()
            things = list(bpy.data.objects)
            checks.l_lies_right(places(things), frame, "z", SURFACE_TOLERANCE, f"{ending.upper()} surface by Blender, frame {frame}")
            checks.that(is_closed(things), f"{ending.upper()} surface, frame {frame}: closed")
    for ending in ("obj", "ply"):
        empty_scene()
        things = import_firn(files / "blender" / "surface" / f"surface.0001.{ending}")
        bpy.context.scene.frame_set(2)
        checks.l_lies_right(places(things), 2, "z", SURFACE_TOLERANCE, f"{ending.upper()} surface by the add-on, frame 2")
        checks.that(is_closed(things), f"{ending.upper()} surface by the add-on: closed, outwards")
    velocity = attribute(things[0], "velocity")
    checks.near(velocity.mean(axis=0), to_up(L_VELOCITY, "z"), 1e-2, "velocities of the surface's vertices")
    empty_scene()
    water = sys.modules["import_firn"].make_material("water", "water", "", False).node_tree.nodes["Principled BSDF"]
    name = "Transmission" if "Transmission" in water.inputs else "Transmission Weight"
    checks.equal(water.inputs[name].default_value, 1.0, "a surface of water is clear")


def is_closed(things):
    """Every edge is met once in each direction, and the volume inside is positive."""
    for thing in things:
        corners = numpy.empty(len(thing.data.loops), numpy.int32)
        thing.data.loops.foreach_get("vertex_index", corners)
        if len(corners) == 0 or len(corners) != 3 * len(thing.data.polygons):
            return False
        triangles = corners.reshape(-1, 3).astype(numpy.int64)
        edges = numpy.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        forth, back = edges[:, 0] << 32 | edges[:, 1], edges[:, 1] << 32 | edges[:, 0]
        at = places([thing])[triangles]
        volume = numpy.einsum("ij,ij->i", at[:, 0], numpy.cross(at[:, 1], at[:, 2])).sum() / 6
        if not (len(numpy.unique(forth)) == len(forth) and set(forth) == set(back) and volume > 0):
            return False
    return bool(things)


def isosurface(volume, threshold):
    """Where Blender itself has the grid of that name: its surface at a threshold, as a mesh."""
    thing = bpy.data.objects.new("isosurface", bpy.data.meshes.new("isosurface"))
    bpy.context.scene.collection.objects.link(thing)
    modifier = thing.modifiers.new("surface", "VOLUME_TO_MESH")
    modifier.object, modifier.grid_name, modifier.threshold = volume, volume.data.grids[0].name, threshold
    bpy.context.view_layer.update()
    mesh = thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).to_mesh()
    found = numpy.empty(3 * len(mesh.vertices), numpy.float32)
    mesh.vertices.foreach_get("co", found)
    return found.reshape(-1, 3)


def check_volumes(checks, files):
    """Fog and level sets: grids, the file of each frame, and where Blender has them."""
    for name, main, threshold in (("volume", "density", 0.5), ("surface/surface", "surface", 0.0)):
        empty_scene()
        path = files / "blender" / f"{name}.0001.vdb"
        thing = import_firn(path)[0]
        volume = thing.data
        checks.that(volume.grids.load(), f"{path.name} is loaded by Blender ({volume.grids.error_message})")
        checks.equal([grid.name for grid in volume.grids], [main, "velocity"], f"{path.name}: grids")
        checks.equal((volume.is_sequence, volume.frame_duration, volume.frame_start), (True, L_FRAMES, 1), f"{path.name}: sequence")
        for frame in range(1, L_FRAMES + 1):
            bpy.context.scene.frame_set(frame)
            volume.grids.load()
            shown = pathlib.Path(volume.grids.frame_filepath).name
            checks.that(f".{frame:04}." in shown, f"scene frame {frame} shows {shown}")
            checks.l_lies_right(isosurface(thing, threshold), frame, "z", 2 * L_SPACING, f"{main} of frame {frame}")


def add_camera(location, target, **settings):
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    for name, value in settings.items():
        setattr(camera.data, name, value)
    bpy.context.scene.collection.objects.link(camera)
    camera.location = location
    camera.rotation_euler = (Vector(target) - Vector(location)).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.camera = camera


def render(path, width, height, samples, transparent):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = samples, False  # Debian's Blender has no denoiser
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = width, height, 100
    scene.render.film_transparent = transparent
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA" if transparent else "RGB"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(path))
    pixels = numpy.array(image.pixels[:]).reshape(height, width, 4)
    bpy.data.images.remove(image)
    return pixels


def check_ball_size(checks, files):
    """The outline of the L in a picture without perspective tells how large the balls are drawn."""
    for instances in (False, True):
        empty_scene()
        things = import_firn(files / "blender" / "particles.0001.ply", instances=instances)
        bpy.context.scene.frame_set(L_FRAMES)
        at = places(things)
        low, high = at.min(axis=0), at.max(axis=0)
        center = (low + high) / 2
        add_camera((center[0], center[1] - 5, center[2]), center, type="ORTHO", ortho_scale=1.4)
        alpha = render(files / "outline.png", 300, 400, 16, True)[:, :, 3]
        rows = numpy.argwhere(alpha > 0.5)
        found = (rows.max(axis=0) - rows.min(axis=0) + 1)[::-1]
        scale = 400 / 1.4
        wanted = ((high - low)[[0, 2]] + 2 * RADIUS) * scale
        checks.near(found, wanted, 2.0, f"the L of {'spheres' if instances else 'points'} is {found[0]} x {found[1]} pixels")
        checks.that(abs(found - wanted - RADIUS * scale).max() > 2.0, "balls half as large again would be noticed")


def check_saved_file(checks, files):
    """A .blend file that was saved and opened again goes on loading frames."""
    empty_scene()
    import_firn(files / "blender" / "particles.0001.ply")
    path = files / "saved.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    bpy.context.scene.frame_set(3)
    things = [thing for thing in bpy.data.objects if "firn_folder" in thing]
    checks.l_lies_right(places(things), 3, "z", 0.002, "a .blend file opened again, frame 3")


def draw_picture(checks, files, picture):
    """Surface of the jelly, balls of the snow, ground, sun and sky, by Cycles."""
    empty_scene()
    import_firn(files / "blender" / "particles.0001.ply")
    scene = bpy.context.scene
    scene.frame_set(2)
    ground = bpy.data.meshes.new("ground")
    ground.from_pydata([(-9, -9, 0.25), (9, -9, 0.25), (9, 9, 0.25), (-9, 9, 0.25)], [], [(0, 1, 2, 3)])
    scene.collection.objects.link(bpy.data.objects.new("ground", ground))
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle, sun.rotation_euler = 3.0, 0.05, (0.7, 0.2, 0.6)
    scene.collection.objects.link(sun)
    scene.world = scene.world or bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    sky = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    sky.inputs["Color"].default_value, sky.inputs["Strength"].default_value = (0.55, 0.7, 1.0, 1), 0.6
    add_camera((2.1, -3.2, 1.6), (0.42, -0.5, 0.78), lens=50)
    pixels = render(picture, 640, 400, 48, False)
    checks.that(0.05 < pixels[:, :, :3].mean() < 0.95 and pixels[:, :, :3].std() > 0.05, f"the picture {picture.name} shows something")
    green = (pixels[:, :, 1] > 1.3 * pixels[:, :, 0]) & (pixels[:, :, 1] > 1.3 * pixels[:, :, 2])
    checks.that(green.mean() > 0.03, f"the letter is as green as the scene says, in {green.mean():.1%} of the picture")


def main():
    arguments = sys.argv[sys.argv.index("--") + 1 :]
    files, picture = (pathlib.Path(argument).resolve() for argument in arguments[:2])
    checks = Checks(f"blender {bpy.app.version_string}")
    load_addon()
    empty_scene()
    check_points(checks, files)
    check_shifted(checks, files)
    check_axes(checks, files)
    check_tap(checks, files)
    check_refusals(checks, files)
    if len(arguments) > 2:
        check_calls_firn(checks, files, arguments[2])
        check_installs(checks, files, arguments[2])
    check_meshes(checks, files)
    check_volumes(checks, files)
    check_saved_file(checks, files)
    check_ball_size(checks, files)
    draw_picture(checks, files, picture)
    checks.finish()


if __name__ == "__main__":
    main()
