"""Blender add-on: File > Import > Firn run.

Loads a run of Firn as an animated cloud of particles, as a sequence of surface meshes, or as a sequence of volumes, with
a material for each substance, the frame range and the frame rate. Choose the folder of the run, or one of the files that
`firn export RUN --for blender` or `firn surface RUN --for blender` wrote; if a run has none yet, the add-on calls
`firn export` itself (path of the program: preferences of the add-on).

Frame 1 is t = 0. Files are read when the frame changes; nothing is stored in the .blend file but where they are: the
custom properties firn_... of the objects. Written for Blender 3.4, and for the changed names in 4.x.
"""

import json
import math
import os
import pathlib
import re
import subprocess

import bpy
import numpy
from bpy.app.handlers import persistent
from bpy_extras.io_utils import ImportHelper

bl_info = {
    "name": "Firn runs",
    "author": "The Firn developers",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > Firn run",
    "description": "Particles, surfaces and volumes of simulations by Firn",
    "category": "Import-Export",
}


class Refusal(Exception):
    """What is asked cannot be done; the message says why and what to do."""


# --- Files ------------------------------------------------------------------------------------------------------------

PLY_TYPES = {
    "char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
    "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
    "double": "f8", "float64": "f8",
}  # fmt: skip


class Geometry:
    """What a file holds: a column of numbers per name, and triangles or none."""

    def __init__(self, columns, triangles=None):
        self.columns, self.triangles = columns, triangles

    def __len__(self):
        return len(self.columns["x"])

    def stack(self, names):
        return numpy.stack([numpy.asarray(self.columns[name], numpy.float32) for name in names], axis=1)

    def part(self, chosen):
        return Geometry({name: values[chosen] for name, values in self.columns.items()})


def read_ply_header(stream, path):
    """[(element, count, [(property, type)])] of a binary PLY file; a list property has the type (count, item)."""
    if stream.readline().strip() != b"ply":
        raise Refusal(f"{path}: not a PLY file")
    elements, binary = [], False
    while True:
        line = stream.readline()
        words = line.decode("latin-1").split()
        if not line.endswith(b"\n"):
            raise Refusal(f"{path}: the header has no end")
        if words == ["end_header"]:
            break
        if not words or words[0] in ("comment", "obj_info"):
            continue
        try:
            if words[0] == "format":
                binary = words[1] == "binary_little_endian"
            elif words[0] == "element":
                elements.append((words[1], int(words[2]), []))
            elif words[0] == "property" and words[1] == "list":
                elements[-1][2].append((words[4], (PLY_TYPES[words[2]], PLY_TYPES[words[3]])))
            elif words[0] == "property":
                elements[-1][2].append((words[2], PLY_TYPES[words[1]]))
        except (IndexError, KeyError, ValueError) as error:
            raise Refusal(f'{path}: the header line "{" ".join(words)}" makes no sense') from error
    if not binary:
        raise Refusal(f"{path}: only binary little-endian PLY files are read")
    return elements


def read_ply(path):
    """Vertices with all their scalars, and faces where there are some. Blender 3.4's own reader drops the scalars."""
    with open(path, "rb") as stream:
        elements = read_ply_header(stream, path)
        data = stream.read()
    columns, triangles, at = None, None, 0
    for name, count, properties in elements:
        if all(isinstance(kind, str) for _, kind in properties):
            layout = numpy.dtype([(key, "<" + kind) for key, kind in properties])
        elif len(properties) == 1:  # lists, all of three: a triangle mesh
            size, item = properties[0][1]
            layout = numpy.dtype([("count", "<" + size), ("items", "<" + item, 3)])
        else:
            raise Refusal(f'{path}: the element "{name}" is of a kind that is not read')
        if len(data) - at < count * layout.itemsize:
            raise Refusal(f"{path}: cut short: it has {len(data)} bytes after its header, and needs more")
        rows = numpy.frombuffer(data, layout, count, at)
        at += count * layout.itemsize
        if name == "vertex":
            columns = {key: rows[key] for key in layout.names}
        elif name == "face" and "items" in (layout.names or ()):
            if not numpy.all(rows["count"] == 3):
                raise Refusal(f"{path}: has faces that are not triangles; import it with Blender's own importer")
            triangles = rows["items"].astype(numpy.int32)
    if columns is None or not {"x", "y", "z"} <= set(columns):
        raise Refusal(f"{path}: has no vertices with x, y and z")
    if triangles is not None and len(triangles) and not 0 <= triangles.min() <= triangles.max() < len(columns["x"]):
        raise Refusal(f"{path}: has a face with a vertex that there is not")
    return Geometry(columns, triangles)


