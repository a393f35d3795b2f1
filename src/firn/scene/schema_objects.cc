#include <firn/scene/choice_names.h>
#include <firn/scene/list_section.h>
#include <firn/scene/schema_table.h>

namespace firn {
namespace {

using K = KeyBuilder;

std::vector<Key> body_shape_keys() {
  return {
      K("name", &BodySettings::name).default_text("body<index>").presentation().help("Names the body in output."),
      K("mesh", &BodySettings::mesh)
          .path()
          .default_text("none")
          .help("Closed triangle mesh (OBJ, PLY, STL, glTF, FBX ...) to fill; the path starts at the scene "
                "file's folder."),
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

}  // namespace firn
