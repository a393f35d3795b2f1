#include <firn/core/log.h>
#include <firn/materials/model_info.h>
#include <firn/scene/complete_objects.h>
#include <firn/scene/value_text.h>
#include <firn/state/cell_key.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

namespace firn {
namespace {

constexpr double kEarthGravity = 9.81;  // m/s^2
/// Frames have 32-bit numbers in some programs that read them, and nobody waits for more.
constexpr double kMostFrames = 1e9;
/// Threads beyond these only cost memory and time. Some more than processors are of use: to test that any number gives
/// the same bits, and on machines that hide processors.
constexpr int kThreadsPerProcessor = 4, kThreadsAnywhere = 64;

void limit_threads(SceneDraft& draft) {
  const int processors = std::max(static_cast<int>(std::thread::hardware_concurrency()), 1);
  const int most = std::max(kThreadsPerProcessor * processors, kThreadsAnywhere);
  if (draft.scene.threads <= most) return;
  log_warning(
      fmt::format("{}: threads = {} is too many for {} processor{}; going on with {}, which gives the same bits",
                  draft.document.name, draft.scene.threads, processors, processors == 1 ? "" : "s", most));
  draft.scene.threads = most;
}

void check_frame_count(const SceneDraft& draft) {
  const double frames = draft.scene.end_time * draft.scene.frame_rate;
  if (frames <= kMostFrames) return;
  draft.fail("", 0, "end_time",
             fmt::format("end_time must give at most {:g} frames, got {:.3g} ({} s at a frame_rate of {} 1/s); use a "
                         "shorter end_time or a lower frame_rate",
                         kMostFrames, frames, number_text(draft.scene.end_time), number_text(draft.scene.frame_rate)));
}

void complete_root(SceneDraft& draft) {
  Scene& scene = draft.scene;
  if (scene.dimension == 2 && scene.up == Scene::Up::z) draft.fail("", 0, "up", "up must be \"y\" in a 2D scene");
  if (!draft.has("", 0, "gravity")) scene.gravity[scene.up == Scene::Up::y ? 1 : 2] = -kEarthGravity;
  if (norm(scene.gravity) > 100 * kEarthGravity) {
    log_warning(fmt::format("{}: gravity is {} m/s^2, {:.0f} times the Earth's; lengths are in metres",
                            draft.document.name, number_text(norm(scene.gravity)),
                            norm(scene.gravity) / kEarthGravity));
  }
  check_frame_count(draft);
  limit_threads(draft);
  if (!draft.has("resolution", 0, "particles_per_cell")) {
    scene.resolution.particles_per_cell = scene.dimension == 3 ? 8 : 4;
  }
  if (!draft.has("output", 0, "folder"))
    scene.output.folder = (std::filesystem::path("out") / scene.file.stem()).string();
}

void complete_method(const SceneDraft& draft) {
  const MethodSettings& method = draft.scene.method;
  if (method.form == MethodSettings::Form::mls && method.kernel == MethodSettings::Kernel::linear) {
    draft.fail("method", 0, "kernel",
               "kernel \"linear\" does not work with form \"mls\", whose matrix D vanishes at grid nodes; "
               "use form = \"gradient\" or kernel = \"quadratic\"");
  }
  if (method.kernel == MethodSettings::Kernel::linear) {
    log_warning(
        fmt::format("{}: the linear kernel is for teaching: its gradient does not vanish where a node's mass does, so "
                    "stressed particles at a free surface can turn inside out within a few steps",
                    draft.document.name));
  }
  const std::optional<double> cell = draft.scene.resolution.cell_size;
  if (!cell) return;
  const int side = draft.scene.dimension == 3 ? kBlockSide<3> : kBlockSide<2>;
  const double block = side * *cell;
  for (int axis = 0; axis < 3; ++axis) {
    const double blocks = method.periodic[axis] / block;
    if (std::abs(blocks - std::round(blocks)) > 1e-9 * std::max(1.0, blocks)) {
      draft.fail("method", 0, "periodic",
                 fmt::format("periodic must be a multiple of {} cells, {} m, on each axis, got {}", side,
                             number_text(block), number_text(method.periodic[axis])));
    }
  }
}

void complete_limits(const SceneDraft& draft) {
  if (draft.scene.limits.clip && !draft.scene.limits.box) {
    draft.fail("limits", 0, "clip", "clip needs a box to clip to; give limits.box");
  }
  if (const auto& box = draft.scene.limits.box) {
    for (int axis = 0; axis < draft.scene.dimension; ++axis) {
      if (box->lower[axis] < box->upper[axis]) continue;
      draft.fail("limits", 0, "box",
                 fmt::format("box must have its lowest corner first; on axis {} got {} and {}", "xyz"[axis],
                             number_text(box->lower[axis]), number_text(box->upper[axis])));
    }
  }
}

/// An angle that is allowed but looks as if it were given in radians.
void warn_of_radians(const MaterialSettings& material) {
  const ModelInfo* model = find_model(material.model);
  if (model == nullptr) return;
  for (const Parameter& parameter : model->parameters) {
    if (parameter.unit != "degrees" || material.varied.contains(std::string(parameter.name))) continue;
    const auto found = material.parameters.find(std::string(parameter.name));
    if (found == material.parameters.end() || !(found->second > 0 && found->second < std::numbers::pi / 2)) continue;
    log_warning(
        fmt::format("material {}: {} is {} degrees; {} radians would be {:.3g} degrees: if that was meant, "
                    "write {:.3g}",
                    in_quotes(material.name), parameter.name, number_text(found->second), number_text(found->second),
                    found->second * 180 / std::numbers::pi, found->second * 180 / std::numbers::pi));
  }
}

void complete_materials(const SceneDraft& draft) {
  const Scene& scene = draft.scene;
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const MaterialSettings& material = scene.materials[i];
    const Preset* preset = find_preset(material.preset);
    if (preset && preset->model != material.model) {
      draft.fail("material", i, "model",
                 fmt::format("preset {} has the model {}, got {}; leave out preset or model",
                             in_quotes(material.preset), in_quotes(preset->model), in_quotes(material.model)));
    }
    warn_of_radians(material);
  }
}

void complete_bodies(SceneDraft& draft) {
  complete_names(draft, "body", draft.scene.bodies);
  for (std::size_t i = 0; i < draft.scene.bodies.size(); ++i) {
    const BodySettings& body = draft.scene.bodies[i];
    check_place(draft, "body", i, body.mesh, body.polygon, body.shape);
    check_material(draft, "body", i, body.material);
  }
}

void complete_pictures(SceneDraft& draft) {
  CameraSettings& camera = draft.scene.camera;
  if (!draft.has("camera", 0, "up")) camera.up = up_direction(draft.scene);
  if (norm(camera.up) == 0) draft.fail("camera", 0, "up", "up must not be zero");
  if (camera.position && camera.target && norm(*camera.position - *camera.target) == 0) {
    draft.fail("camera", 0, "target", "target must differ from position");
  }
  const RenderSettings& render = draft.scene.render;
  if (render.range && !((*render.range)[0] < (*render.range)[1])) {
    draft.fail("render", 0, "range",
               fmt::format("range must have its lower value first, got {} and {}", number_text((*render.range)[0]),
                           number_text((*render.range)[1])));
  }
}

}  // namespace

Vec3d up_direction(const Scene& scene) { return scene.up == Scene::Up::y ? Vec3d{{0, 1, 0}} : Vec3d{{0, 0, 1}}; }

void check_file(const SceneDraft& draft, std::string_view section, std::size_t index, std::string_view key,
                const std::string& file) {
  const std::filesystem::path path = draft.scene.locate(file);
  std::error_code ignored;
  // A pipe without a writer would block for ever.
  if (std::filesystem::is_regular_file(path, ignored)) return;
  draft.fail(
      section, index, key,
      fmt::format("{} {} is not a file (looked for {}); paths start at the scene file's folder", key, in_quotes(file),
                  one_line(std::filesystem::absolute(path, ignored).lexically_normal().string())),
      ErrorKind::files);
}

void complete_scene(SceneDraft& draft) {
  complete_root(draft);
  complete_method(draft);
  complete_limits(draft);
  complete_materials(draft);
  complete_bodies(draft);
  complete_names(draft, "part", draft.scene.parts);
  complete_names(draft, "collider", draft.scene.colliders);
  complete_colliders(draft);
  complete_sources(draft);
  complete_pictures(draft);
}

}  // namespace firn