def read_obj(path):
    """Vertices and triangles of an OBJ file."""
    places, triangles = [], []
    with open(path, encoding="utf-8", errors="replace") as stream:
        for number, line in enumerate(stream, 1):
            words = line.split()
            try:
                if line.startswith("v "):
                    places.append([float(word) for word in words[1:4]])
                elif line.startswith("f "):
                    corners = [int(word.split("/")[0]) for word in words[1:]]
                    corners = [corner - 1 if corner > 0 else len(places) + corner for corner in corners]
                    triangles += [[corners[0], b, c] for b, c in zip(corners[1:], corners[2:])]
            except ValueError as error:
                raise Refusal(f"{path}:{number}: {line.strip()!r} cannot be read") from error
    places = numpy.array(places, numpy.float32).reshape(-1, 3)
    triangles = numpy.array(triangles, numpy.int32).reshape(-1, 3)
    if len(triangles) and not 0 <= triangles.min() <= triangles.max() < len(places):
        raise Refusal(f"{path}: has a face with a vertex that there is not")
    return Geometry(dict(zip("xyz", places.T)), triangles)


def z_up(vectors):
    """Vectors with y up as vectors with z up, which is Blender's way: a quarter turn about x."""
    return numpy.stack([vectors[:, 0], -vectors[:, 2], vectors[:, 1]], axis=1)


NUMBERED = re.compile(r"^(?P<stem>.*?[._]?)(?P<number>\d+)(?P<suffix>\.(?:ply|obj|vdb))$", re.IGNORECASE)


class Sequence:
    """Numbered files of one kind: "points", "surface" or "volume"."""

    def __init__(self, folder, stem, suffix):
        self.folder, self.stem, self.suffix = pathlib.Path(folder), stem, suffix
        self.paths = {}
        for path in self.folder.iterdir() if self.folder.is_dir() else ():
            match = NUMBERED.match(path.name)
            if match and (match["stem"], match["suffix"]) == (stem, suffix):
                self.paths[int(match["number"])] = path
        self.numbers = sorted(self.paths)

    def kind(self):
        if self.suffix.lower() == ".ply":
            with open(self.paths[self.numbers[0]], "rb") as stream:
                names = [name for name, _, _ in read_ply_header(stream, stream.name)]
            return "surface" if "face" in names else "points"
        return "volume" if self.suffix.lower() == ".vdb" else "surface"

    def nearest(self, number):
        """The file of that number, else the last one before it, else the first one."""
        before = [k for k in self.numbers if k <= number]
        return self.paths[before[-1] if before else self.numbers[0]]


def find_sequences(folder):
    """All numbered files in a folder and below it, the latest first."""
    found = {}
    for root, folders, files in os.walk(folder):
        depth = len(pathlib.Path(root).relative_to(folder).parts)
        folders[:] = [] if depth >= 3 else sorted(set(folders) - {"images", "checkpoints"})
        for name in files:
            if match := NUMBERED.match(name):
                key = (root, match["stem"], match["suffix"])
                found[key] = max(found.get(key, 0), os.path.getmtime(os.path.join(root, name)))
    return [Sequence(*key) for key in sorted(found, key=lambda key: (-found[key], key))]


class Run:
    """What the folder of a run, and the description beside exported files, tell; without these, nothing."""

    def __init__(self, path, sequence=None):
        self.folder, self.frame_rate, self.materials, self.spacing, self.dimension = None, None, [], None, 3
        self.up = "Z"
        path = pathlib.Path(path)
        for folder in [path, *path.parents][:3]:
            if (folder / "scene.resolved.toml").is_file():
                self.folder = folder
                self.read_scene((folder / "scene.resolved.toml").read_text(encoding="utf-8"))
                break
        if sequence is not None:
            name = sequence.stem.rstrip("._")
            # A folder may hold exports for several programs; the name without a suffix is that of the newest.
            own = sequence.folder / f"{name}{sequence.suffix}.series.json"
            self.read_description(own if own.is_file() else sequence.folder / f"{name}.series.json")

    def read_description(self, path):
        """What `firn export` says about the files that it wrote."""
        try:
            told = json.loads(path.read_text(encoding="utf-8"))
            self.up = str(told.get("up", "z")).upper()
            self.frame_rate = float(told.get("frames_per_second") or 0) or self.frame_rate
            self.spacing = float(told.get("particle_spacing") or 0) or self.spacing
            looks = {entry["name"]: entry["look"] for entry in self.materials}
            if told.get("materials"):
                self.materials = [{"name": name, "look": looks.get(name, name)} for name in told["materials"]]
        except FileNotFoundError:
            pass
        except (OSError, ValueError, TypeError, AttributeError) as error:
            raise Refusal(f"{path}: cannot be used: {error}") from error

    def read_scene(self, text):
        """The few keys that are needed, of a file that Firn wrote: Blender's Python may be too old to have tomllib."""
        section, per_cell = "", None
        for line in text.splitlines():
            if match := re.match(r'\[material\.(?:"([^"]+)"|([^\]]+))\]$', line):
                section = "material"
                self.materials.append({"name": match[1] or match[2], "look": ""})
            elif line.startswith("["):
                section = line.strip("[]")
            elif match := re.match(r'(\w+) = "?([^"]*)"?$', line):
                key, value = match.groups()
                if section == "material" and (key == "preset" or key == "model" and not self.materials[-1]["look"]):
                    self.materials[-1]["look"] = value
                elif (section, key) == ("", "frame_rate"):
                    self.frame_rate = float(value)
                elif (section, key) == ("", "dimension"):
                    self.dimension = int(value)
                elif (section, key) == ("resolution", "particles_per_cell"):
                    per_cell = float(value)
        try:
            cell = json.loads((self.folder / "run.json").read_text(encoding="utf-8")).get("cell_size")
        except (OSError, ValueError):  # a run that has not come that far
            cell = None
        if cell and per_cell:
            self.spacing = cell / per_cell ** (1 / self.dimension)

    def radius(self):
        """Of a ball with the volume of a particle."""
        if not self.spacing:
            return None
        ball = math.pi if self.dimension == 2 else 4 * math.pi / 3
        return self.spacing / ball ** (1 / self.dimension)


