#include <firn/scene/complete_objects.h>
#include <firn/scene/value_text.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace firn {
namespace {

template <class Settings>
void check_times(const SceneDraft& draft, std::string_view section, std::size_t i, const Settings& object) {
  if (!object.stop || *object.stop > object.start) return;
  draft.fail(
      section, i, "stop",
      fmt::format("stop must be after start, got {} s and {} s", number_text(*object.stop), number_text(object.start)));
}

void complete_emitters(SceneDraft& draft) {
  Scene& scene = draft.scene;
  complete_names(draft, "emitter", scene.emitters);
  for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
    const EmitterSettings& emitter = scene.emitters[i];
    check_place(draft, "emitter", i, emitter.mesh, emitter.polygon, emitter.shape);
    check_material(draft, "emitter", i, emitter.material);
    check_times(draft, "emitter", i, emitter);
    const bool has_body =
        std::ranges::any_of(scene.bodies, [&](const auto& body) { return body.name == emitter.name; });
    if (has_body) draft.fail("emitter", i, "name", "a body has the same name; names must differ");
    if (emitter.keep_full) {
      if (!*emitter.keep_full) {
        draft.fail("emitter", i, "keep_full", "keep_full can only be true; for a rate give mass_rate or volume_rate");
      }
    } else if (norm(emitter.velocity) == 0) {
      draft.fail("emitter", i, "velocity",
                 "a rate needs a velocity that carries the material away; give velocity, or keep_full = true");
    }
  }
  if (!scene.emitters.empty() && scene.bodies.empty() && scene.resolution.particles) {
    draft.fail("resolution", 0, "particles",
               "particles are counted in bodies, and the scene has none; give resolution.cell_size instead");
  }
}

void complete_sinks(SceneDraft& draft) {
  complete_names(draft, "sink", draft.scene.sinks);
  for (std::size_t i = 0; i < draft.scene.sinks.size(); ++i) {
    const SinkSettings& sink = draft.scene.sinks[i];
    check_place(draft, "sink", i, sink.mesh, sink.polygon, sink.shape);
    check_times(draft, "sink", i, sink);
  }
}

void complete_vortex(SceneDraft& draft, std::size_t i) {
  Scene& scene = draft.scene;
  FieldSettings& field = scene.fields[i];
  const bool flat = scene.dimension == 2;
  if (!draft.has("field", i, "axis")) field.axis = flat ? Vec3d{{0, 0, 1}} : up_direction(scene);
  if (norm(field.axis) == 0) draft.fail("field", i, "axis", "axis must not be zero");
  if (flat && (field.axis[0] != 0 || field.axis[1] != 0)) {
    draft.fail("field", i, "axis", "axis of a 2D scene must be along z: leave it out");
  }
  // A unit vector stays as it is, so that a resolved scene read back is the same scene.
  if (std::abs(norm(field.axis) - 1) > 1e-15) field.axis = normalized(field.axis);
}

void complete_fields(SceneDraft& draft) {
  Scene& scene = draft.scene;
  complete_names(draft, "field", scene.fields);
  for (std::size_t i = 0; i < scene.fields.size(); ++i) {
    const FieldSettings& field = scene.fields[i];
    check_times(draft, "field", i, field);
    if (field.type == FieldSettings::Type::vortex) complete_vortex(draft, i);
    for (int axis = 0; field.box && axis < scene.dimension; ++axis) {
      if (field.box->lower[axis] < field.box->upper[axis]) continue;
      draft.fail("field", i, "box",
                 fmt::format("box must have its lowest corner first; on axis {} got {} and {}", "xyz"[axis],
                             number_text(field.box->lower[axis]), number_text(field.box->upper[axis])));
    }
  }
}

void complete_pins(SceneDraft& draft) {
  complete_names(draft, "pin", draft.scene.pins);
  for (std::size_t i = 0; i < draft.scene.pins.size(); ++i) check_times(draft, "pin", i, draft.scene.pins[i]);
}

void complete_probes(SceneDraft& draft) {
  complete_names(draft, "probe", draft.scene.probes);
  for (std::size_t i = 0; i < draft.scene.probes.size(); ++i) {
    const ProbeSettings& probe = draft.scene.probes[i];
    const bool plain = std::ranges::all_of(
        probe.name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-'; });
    if (!plain) {
      draft.fail("probe", i, "name",
                 fmt::format("name becomes the name of a file and may have letters, digits, _ and -, got {}",
                             in_quotes(probe.name)));
    }
  }
}

}  // namespace

void complete_sources(SceneDraft& draft) {
  complete_emitters(draft);
  complete_sinks(draft);
  complete_fields(draft);
  complete_pins(draft);
  complete_probes(draft);
}

}  // namespace firn
