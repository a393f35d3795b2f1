#include <firn/scene/key_builder.h>
#include <firn/scene/schema_table.h>

namespace firn {

template <>
struct ChoiceNames<Scene::Precision> {
  static constexpr std::string_view list[] = {"single", "double"};
};
template <>
struct ChoiceNames<Scene::Up> {
  static constexpr std::string_view list[] = {"y", "z"};
};
template <>
struct ChoiceNames<Scene::Rollback> {
  static constexpr std::string_view list[] = {"memory", "off"};
};
template <>
struct ChoiceNames<MethodSettings::Transfer> {
  static constexpr std::string_view list[] = {"pic", "flip", "pic_flip", "apic"};
};
template <>
struct ChoiceNames<MethodSettings::Kernel> {
  static constexpr std::string_view list[] = {"linear", "quadratic", "cubic"};
};
template <>
struct ChoiceNames<MethodSettings::Form> {
  static constexpr std::string_view list[] = {"mls", "gradient"};
};
template <>
struct ChoiceNames<BodySettings::Shape> {
  static constexpr std::string_view list[] = {"box", "sphere", "disk"};
};
template <>
struct ChoiceNames<BodySettings::Fill> {
  static constexpr std::string_view list[] = {"poisson", "lattice"};
};
template <>
struct ChoiceNames<BodySettings::Units> {
  static constexpr std::string_view list[] = {"m", "cm", "mm"};
};
template <>
struct ChoiceNames<ColliderSettings::Shape> {
  static constexpr std::string_view list[] = {"half_space", "box", "sphere"};
};
template <>
struct ChoiceNames<ColliderSettings::Contact> {
  static constexpr std::string_view list[] = {"sticky", "slip", "separate"};
};

namespace {

using K = KeyBuilder;

/// A section that is one struct of the scene.
template <class Settings>
Section table(std::string_view name, Settings Scene::*member, std::string_view help) {
  Section section;
  section.name = name;
  section.help = help;
  section.count = [](const Scene&) { return std::size_t(1); };
  section.add = [member](Scene& scene) -> void* { return &(scene.*member); };
  section.at = [member](Scene& scene, std::size_t) -> void* { return &(scene.*member); };
  return section;
}

/// A section that is a list of structs of the scene.
template <class Settings>
Section list(std::string_view name, std::vector<Settings> Scene::*member, std::string_view help) {
  Section section;
  section.kind = SectionKind::list;
  section.name = name;
  section.help = help;
  section.count = [member](const Scene& scene) { return (scene.*member).size(); };
  section.add = [member](Scene& scene) -> void* { return &(scene.*member).emplace_back(); };
  section.at = [member](Scene& scene, std::size_t i) -> void* { return &(scene.*member)[i]; };
  return section;
}

Section root() {
  Section section;
  section.kind = SectionKind::root;
  section.help = "Keys at the top of the file, before the first [section].";
  section.count = [](const Scene&) { return std::size_t(1); };
  section.add = [](Scene& scene) -> void* { return &scene; };
  section.at = [](Scene& scene, std::size_t) -> void* { return &scene; };
  section.keys = {
      K("title", &Scene::title).presentation().default_text("none").help("A line of text for people."),
      K("dimension", &Scene::dimension).at_least(2).at_most(3).help("2 (plane strain) or 3."),
      K("precision", &Scene::precision).help("Arithmetic of the simulation: single is twice as fast."),
      K("up", &Scene::up).help("The axis that points up."),
      K("seed", &Scene::seed).at_least(0).help("Number that the random placement of particles starts from."),
      K("end_time", &Scene::end_time).unit("s").above(0).required().help("Simulated time at which the run ends."),
      K("frame_rate", &Scene::frame_rate)
          .unit("1/s")
          .above(0)
          .at_most(1e6)
          .help("Frames per second; frame 1 is t = 0."),
      K("gravity", &Scene::gravity).unit("m/s^2").default_text("9.81 against `up`").help("Acceleration of everything."),
      K("rollback", &Scene::rollback)
          .help("memory: keep the last accepted frame, and try again from it with smaller steps when a step fails."),
      K("threads", &Scene::threads).at_least(0).presentation().help("0: as many as the machine has."),
      K("strict_mesh", &Scene::strict_mesh).help("An open mesh is an error instead of a warning."),
  };
  return section;
}

Section resolution() {
  Section section = table("resolution", &Scene::resolution, "How fine: give cell_size or particles.");
  section.exactly_one_of = {{"cell_size", "particles"}};
  section.keys = {
      K("cell_size", &ResolutionSettings::cell_size)
          .unit("m")
          .above(0)
          .default_text("from particles")
          .help("Edge length of a grid cell."),
      K("particles", &ResolutionSettings::particles)
          .at_least(1)
          .default_text("from cell_size")
          .help("Number of particles of all bodies together; the cell size follows."),
      K("particles_per_cell", &ResolutionSettings::particles_per_cell)
          .at_least(1)
          .at_most(1000)
          .default_text("8 in 3D, 4 in 2D")
          .help("Mean number of particles in a full cell."),
  };
  return section;
}

Section method() {
  Section section = table("method", &Scene::method, "Which material point method.");
  section.keys = {
      K("transfer", &MethodSettings::transfer)
          .help("How velocity goes between particles and grid: apic conserves angular momentum, pic damps, flip is "
                "noisy."),
      K("flip_blend", &MethodSettings::flip_blend)
          .at_least(0)
          .at_most(1)
          .only_with("transfer", {"pic_flip"})
          .help("Share of FLIP in the blend; the rest is PIC."),
      K("kernel", &MethodSettings::kernel).help("B-spline that joins particles and grid nodes."),
      K("form", &MethodSettings::form)
          .help("Of the internal force: mls (Hu et al. 2018) or the gradient of the kernel; linear needs gradient."),
      K("periodic", &MethodSettings::periodic)
          .unit("m")
          .at_least(0)
          .help("Length after which an axis repeats, a multiple of 4 cells; 0: the axis is unbounded."),
  };
  return section;
}

Section limits() {
  Section section = table("limits", &Scene::limits, "Bounds of the time step and of the particles.");
  section.keys = {
      K("particle_cfl", &LimitSettings::particle_cfl)
          .above(0)
          .at_most(1)
          .help("Cells that the fastest particle may cross in one step."),
      K("elastic_cfl", &LimitSettings::elastic_cfl)
          .above(0)
          .at_most(1)
          .help("Cells that the fastest elastic wave may cross in one step."),
      K("max_dt", &LimitSettings::max_dt).unit("s").above(0).default_text("none").help("Longest time step."),
      K("speed", &LimitSettings::speed)
          .unit("m/s")
          .above(0)
          .default_text("none")
          .help("A particle faster than this is parked: it takes no further part and is counted."),
      K("box", &LimitSettings::box)
          .unit("m")
          .default_text("none")
          .help("Lowest and highest corner; a particle that leaves the box is parked."),
  };
  return section;
}

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

Section bodies() {
  Section section = list("body", &Scene::bodies, "Something made of particles; one [[body]] each.");
  section.exactly_one_of = {{"mesh", "polygon", "shape"}};
  section.keys = body_shape_keys();
  const std::vector<Key> more = {
      K("rotation", &BodySettings::rotation)
          .type(ValueType::rotation)
          .unit("degrees")
          .help("About the fixed axes x, then y, then z, before `position` is added; one angle in 2D."),
      K("position", &BodySettings::position).unit("m").help("Where the origin of mesh, polygon or shape goes."),
      K("material", &BodySettings::material).required().help("Name of a [material.<name>]."),
      K("velocity", &BodySettings::velocity).unit("m/s").help("At t = 0."),
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

Section colliders() {
  Section section = list("collider", &Scene::colliders, "A rigid obstacle; one [[collider]] each.");
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

Section camera() {
  Section section = table("camera", &Scene::camera, "Where pictures are taken from.");
  section.keys = {
      K("position", &CameraSettings::position)
          .type(ValueType::vector3)
          .unit("m")
          .default_text("frames the scene")
          .presentation()
          .help("The eye; three numbers also in 2D."),
      K("target", &CameraSettings::target)
          .type(ValueType::vector3)
          .unit("m")
          .default_text("middle of the scene")
          .presentation()
          .help("What the camera looks at; three numbers also in 2D."),
      K("up", &CameraSettings::up)
          .type(ValueType::vector3)
          .default_text("along the scene's `up`")
          .presentation()
          .help("Direction that is upward in the picture."),
      K("field_of_view", &CameraSettings::field_of_view)
          .unit("degrees")
          .above(0)
          .below(180)
          .presentation()
          .help("Vertical opening angle."),
  };
  return section;
}

Section render() {
  Section section = table("render", &Scene::render, "Pictures and film.");
  section.keys = {
      K("width", &RenderSettings::width)
          .unit("pixels")
          .at_least(16)
          .at_most(16384)
          .presentation()
          .help("Picture width."),
      K("height", &RenderSettings::height)
          .unit("pixels")
          .at_least(16)
          .at_most(16384)
          .presentation()
          .help("Picture height."),
      K("samples", &RenderSettings::samples)
          .at_least(1)
          .at_most(65536)
          .presentation()
          .help("Rays per pixel: less noise."),
      K("color_by", &RenderSettings::color_by)
          .presentation()
          .help("\"material\" for its look, or a column of the frames, such as \"velocity\" or \"pressure\"."),
      K("range", &RenderSettings::range)
          .default_text("automatic")
          .presentation()
          .help("Lowest and highest value of the colour bar, in the unit of the column."),
      K("film", &RenderSettings::film).presentation().help("Join the pictures to film.mp4."),
      K("every_nth", &RenderSettings::every_nth)
          .at_least(0)
          .presentation()
          .help("Make a picture of every n-th frame; 0: of none."),
  };
  return section;
}

Section output() {
  Section section = table("output", &Scene::output, "Where results go.");
  section.keys = {
      K("folder", &OutputSettings::folder)
          .default_text("out/<name of the scene file>")
          .presentation()
          .help("Results folder; the path starts at the current folder."),
  };
  return section;
}

}  // namespace

std::vector<Section> make_schema() {
  return {root(),   resolution(), method(), limits(), make_material_section(),
          bodies(), colliders(),  camera(), render(), output()};
}

}  // namespace firn
