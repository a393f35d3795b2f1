#include <firn/scene/choice_names.h>
#include <firn/scene/schema_table.h>
#include <firn/scene/section_builder.h>

namespace firn {
namespace {

using K = KeyBuilder;

std::vector<Key> body_shape_keys() {
  return {
      K("name", &BodySettings::name).default_text("body<index>").presentation().help("Names the body in output."),
      K("mesh", &BodySettings::mesh)
          .path()
          .default_text("none")
          .help("Closed triangle mesh (OBJ, PLY, STL) to fill; the path starts at the scene file's folder."),
      K("polygon", &BodySettings::polygon)
          .path()
          .default_text("none")
          .help("2D: file with the closed outline to fill; the path starts at the scene file's folder."),
      K("shape", &BodySettings::shape)
          .default_text("none")
          .help("Instead of a file: box, sphere (3D) or disk (2D), centred on `position`."),
      K("size", &BodySettings::size).unit("m").above(0).required().only_with("shape", {"box"}).help("Edge lengths."),
      K("radius", &BodySettings::radius)
          .unit("m")
          .above(0)
          .required()
          .only_with("shape", {"sphere", "disk"})
          .help("Radius."),
      K("fill", &BodySettings::fill).help("poisson: random with a least distance; lattice: regular."),
      K("scale", &BodySettings::scale).above(0).help("Factor on the coordinates of mesh, polygon or shape."),
      K("units", &BodySettings::units).help("Unit of the coordinates in the mesh or polygon file."),
  };
}

}  // namespace

Section make_body_section() {
  Section section = list_section("body", &Scene::bodies, "Something made of particles; one [[body]] each.");
  section.exactly_one_of = {{"mesh", "polygon", "shape"}};
  section.keys = body_shape_keys();
  const std::vector<Key> more = {
      K("rotation", &BodySettings::rotation)
          .type(ValueType::rotation)
          .unit("degrees")
          .help("About the fixed axes x, then y, then z, before `position` is added; one angle in 2D."),
      K("position", &BodySettings::position).unit("m").help("Where the origin of mesh, polygon or shape goes."),
      K("material", &BodySettings::material).required().help("Name of a [material.<name>]."),
      K("velocity", &BodySettings::velocity)
          .unit("m/s")
          .help(
              "At t = 0; each component a number or a formula of the position x, y, z, such as \"0.1 * sin(pi * x)\"."),
      K("angular_velocity", &BodySettings::angular_velocity)
          .type(ValueType::rotation)
          .unit("rad/s")
          .help("At t = 0, about the centre of mass."),
      K("color", &BodySettings::color)
          .type(ValueType::vector3)
          .at_least(0)
          .at_most(1)
          .default_text("the material's look")
          .presentation()
          .help("Red, green, blue: linear reflectance."),
  };
  section.keys.insert(section.keys.end(), more.begin(), more.end());
  return section;
}

namespace {

std::vector<Key> collider_shape_keys() {
  return {
      K("name", &ColliderSettings::name).default_text("collider<index>").presentation().help("Names the collider."),
      K("shape", &ColliderSettings::shape)
          .required()
          .help("half_space is all that lies behind a plane (a line in 2D)."),
      K("normal", &ColliderSettings::normal)
          .only_with("shape", {"half_space"})
          .default_text("along `up`")
          .help("Direction out of the solid; any length but zero."),
      K("size", &ColliderSettings::size)
          .unit("m")
          .above(0)
          .required()
          .only_with("shape", {"box"})
          .help("Edge lengths."),
      K("radius", &ColliderSettings::radius)
          .unit("m")
          .above(0)
          .required()
          .only_with("shape", {"sphere"})
          .help("Radius; the sphere is a disk in 2D."),
  };
}

}  // namespace

Section make_collider_section() {
  Section section = list_section("collider", &Scene::colliders, "A rigid obstacle; one [[collider]] each.");
  section.keys = collider_shape_keys();
  const std::vector<Key> more = {
      K("position", &ColliderSettings::position)
          .unit("m")
          .help("Centre at t = 0, or a point on the half space's plane."),
      K("rotation", &ColliderSettings::rotation)
          .type(ValueType::rotation)
          .unit("degrees")
          .help("At t = 0, about the fixed axes x, then y, then z; one angle in 2D."),
      K("velocity", &ColliderSettings::velocity).unit("m/s").help("Constant."),
      K("angular_velocity", &ColliderSettings::angular_velocity)
          .type(ValueType::rotation)
          .unit("rad/s")
          .help("Constant, about `position`."),
      K("contact", &ColliderSettings::contact)
          .help("sticky: what touches moves along; slip: slides and never leaves; separate: slides and may leave."),
      K("friction", &ColliderSettings::friction).at_least(0).help("Coulomb's coefficient, for slip and separate."),
      K("color", &ColliderSettings::color)
          .type(ValueType::vector3)
          .at_least(0)
          .at_most(1)
          .default_text("grey")
          .presentation()
          .help("Red, green, blue: linear reflectance."),
  };
  section.keys.insert(section.keys.end(), more.begin(), more.end());
  return section;
}

}  // namespace firn
