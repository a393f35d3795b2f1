#include <firn/scene/choice_names.h>
#include <firn/scene/schema_table.h>

namespace firn {

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
      K("end_time", &Scene::end_time)
          .unit("s")
          .above(0)
          .required()
          .presentation()
          .help("Simulated time at which the run ends."),
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
          .help("Length after which an axis repeats, a multiple of 4 cells (8 in 2D); 0: the axis is unbounded."),
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
          .help("Lowest and highest corner; a particle that leaves the box is parked. Bodies must start inside."),
      K("clip", &LimitSettings::clip).help("Leave out what of the bodies is outside `box` at the start."),
  };
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
      K("film_rate", &RenderSettings::film_rate)
          .unit("1/s")
          .above(0)
          .at_most(240)
          .default_text("as fast as it happened, at most 60")
          .presentation()
          .help("Pictures per second of the film: fewer than are taken per simulated second play it in slow motion."),
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

Section checkpoint() {
  Section section = table("checkpoint", &Scene::checkpoint,
                          "When the whole state is saved, besides at frame 1 and at the end, for `firn resume`.");
  section.keys = {
      K("every_minutes", &CheckpointSettings::every_minutes)
          .unit("min")
          .at_least(0)
          .presentation()
          .help("Minutes of computing that a crash may cost; 0: not by the clock."),
      K("every_frames", &CheckpointSettings::every_frames)
          .at_least(0)
          .presentation()
          .help("A checkpoint after every n-th frame, for `firn resume --from-frame`; 0: not by frames."),
      K("keep", &CheckpointSettings::keep)
          .at_least(0)
          .presentation()
          .help("How many checkpoints stay, the newest ones; 0: all. An old one goes only when the new one is whole."),
  };
  return section;
}

}  // namespace

std::vector<Section> make_schema() {
  return {root(),
          resolution(),
          method(),
          limits(),
          make_material_section(),
          make_body_section(),
          make_part_section(),
          make_collider_section(),
          make_emitter_section(),
          make_sink_section(),
          make_field_section(),
          make_pin_section(),
          make_traction_section(),
          make_probe_section(),
          camera(),
          render(),
          output(),
          checkpoint()};
}

}  // namespace firn