def guessed_radius(geometry):
    """Where nothing else tells: half the usual distance of a particle to its nearest neighbour, a little more."""
    from mathutils.kdtree import KDTree

    places = geometry.stack("xyz")
    if len(places) < 2:
        return 0.01
    tree = KDTree(len(places))
    for number, place in enumerate(places):
        tree.insert(place, number)
    tree.balance()
    chosen = places[:: max(1, len(places) // 200)]
    return 0.6 * float(numpy.median([tree.find_n(place, 2)[1][2] for place in chosen]))


# --- Materials --------------------------------------------------------------------------------------------------------

# By preset or model: linear colour as in the pictures of `firn render`, roughness, and what else the shader needs.
LOOKS = {
    "snow": ((0.90, 0.925, 0.95), 0.7, {"subsurface": 0.3}),
    "wet_snow": ((0.74, 0.79, 0.85), 0.45, {"subsurface": 0.3}),
    "powder_snow": ((0.92, 0.935, 0.95), 0.85, {"subsurface": 0.3}),
    "jelly": ((0.55, 0.035, 0.05), 0.15, {"subsurface": 0.2}),
    "yogurt": ((0.80, 0.77, 0.70), 0.3, {"subsurface": 0.3}),
    "whipped_cream": ((0.84, 0.80, 0.71), 0.6, {"subsurface": 0.3}),
    "toothpaste": ((0.38, 0.70, 0.66), 0.25, {"subsurface": 0.2}),
    "foam": ((0.84, 0.86, 0.88), 0.8, {"subsurface": 0.2}),
    "honey": ((0.50, 0.19, 0.01), 0.05, {"transmission": 0.8, "ior": 1.49}),
    "water": ((0.06, 0.20, 0.30), 0.02, {"transmission": 1.0, "ior": 1.333, "tint": 0.2}),
    "rubber": ((0.10, 0.095, 0.09), 0.5, {}),
    "mud": ((0.115, 0.070, 0.038), 0.4, {}),
    "clay": ((0.34, 0.29, 0.225), 0.75, {}),
    "plasticine": ((0.10, 0.22, 0.52), 0.6, {}),
    "steel": ((0.28, 0.285, 0.29), 0.35, {"metallic": 1.0}),
    "copper": ((0.475, 0.23, 0.13), 0.35, {"metallic": 1.0}),
    "sand": ((0.52, 0.37, 0.20), 0.9, {}),
    "wet_sand": ((0.30, 0.20, 0.11), 0.55, {}),
    "concrete": ((0.36, 0.355, 0.34), 0.9, {}),
    "lava": ((0.035, 0.024, 0.021), 0.8, {"glow": (1.0, 0.10, 0.006)}),
    "neo_hookean": ((0.06, 0.36, 0.12), 0.2, {"subsurface": 0.3}),
    "fixed_corotated": ((0.60, 0.25, 0.05), 0.3, {"subsurface": 0.2}),
    "hencky": ((0.08, 0.16, 0.46), 0.3, {"subsurface": 0.2}),
    "linear_corotated": ((0.36, 0.10, 0.42), 0.3, {"subsurface": 0.2}),
    "oldroyd_b": ((0.16, 0.44, 0.05), 0.1, {"subsurface": 0.3}),
    "newtonian_fluid": ((0.06, 0.20, 0.30), 0.02, {"transmission": 1.0, "ior": 1.333, "tint": 0.2}),
    "herschel_bulkley": ((0.66, 0.55, 0.44), 0.4, {"subsurface": 0.2}),
    "von_mises": ((0.34, 0.35, 0.36), 0.4, {"metallic": 1.0}),
    "drucker_prager": ((0.46, 0.34, 0.22), 0.9, {}),
    "cam_clay": ((0.24, 0.15, 0.09), 0.8, {}),
    "rankine_damage": ((0.40, 0.40, 0.39), 0.9, {}),
}
NEUTRAL = ((0.6, 0.6, 0.58), 0.6, {})


def set_input(node, names, value):
    """The first of the names that this version of Blender has."""
    for name in names:
        if name in node.inputs:
            node.inputs[name].default_value = value
            return


# Not "color", which Cycles takes for that of volumes, whatever it is asked about; so are density, temperature, velocity.
COLOR_NAME = "Color"


def make_material(look, name, color_from, balls):
    """A material of the file, made once. color_from: "" for the look's colour, else "GEOMETRY" or "INSTANCER", where the
    attribute is. Balls are opaque: a heap of clear ones looks like foam, whatever they are made of."""
    title = f"Firn {name}{' balls' if balls else ''}" + {"": "", "GEOMETRY": " (colours)"}.get(color_from, " (instance colours)")
    if title in bpy.data.materials:  # with the changes that its user made
        return bpy.data.materials[title]
    color, roughness, more = LOOKS.get(look, NEUTRAL)
    if balls:
        roughness, more = max(roughness, 0.35), {key: value for key, value in more.items() if key == "glow"}
    material = bpy.data.materials.new(title)
    material.use_nodes = True
    material.diffuse_color = (*color, 1)
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    tint = more.get("tint", 1.0)  # clear substances: the colour of a pane is not that of the depth
    set_input(shader, ["Base Color"], (*(1 - tint * (1 - c) for c in color), 1))
    set_input(shader, ["Roughness"], roughness)
    set_input(shader, ["Metallic"], more.get("metallic", 0.0))
    set_input(shader, ["Transmission Weight", "Transmission"], more.get("transmission", 0.0))
    set_input(shader, ["Subsurface Weight", "Subsurface"], more.get("subsurface", 0.0))
    shader.subsurface_method = "BURLEY"  # less noise than random walks; nobody looks into a crystal here
    set_input(shader, ["Subsurface Radius"], (0.02, 0.02, 0.02))
    set_input(shader, ["Subsurface Color"], (*color, 1))
    set_input(shader, ["IOR"], more.get("ior", 1.45))
    if "glow" in more:
        set_input(shader, ["Emission Color", "Emission"], (*more["glow"], 1))
        set_input(shader, ["Emission Strength"], 1.5)
    if color_from:
        node = material.node_tree.nodes.new("ShaderNodeAttribute")
        node.location = (-300, 200)
        node.attribute_name, node.attribute_type = COLOR_NAME, color_from
        for name in ("Base Color", "Subsurface Color"):
            if name in shader.inputs:
                material.node_tree.links.new(node.outputs["Color"], shader.inputs[name])
    return material


def make_volume_material():
    if "Firn volume" in bpy.data.materials:
        return bpy.data.materials["Firn volume"]
    material = bpy.data.materials.new("Firn volume")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    nodes.clear()
    shader, output = nodes.new("ShaderNodeVolumePrincipled"), nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = (0.9, 0.925, 0.95, 1)
    shader.inputs["Density"].default_value = 20
    output.location = (300, 0)
    material.node_tree.links.new(shader.outputs["Volume"], output.inputs["Volume"])
    return material


# --- Geometry nodes ---------------------------------------------------------------------------------------------------


def new_socket(group, name, kind, direction):
    if hasattr(group, "interface"):  # since 4.0
        return group.interface.new_socket(name=name, in_out=direction, socket_type=kind)
    return (group.inputs if direction == "INPUT" else group.outputs).new(kind, name)


def sockets_of(group):
    """Identifiers of the inputs by name."""
    if hasattr(group, "interface"):
        items = [item for item in group.interface.items_tree if item.item_type == "SOCKET" and item.in_out == "INPUT"]
    else:
        items = group.inputs
    return {item.name: item.identifier for item in items}


def node_group(instances):
    """Vertices with the attribute "radius" to points, which renderers draw as balls, or to instances of a sphere."""
    name = "Firn balls" if instances else "Firn points"
    if name in bpy.data.node_groups:
        return bpy.data.node_groups[name]
    group = bpy.data.node_groups.new(name, "GeometryNodeTree")
    new_socket(group, "Geometry", "NodeSocketGeometry", "INPUT")
    new_socket(group, "Radius Scale", "NodeSocketFloat", "INPUT").default_value = 1.0
    new_socket(group, "Material", "NodeSocketMaterial", "INPUT")
    new_socket(group, "Geometry", "NodeSocketGeometry", "OUTPUT")
    nodes, link = group.nodes, group.links.new

    def add(kind, x, y):
        node = nodes.new(kind)
        node.location = (x, y)
        return node

    start, end = add("NodeGroupInput", -600, 0), add("NodeGroupOutput", 600, 0)
    radius = add("GeometryNodeInputNamedAttribute", -600, -200)
    radius.data_type = "FLOAT"
    radius.inputs["Name"].default_value = "radius"
    scaled = add("ShaderNodeMath", -350, -150)
    scaled.operation = "MULTIPLY"
    number = next(socket for socket in radius.outputs if socket.type == "VALUE" and socket.name == "Attribute")
    link(number, scaled.inputs[0])
    link(start.outputs["Radius Scale"], scaled.inputs[1])
    material = add("GeometryNodeSetMaterial", 350, 0)
    link(start.outputs["Material"], material.inputs["Material"])
    if instances:
        ball, smooth = add("GeometryNodeMeshIcoSphere", -350, -350), add("GeometryNodeSetShadeSmooth", -150, -350)
        ball.inputs["Radius"].default_value, ball.inputs["Subdivisions"].default_value = 1.0, 2
        each = add("GeometryNodeInstanceOnPoints", 100, 0)
        link(ball.outputs["Mesh"], smooth.inputs["Geometry"])
        link(smooth.outputs["Geometry"], material.inputs["Geometry"])
        link(start.outputs["Geometry"], each.inputs["Points"])
        link(material.outputs["Geometry"], each.inputs["Instance"])
        link(scaled.outputs[0], each.inputs["Scale"])
        material.location, each.location = (100, -350), (350, 0)
        link(each.outputs["Instances"], end.inputs["Geometry"])
    else:
        points = add("GeometryNodeMeshToPoints", 100, 0)
        link(start.outputs["Geometry"], points.inputs["Mesh"])
        link(scaled.outputs[0], points.inputs["Radius"])
        link(points.outputs["Points"], material.inputs["Geometry"])
        link(material.outputs["Geometry"], end.inputs["Geometry"])
    return group


# --- Geometry of a frame ----------------------------------------------------------------------------------------------


def linear(values):
    values = values.astype(numpy.float32) / 255
    return numpy.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def set_attribute(mesh, name, kind, field, values):
    found = mesh.attributes.get(name)
    if found is not None and (found.data_type != kind or found.domain != "POINT"):
        mesh.attributes.remove(found)
        found = None
    if found is None:
        found = mesh.attributes.new(name, kind, "POINT")
    found.data.foreach_set(field, numpy.ascontiguousarray(values).ravel())


def set_attributes(mesh, geometry, turned):
    """All columns but the position, under Blender's names: velocity, Color; vectors as such."""
    left = dict.fromkeys(geometry.columns)
    for taken in "xyz":
        left.pop(taken)
    triples = {"velocity": ("vx", "vy", "vz")}
    for name in list(left):
        if name.endswith("_x") and {name[:-1] + "y", name[:-1] + "z"} <= set(left):
            triples[name[:-2]] = tuple(name[:-1] + axis for axis in "xyz")
    for name, parts in triples.items():
        if set(parts) <= set(left):
            vectors = geometry.stack(parts)
            set_attribute(mesh, name, "FLOAT_VECTOR", "vector", z_up(vectors) if turned else vectors)
            for part in parts:
                left.pop(part)
    if {"red", "green", "blue"} <= set(left):
        colors = numpy.ones((len(geometry), 4), numpy.float32)
        colors[:, :3] = linear(numpy.stack([geometry.columns[name] for name in ("red", "green", "blue")], axis=1))
        set_attribute(mesh, COLOR_NAME, "FLOAT_COLOR", "color", colors)
        for name in ("red", "green", "blue", "alpha"):
            left.pop(name, None)
    for name in left:
        values = geometry.columns[name]
        if name == "id" or values.dtype.kind in "iu":
            whole = values.astype(numpy.int64) & 0x7FFFFFFF  # Blender's whole numbers have 32 bits
            set_attribute(mesh, name, "INT", "value", whole.astype(numpy.int32))
        else:
            set_attribute(mesh, name, "FLOAT", "value", values.astype(numpy.float32))


def fill_mesh(mesh, geometry, turned, radius):
    """The mesh of an object becomes that of a frame."""
    mesh.clear_geometry()
    mesh.vertices.add(len(geometry))
    places = geometry.stack("xyz")
    mesh.vertices.foreach_set("co", (z_up(places) if turned else places).ravel())
    if geometry.triangles is not None:
        corners = geometry.triangles
        mesh.loops.add(corners.size)
        mesh.loops.foreach_set("vertex_index", corners.ravel())
        mesh.polygons.add(len(corners))
        mesh.polygons.foreach_set("loop_start", numpy.arange(0, corners.size, 3, dtype=numpy.int32))
        if bpy.app.version < (3, 6, 0):  # since then the start of the next face tells
            mesh.polygons.foreach_set("loop_total", numpy.full(len(corners), 3, numpy.int32))
        mesh.polygons.foreach_set("use_smooth", numpy.ones(len(corners), bool))
    set_attributes(mesh, geometry, turned)
    if geometry.triangles is None and "radius" not in geometry.columns:
        growth = geometry.columns.get("J")
        values = numpy.full(len(geometry), radius, numpy.float32)
        if growth is not None:
            values *= numpy.cbrt(numpy.maximum(growth, 1e-9)).astype(numpy.float32)
        set_attribute(mesh, "radius", "FLOAT", "value", values)
    mesh.update(calc_edges=geometry.triangles is not None)


_last = ("", 0.0, None)  # path, time of change and geometry of the file read last: objects of one run share it


def read_geometry(path):
    global _last
    stamp = os.path.getmtime(path)
    if _last[:2] != (str(path), stamp):
        _last = (str(path), stamp, read_obj(path) if path.suffix.lower() == ".obj" else read_ply(path))
    return _last[2]


def load_frame(thing, frame):
    """Brings the mesh of an object to a frame. Raises Refusal and OSError."""
    folder = bpy.path.abspath(thing["firn_folder"])
    sequence = Sequence(folder, thing["firn_stem"], thing["firn_suffix"])
    if not sequence.numbers:
        raise Refusal(f"{thing.name}: there are no files {thing['firn_stem']}*{thing['firn_suffix']} in {folder}; "
                      "set its custom property firn_folder to where they are")
    geometry = read_geometry(sequence.nearest(frame - thing["firn_offset"]))
    number = thing["firn_material"]
    if number >= 0 and "material" in geometry.columns:
        geometry = geometry.part(numpy.asarray(geometry.columns["material"]) == number)
    fill_mesh(thing.data, geometry, bool(thing["firn_turned"]), thing["firn_radius"])


@persistent
def on_frame_change(scene, _depsgraph=None):
    for thing in scene.objects:
        if thing.type == "MESH" and "firn_folder" in thing:
            try:
                load_frame(thing, scene.frame_current)
            except (Refusal, OSError) as error:  # a lost file must not end an animation: say so and keep the last shape
                print(f"Firn: {error}")


# --- Import -----------------------------------------------------------------------------------------------------------


def new_object(name, collection, sequence, settings, number):
    thing = bpy.data.objects.new(name, bpy.data.meshes.new(name))
    thing["firn_folder"], thing["firn_stem"], thing["firn_suffix"] = str(sequence.folder), sequence.stem, sequence.suffix
    thing["firn_offset"], thing["firn_material"] = settings["offset"], number
    thing["firn_turned"], thing["firn_radius"] = int(settings["turned"]), settings["radius"]
    collection.objects.link(thing)
    return thing


def material_numbers(sequence):
    """The numbers of the materials in the first and the last file; [-1] where files do not tell."""
    numbers = set()
    for path in {sequence.paths[sequence.numbers[0]], sequence.paths[sequence.numbers[-1]]}:
        columns = read_geometry(path).columns
        if "material" not in columns:
            return [-1]
        numbers |= set(numpy.unique(columns["material"]).astype(int).tolist())
    return sorted(numbers)


def has_colors(sequence):
    return {"red", "green", "blue"} <= set(read_geometry(sequence.paths[sequence.numbers[-1]]).columns)


def look_of(run, number):
    """(name, look) of a material by its number."""
    if 0 <= number < len(run.materials):
        return run.materials[number]["name"], run.materials[number]["look"]
    return ("particles", "") if number < 0 else (f"material {number}", "")


def up_axis(run, options):
    """Of the files: what the user says, else what the description beside them says, else z."""
    return run.up if options["up"] == "AUTO" else options["up"]


def import_points(run, sequence, collection, options, title):
    settings = {"offset": options["start"] - 1, "turned": up_axis(run, options) == "Y", "radius": run.radius()}
    if settings["radius"] is None:
        filled = [read_geometry(sequence.paths[k]) for k in (sequence.numbers[-1], sequence.numbers[0])]
        settings["radius"] = guessed_radius(filled[0] if len(filled[0]) else filled[1])
    source = "" if not has_colors(sequence) or not options["colors"] else "INSTANCER" if options["instances"] else "GEOMETRY"
    made = []
    numbers = [*range(len(run.materials))] if run.materials and material_numbers(sequence) != [-1] else material_numbers(sequence)
    for number in numbers:
        name, look = look_of(run, number)
        thing = new_object(f"{title} {name}", collection, sequence, settings, number)
        material = make_material(look, name, source, True)
        thing.data.materials.append(material)
        modifier = thing.modifiers.new("Firn", "NODES")
        modifier.node_group = node_group(options["instances"])
        inputs = sockets_of(modifier.node_group)
        modifier[inputs["Material"]] = material
        modifier[inputs["Radius Scale"]] = options["radius_scale"]
        made.append(thing)
    return made


def import_surface(run, sequence, collection, options, title):
    turned = up_axis(run, options) == "Y" or sequence.suffix.lower() == ".obj"  # OBJ files have y up by custom
    settings = {"offset": options["start"] - 1, "turned": turned, "radius": 0.0}
    part = sequence.stem.rstrip("._")
    named = [entry for entry in run.materials if part == "surface_" + re.sub(r"[\s/\\]", "_", entry["name"])]
    chosen = (named or run.materials or [{"name": "surface", "look": ""}])[0]
    thing = new_object(f"{title} {chosen['name'] if named else 'surface'}", collection, sequence, settings, -1)
    source = "GEOMETRY" if has_colors(sequence) and options["colors"] else ""
    thing.data.materials.append(make_material(chosen["look"], chosen["name"], source, False))
    return [thing]


def import_volume(run, sequence, collection, options, title):
    volume = bpy.data.volumes.new(f"{title} volume")
    volume.filepath = str(sequence.paths[sequence.numbers[0]])
    volume.is_sequence = len(sequence.numbers) > 1
    volume.frame_duration = sequence.numbers[-1] - sequence.numbers[0] + 1
    volume.frame_start = options["start"] - 1 + sequence.numbers[0]
    volume.frame_offset = sequence.numbers[0] - 1
    thing = bpy.data.objects.new(volume.name, volume)
    thing.data.materials.append(make_volume_material())
    if up_axis(run, options) == "Y":
        thing.rotation_euler[0] = math.pi / 2
    collection.objects.link(thing)
    return [thing]


def chosen_sequences(path, kind, firn, options):
    """The sequence that a chosen file belongs to, or those of a run's folder, exported first if there are none; and
    their kind. A surface may come as one sequence for each material."""
    path = pathlib.Path(path)
    if not path.exists():
        raise Refusal(f"{path}: there is no such file or folder")
    if match := NUMBERED.match(path.name) if path.is_file() else None:
        sequence = Sequence(path.parent, match["stem"], match["suffix"])
        return [sequence], sequence.kind()
    run = Run(path)
    folder = run.folder or (path if path.is_dir() else path.parent)
    for attempt in range(2):
        found = [sequence for sequence in find_sequences(folder) if sequence.kind() == kind]
        if kind == "volume":  # fog before the level sets of surfaces, which do not render
            found.sort(key=lambda sequence: not sequence.stem.startswith("volume"))
        if found:
            parts = [other for other in found if (other.folder, other.suffix) == (found[0].folder, found[0].suffix)]
            by_material = [part for part in parts if part.stem.startswith("surface_")]
            whole = kind != "surface" or not found[0].stem.startswith("surface_")
            return [found[0]] if whole else sorted(by_material, key=lambda part: part.stem), kind
        if attempt or run.folder is None or not options["export"]:
            break
        export(run.folder, kind, firn)
    raise Refusal(f"{folder}: there are no {kind} files for Blender; make them with: "
                  f"{' '.join(export_command(folder, kind, 'firn'))}")


def export_command(folder, kind, firn):
    verb, more = {"points": ("export", ["--format", "ply"]), "volume": ("export", ["--format", "vdb"]),
                  "surface": ("surface", ["--format", "ply", "--by-material"])}[kind]
    return [firn, verb, str(folder), "--for", "blender", *more]


def export(folder, kind, firn):
    command = export_command(folder, kind, firn)
    try:
        result = subprocess.run(command, capture_output=True, text=True)
    except OSError as error:
        raise Refusal(f"{folder}: the run has no files for Blender yet, and {firn} cannot be started ({error.strerror}): "
                      "set its path in the preferences of this add-on") from error
    if result.returncode:
        words = (result.stderr.strip() or result.stdout.strip()).splitlines()
        raise Refusal(f"{' '.join(command)}: ended with {result.returncode}: {words[-1] if words else 'no message'}")


def set_range(scene, sequence, run, options):
    """Frames and their rate; whole numbers per second and a divisor is how Blender has it."""
    first, last = (number + options["start"] - 1 for number in (sequence.numbers[0], sequence.numbers[-1]))
    scene.frame_start, scene.frame_end = first, max(first, last)
    if run.frame_rate:
        scene.render.fps = max(1, round(run.frame_rate))
        scene.render.fps_base = scene.render.fps / run.frame_rate
    scene.render.use_lock_interface = True  # frames are loaded while rendering; the window must not draw them meanwhile


def import_run(context, path, kind, firn, options):
    """Returns the objects made."""
    sequences, kind = chosen_sequences(path, kind, firn, options)
    run = Run(sequences[0].folder, sequences[0])
    title = run.folder.name if run.folder else sequences[0].stem.rstrip("._") or "firn"
    collection = bpy.data.collections.new(title)
    context.scene.collection.children.link(collection)
    importer = {"points": import_points, "surface": import_surface, "volume": import_volume}[kind]
    try:
        made = [thing for sequence in sequences for thing in importer(run, sequence, collection, options, title)]
        for thing in made:
            if thing.type == "MESH":
                load_frame(thing, max(context.scene.frame_current, options["start"]))
    except Exception:  # leave nothing half done behind
        for thing in list(collection.objects):
            bpy.data.objects.remove(thing)
        bpy.data.collections.remove(collection)
        raise
    if options["set_range"]:
        set_range(context.scene, sequences[0], run, options)
    context.scene.frame_set(max(context.scene.frame_current, options["start"]))
    return made


class FirnPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__

    firn: bpy.props.StringProperty(name="firn", subtype="FILE_PATH", default="firn",
                                   description="The program; called if a run has not been exported yet")

    def draw(self, _context):
        self.layout.prop(self, "firn")


class ImportFirnRun(bpy.types.Operator, ImportHelper):
    """Load a run of Firn: choose its folder, or one of the files exported from it"""

    bl_idname = "import_scene.firn_run"
    bl_label = "Import Firn run"
    bl_options = {"REGISTER", "UNDO"}

    filter_glob: bpy.props.StringProperty(default="*.ply;*.obj;*.vdb;*.toml;*.json", options={"HIDDEN"})
    kind: bpy.props.EnumProperty(name="Show", default="points", items=[
        ("points", "Particles", "A cloud of balls for each material"),
        ("surface", "Surface", "The meshes of firn surface"),
        ("volume", "Volume", "OpenVDB files"),
    ])  # fmt: skip
    instances: bpy.props.BoolProperty(name="Spheres as instances", default=False,
                                      description="Instances of a sphere, for renderers that do not draw points as balls")
    colors: bpy.props.BoolProperty(name="Colours of the files", default=True,
                                   description="Where files have colours, use them instead of the material's")
    radius_scale: bpy.props.FloatProperty(name="Radius scale", default=1.0, min=0.01, soft_max=3.0)
    start: bpy.props.IntProperty(name="First frame", default=1, description="Scene frame of t = 0")
    set_range: bpy.props.BoolProperty(name="Set frame range and rate", default=True)
    up: bpy.props.EnumProperty(name="Up axis of files", default="AUTO", items=[
        ("AUTO", "As described", "What the description beside the files says; z if there is none"),
        ("Z", "Z", "As written with --for blender"), ("Y", "Y", "As written for other programs"),
    ], description="OBJ files always have y up")  # fmt: skip
    export: bpy.props.BoolProperty(name="Export if necessary", default=True,
                                   description="Call firn where the run has no such files yet")
    firn: bpy.props.StringProperty(name="firn", default="", description="The program; empty: as in the preferences")

    def execute(self, context):
        addon = context.preferences.addons.get(__name__)
        firn = self.firn or (addon.preferences.firn if addon else "firn")
        names = ("instances", "colors", "radius_scale", "start", "set_range", "up", "export")
        try:
            made = import_run(context, self.filepath, self.kind, firn, {name: getattr(self, name) for name in names})
        except (Refusal, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        counts = ", ".join(f"{thing.name}: {len(thing.data.vertices)}" for thing in made if thing.type == "MESH")
        self.report({"INFO"}, f"Firn: {counts or made[0].name}")
        return {"FINISHED"}


def menu_entry(self, _context):
    self.layout.operator(ImportFirnRun.bl_idname, text="Firn run")


def register():
    bpy.utils.register_class(FirnPreferences)
    bpy.utils.register_class(ImportFirnRun)
    bpy.types.TOPBAR_MT_file_import.append(menu_entry)
    bpy.app.handlers.frame_change_pre.append(on_frame_change)


def unregister():
    bpy.app.handlers.frame_change_pre.remove(on_frame_change)
    bpy.types.TOPBAR_MT_file_import.remove(menu_entry)
    bpy.utils.unregister_class(ImportFirnRun)
    bpy.utils.unregister_class(FirnPreferences)


if __name__ == "__main__":
    register()
