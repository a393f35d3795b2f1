"""A picture of a run by Blender's Cycles, without a window; a start for scenes of your own:

    blender -b --factory-startup --python tools/blender/render_run.py -- out/x --kind surface --frame 12 -o picture.png

Loads the run with the add-on import_firn.py beside this file, which calls `firn export` or `firn surface` where needed,
puts a floor, a sun and a sky around it, and looks through the camera of the scene. --save keeps all as a .blend file.
"""

import argparse
import importlib.util
import math
import pathlib
import re
import sys

import bpy
from mathutils import Vector


def load_addon():
    path = pathlib.Path(__file__).resolve().with_name("import_firn.py")
    spec = importlib.util.spec_from_file_location("import_firn", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules["import_firn"] = module
    spec.loader.exec_module(module)
    module.register()
    return module


def scene_camera(run):
    """(position, target, up axis, vertical field of view in degrees) of the resolved scene; None for what is not there."""
    text = (run / "scene.resolved.toml").read_text(encoding="utf-8")
    camera = re.search(r"^\[camera\]$(.*?)(?=^\[|\Z)", text, re.MULTILINE | re.DOTALL)
    keys = dict(re.findall(r"^(\w+) = (.+)$", camera[1], re.MULTILINE)) if camera else {}
    up = (re.search(r'^up = "(\w)"$', text, re.MULTILINE) or ["", "y"])[1]

    def vector(name):
        if name not in keys:
            return None
        x, y, z = (float(word) for word in keys[name].strip("[]").split(","))
        return Vector((x, y, z)) if up == "z" else Vector((x, -z, y))

    return vector("position"), vector("target"), float(keys.get("field_of_view", 40))


def bounds(things):
    corners = [thing.matrix_world @ Vector(corner) for thing in things for corner in thing.bound_box]
    return [Vector(pick(corner[axis] for corner in corners) for axis in range(3)) for pick in (min, max)]


def look(scene, position, target, angle):
    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.sensor_fit, camera.data.angle_y = "VERTICAL", math.radians(angle)
    camera.data.clip_start = 0.001
    camera.location = position
    camera.rotation_euler = (target - position).to_track_quat("-Z", "Y").to_euler()
    scene.collection.objects.link(camera)
    scene.camera = camera


def light(scene, floor, size):
    """A floor, a low sun, and a pale sky."""
    mesh = bpy.data.meshes.new("floor")
    mesh.from_pydata([(-size, -size, floor), (size, -size, floor), (size, size, floor), (-size, size, floor)], [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new("floor")
    material.use_nodes = True
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Base Color"].default_value, shader.inputs["Roughness"].default_value = (0.24, 0.255, 0.275, 1), 0.7
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("floor", mesh))
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.data.angle, sun.rotation_euler = 3.2, 0.03, (0.75, 0.25, -0.6)
    scene.collection.objects.link(sun)
    scene.world = bpy.data.worlds.new("sky")
    scene.world.use_nodes = True
    sky = next(node for node in scene.world.node_tree.nodes if node.type == "BACKGROUND")
    sky.inputs["Color"].default_value, sky.inputs["Strength"].default_value = (0.5, 0.66, 1.0, 1), 0.45


def parse_options():
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    parser = argparse.ArgumentParser(prog="render_run.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run", type=pathlib.Path, help="folder of the run")
    parser.add_argument("--kind", choices=("points", "surface", "volume"), default="surface")
    parser.add_argument("--frame", type=int, help="1 is t = 0; the last one if not given")
    parser.add_argument("--floor", type=float, default=0.0, help="height of the floor, in m")
    parser.add_argument("--size", type=int, nargs=2, default=(960, 540), metavar=("WIDTH", "HEIGHT"))
    parser.add_argument("--samples", type=int, default=64, help="rays per pixel")
    parser.add_argument("--firn", default="firn", help="the program")
    parser.add_argument("--save", type=pathlib.Path, help="a .blend file to write")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="the picture, a .png or .jpg file")
    return parser.parse_args(arguments)


def main():
    options = parse_options()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    addon = load_addon()
    scene = bpy.context.scene
    defaults = {"instances": False, "colors": True, "radius_scale": 1.0, "start": 1, "set_range": True, "up": "AUTO", "export": True}
    try:
        things = addon.import_run(bpy.context, options.run.resolve(), options.kind, options.firn, defaults)
        position, target, angle = scene_camera(options.run)
    except (addon.Refusal, OSError) as error:
        sys.exit(f"render_run: {error}")
    scene.frame_set(options.frame or scene.frame_end)
    bpy.context.view_layer.update()
    low, high = bounds(things)
    target = target if target is not None else (low + high) / 2
    reach = max(high - low)
    if position is None:  # the scene leaves it to the program
        position = target + Vector((0.35, -1, 0.35)).normalized() * reach / math.tan(math.radians(angle) / 2)
    look(scene, position, target, angle)
    light(scene, options.floor, 50 * max(reach, (position - target).length))
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = options.samples, False  # not every Blender has a denoiser
    scene.render.resolution_x, scene.render.resolution_y = options.size
    scene.render.image_settings.file_format = "JPEG" if options.output.suffix.lower() in (".jpg", ".jpeg") else "PNG"
    scene.render.filepath = str(options.output.resolve())
    if options.save:
        bpy.ops.wm.save_as_mainfile(filepath=str(options.save.resolve()))
    bpy.ops.render.render(write_still=True)


if __name__ == "__main__":
    main()
