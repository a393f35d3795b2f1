#include <firn/scene/choice_names.h>
#include <firn/scene/list_section.h>
#include <firn/scene/schema_table.h>

namespace firn {
namespace {

using K = KeyBuilder;

/// A field of a base as one of the object's own, which is what a key is for.
template <class Settings, class Base, class Field>
Field Settings::*of(Field Base::*member) {
  return member;
}

template <class Settings>
std::vector<Key> dimension_keys() {
  return {
      K("normal", of<Settings>(&ShapeSettings::normal))
          .only_with("shape", {"half_space"})
          .default_text("along `up`")
          .help("Direction out of the solid; any length but zero."),
      K("size", of<Settings>(&ShapeSettings::size))
          .unit("m")
          .above(0)
          .required()
          .only_with("shape", {"box", "rounded_box", "height_field"})
          .help("Edge lengths; of a height field the extent, where the one along `up` multiplies the file's heights."),
      K("radius", of<Settings>(&ShapeSettings::radius))
          .unit("m")
          .above(0)
          .required()
          .only_with("shape", {"rounded_box", "sphere", "capsule", "cylinder", "cone", "torus"})
          .help("Radius; of a rounded box that of its edges, of a cone that at its lower end, of a torus that of the "
                "ring. "
                "The sphere is a disk in 2D."),
      K("top_radius", of<Settings>(&ShapeSettings::top_radius))
          .unit("m")
          .at_least(0)
          .only_with("shape", {"cone"})
          .help("Radius at the upper end; 0: a point."),
      K("tube_radius", of<Settings>(&ShapeSettings::tube_radius))
          .unit("m")
          .above(0)
          .required()
          .only_with("shape", {"torus"})
          .help("Radius of the tube; at most `radius`."),
      K("length", of<Settings>(&ShapeSettings::length))
          .unit("m")
          .above(0)
          .required()
          .only_with("shape", {"capsule", "cylinder", "cone"})
          .help("Along `axis`; of a capsule with both caps, so at least twice the radius."),
      K("axis", of<Settings>(&ShapeSettings::axis))
          .only_with("shape", {"capsule", "cylinder", "cone", "torus"})
          .default_text("along `up`")
          .help("Direction of the axis; any length but zero. `rotation` turns it too."),
  };
}

template <class Settings>
std::vector<Key> file_keys() {
  return {
      K("file", of<Settings>(&ShapeSettings::file))
          .path()
          .required()
          .only_with("shape", {"polygon", "height_field", "mesh"})
          .help(
              "Outline (OBJ), heights (PNG: black 0, white 1; or rows of numbers) or closed mesh (OBJ, PLY, STL, "
              "glTF, FBX ...); the "
              "path starts at the scene file's folder."),
      K("scale", of<Settings>(&ShapeSettings::scale))
          .above(0)
          .only_with("shape", {"polygon", "mesh", "mesh_sequence", "level_set_sequence"})
          .help("Factor on the coordinates of the file."),
      K("depth", of<Settings>(&ShapeSettings::depth))
          .unit("m")
          .above(0)
          .only_with("shape", {"height_field"})
          .default_text("a quarter of the longer side")
          .help("How far the solid reaches below its lowest point."),
      K("parts", of<Settings>(&ShapeSettings::parts))
          .required()
          .only_with("shape", {"union", "intersection", "difference"})
          .help("Names of [[part]]s that stand before; of a difference, the first less the others."),
      K("inverted", of<Settings>(&ShapeSettings::inverted))
          .help("The solid is all that lies outside: the inside of a sphere holds what is in it."),
  };
}

template <class Settings>
std::vector<Key> shape_keys(std::string_view default_name, std::string_view name_help) {
  std::vector<Key> keys = {
      K("name", of<Settings>(&ShapeSettings::name)).default_text(default_name).help(name_help),
      K("shape", of<Settings>(&ShapeSettings::shape))
          .required()
          .help("half_space is all that lies behind a plane (a line in 2D); cylinder, cone, torus, height_field, mesh "
                "and sequences are of 3D, polygon of 2D; union, intersection and difference are made of `parts`. "
                "Sequences change their form in time and are colliders only."),
  };
  for (const auto& more : {dimension_keys<Settings>(), file_keys<Settings>()}) {
    keys.insert(keys.end(), more.begin(), more.end());
  }
  return keys;
}

std::vector<Key> sequence_keys() {
  return {
      K("meshes", &ColliderSettings::meshes)
          .type(ValueType::files)
          .path()
          .required()
          .only_with("shape", {"mesh_sequence"})
          .help(
              "Closed meshes (OBJ, PLY, STL, glTF, FBX ...) whose vertices move and whose triangles stay the same: a "
              "pattern such as "
              "\"belt/belt_####.obj\", where #### is a number of at least four digits, or a list. The surface moves "
              "as its vertices do, along itself too."),
      K("level_sets", &ColliderSettings::level_sets)
          .type(ValueType::files)
          .path()
          .required()
          .only_with("shape", {"level_set_sequence"})
          .help(
              "OpenVDB files with a level set each: a pattern or a list. A vector grid named `v`, `vel` or `velocity` "
              "gives the velocity along the surface; the one across follows from the motion."),
      K("fps", &ColliderSettings::fps)
          .unit("1/s")
          .above(0)
          .only_with("shape", {"mesh_sequence", "level_set_sequence"})
          .default_text("none")
          .help("Entries of the sequence per second, the first at t = 0; or give `times`."),
      K("times", &ColliderSettings::times)
          .unit("s")
          .only_with("shape", {"mesh_sequence", "level_set_sequence"})
          .default_text("none")
          .help("When each entry of the sequence is reached. Before the first it is at rest."),
      K("at_end", &ColliderSettings::at_end)
          .only_with("shape", {"mesh_sequence", "level_set_sequence"})
          .help("After the last entry: hold: at rest as it is there; cycle: once more from the first entry, whose form "
                "is that of the last."),
  };
}

template <class Settings>
std::vector<Key> motion_keys() {
  return {
      K("position", of<Settings>(&ShapeSettings::position))
          .unit("m")
          .help("Centre at t = 0, or a point on the half space's plane; where the file's origin goes."),
      K("rotation", of<Settings>(&ShapeSettings::rotation))
          .type(ValueType::rotation)
          .unit("degrees")
          .help("At t = 0, about the fixed axes x, then y, then z; one angle in 2D."),
      K("velocity", of<Settings>(&ColliderSettings::velocity)).unit("m/s").help("Constant."),
      K("angular_velocity", of<Settings>(&ColliderSettings::angular_velocity))
          .type(ValueType::rotation)
          .unit("rad/s")
          .help("Constant, about `position`."),
      K("keyframes", of<Settings>(&ColliderSettings::keyframes))
          .default_text("none")
          .help("Motion, instead of a velocity: { time = s, position = m, rotation = degrees, scale = factor } each; "
                "what "
                "is left out is `position`, `rotation` and 1. At rest before the first and after the last."),
      K("trajectory", of<Settings>(&ColliderSettings::trajectory))
          .path()
          .default_text("none")
          .help("Motion from a text file: rows of time (s), position (m) and, if given, rotation (degrees): t, x, y, "
                "z, rx, "
                "ry, rz; in 2D t, x, y, angle. The path starts at the scene file's folder."),
      K("interpolation", of<Settings>(&ColliderSettings::interpolation))
          .help("Between keyframes, rows or meshes of a sequence: linear: constant velocities; smooth: continuous "
                "velocities, at rest at both ends. Rotations go the shortest way."),
  };
}

}  // namespace

Section make_part_section() {
  Section section = list_section("part", &Scene::parts, "A shape that colliders are made of; one [[part]] each.");
  section.keys = shape_keys<PartSettings>("part<index>", "By which `parts` name it.");
  const std::vector<Key> more = {
      K("position", of<PartSettings>(&ShapeSettings::position)).unit("m").help("In the frame of what it is a part of."),
      K("rotation", of<PartSettings>(&ShapeSettings::rotation))
          .type(ValueType::rotation)
          .unit("degrees")
          .help("About the fixed axes x, then y, then z; one angle in 2D."),
  };
  section.keys.insert(section.keys.end(), more.begin(), more.end());
  return section;
}

Section make_collider_section() {
  Section section = list_section("collider", &Scene::colliders, "An obstacle; one [[collider]] each.");
  section.keys = shape_keys<ColliderSettings>("collider<index>",
                                              "Names the collider, also in its columns of stats.csv: NAME.force_x, _y, "
                                              "_z (N, mean over the frame, of the material on the collider), "
                                              "NAME.torque_x, _y, _z (N m, about `position` where it moves), "
                                              "NAME.inside and NAME.depth (particles inside, and the deepest, m), "
                                              "NAME.caught (times that another collider held a particle inside).");
  section.keys.front().decides_result = false;
  for (const auto& added : {sequence_keys(), motion_keys<ColliderSettings>()}) {
    section.keys.insert(section.keys.end(), added.begin(), added.end());
  }
  const std::vector<Key> more = {
      K("contact", &ColliderSettings::contact)
          .help("sticky: what touches moves along; slip: slides and never leaves; separate: slides and may leave."),
      K("friction", &ColliderSettings::friction).at_least(0).help("Coulomb's coefficient, for slip and separate."),
      K("push_out", &ColliderSettings::push_out)
          .help(
              "Particles that are inside, because a body was placed there, are moved to the nearest surface, by at most a "
              "tenth of a cell per step."),
      K("color", &ColliderSettings::color)
          .type(ValueType::vector3)
          .at_least(0)
          .at_most(1)
          .default_text("grey")
          .presentation()
          .help("Red, green, blue: linear reflectance."),
      K("look", &ColliderSettings::look)
          .presentation()
          .help("In pictures and the viewer: solid; glass: clear, mirrors the sky and casts no shadow; hidden: not "
                "drawn."),
  };
  section.keys.insert(section.keys.end(), more.begin(), more.end());
  return section;
}

Section make_pin_section() {
  Section section = list_section("pin", &Scene::pins,
                                 "A region that holds the material inside, or carries it along; one [[pin]] each.");
  section.keys = shape_keys<PinSettings>("pin<index>", "Names the pin.");
  section.keys.front().decides_result = false;
  const std::vector<Key> motion = motion_keys<PinSettings>();
  section.keys.insert(section.keys.end(), motion.begin(), motion.end());
  const std::vector<Key> more = {
      K("moves_with", &PinSettings::moves_with)
          .default_text("none")
          .help("Name of a [[collider]] that carries it along; `position` and `rotation` are those at t = 0."),
      K("start", &PinSettings::start)
          .unit("s")
          .at_least(0)
          .help("When it begins to act; a constant velocity begins then too, at `position`."),
      K("stop", &PinSettings::stop).unit("s").above(0).default_text("never").help("When it ends."),
  };
  section.keys.insert(section.keys.end(), more.begin(), more.end());
  return section;
}

std::span<const Key> keyframe_keys() {
  static const std::vector<Key> keys = {
      K("time", &KeyframeSettings::time).unit("s").required().help("When, s."),
      K("position", &KeyframeSettings::position).unit("m").help("Where, m."),
      K("rotation", &KeyframeSettings::rotation)
          .type(ValueType::rotation)
          .unit("degrees")
          .help("About the fixed axes x, then y, then z, degrees; one angle in 2D."),
      K("scale", &KeyframeSettings::scale).above(0).help("Factor on the size of the shape."),
  };
  return keys;
}

}  // namespace firn
