#include <firn/scene/complete_objects.h>
#include <firn/scene/nearest.h>
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

/// @param own_motion whether the object says how it moves in another way
void check_moves_with(const SceneDraft& draft, std::string_view section, std::size_t i, const std::string& collider,
                      bool own_motion) {
  if (collider.empty()) return;
  if (own_motion) {
    draft.fail(section, i, "moves_with", "moves_with excludes a motion of its own; keep one");
  }
  std::vector<std::string> names;
  for (const ColliderSettings& known : draft.scene.colliders) names.push_back(known.name);
  if (std::ranges::find(names, collider) != names.end()) return;
  draft.fail(section, i, "moves_with",
             fmt::format("no [[collider]] has the name {}{}", in_quotes(collider),
                         names.empty() ? "" : suggestion(collider, names)));
}

void complete_carried(SceneDraft& draft, std::string_view section, std::size_t i, RegionSettings& region) {
  complete_keyframes(draft, section, i, region.position, region.rotation, region.keyframes);
  if (!region.trajectory.empty()) check_file(draft, section, i, "trajectory", region.trajectory);
  check_moves_with(draft, section, i, region.moves_with, !region.keyframes.empty() || !region.trajectory.empty());
}

/// Emitted particles have no mesh that values could be painted on.
void check_not_painted(const SceneDraft& draft, std::size_t i, const std::string& name) {
  const MaterialSettings& material = *draft.scene.find_material(name);
  for (const auto& [parameter, variation] : material.varied) {
    if (variation.kind != ParameterVariation::Kind::attribute) continue;
    draft.fail("emitter", i, "material",
               fmt::format("material {} has its {} painted on the mesh of a body, which an emitter does not have; give "
                           "it a formula or a spread, or use another material",
                           in_quotes(name), parameter));
  }
}

void complete_emitters(SceneDraft& draft) {
  Scene& scene = draft.scene;
  complete_names(draft, "emitter", scene.emitters);
  for (std::size_t i = 0; i < scene.emitters.size(); ++i) {
    EmitterSettings& emitter = scene.emitters[i];
    check_place(draft, "emitter", i, emitter.mesh, emitter.polygon, emitter.shape);
    check_material(draft, "emitter", i, emitter.material);
    check_not_painted(draft, i, emitter.material);
    complete_carried(draft, "emitter", i, emitter);
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
    SinkSettings& sink = draft.scene.sinks[i];
    check_place(draft, "sink", i, sink.mesh, sink.polygon, sink.shape);
    check_times(draft, "sink", i, sink);
    complete_carried(draft, "sink", i, sink);
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
  field.axis = unit_key(field.axis);
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
  for (std::size_t i = 0; i < draft.scene.pins.size(); ++i) {
    PinSettings& pin = draft.scene.pins[i];
    check_times(draft, "pin", i, pin);
    complete_shape(draft, "pin", i, pin, draft.scene.parts.size());
    complete_motion(draft, "pin", i, pin);
    const bool moves = norm(pin.velocity) > 0 || norm(pin.angular_velocity) > 0;
    check_moves_with(draft, "pin", i, pin.moves_with, moves || !pin.keyframes.empty() || !pin.trajectory.empty());
  }
}

void complete_normal(const SceneDraft& draft, std::size_t i, TractionSettings& traction) {
  if (!draft.has("traction", i, "normal")) {
    for (int axis = 0; axis < 3; ++axis) {
      const NumberOrFormula& component = (*traction.stress)[static_cast<std::size_t>(axis)];
      if (!component.formula.empty()) {
        draft.fail("traction", i, "normal",
                   "a stress with a formula needs normal, the direction of the face it acts on");
      }
      traction.normal[axis] = component.number;
    }
  }
  if (norm(traction.normal) == 0) {
    draft.fail("traction", i, "normal", "normal must not be zero; it is the direction of the face that stress acts on");
  }
  traction.normal = unit_key(traction.normal);
}

void complete_tractions(SceneDraft& draft) {
  Scene& scene = draft.scene;
  complete_names(draft, "traction", scene.tractions);
  for (std::size_t i = 0; i < scene.tractions.size(); ++i) {
    TractionSettings& traction = scene.tractions[i];
    check_place(draft, "traction", i, traction.mesh, traction.polygon, traction.shape);
    check_times(draft, "traction", i, traction);
    if (traction.stress) complete_normal(draft, i, traction);
    if (traction.pressure && norm(traction.normal) > 0) {
      draft.fail("traction", i, "normal", "normal goes with stress; a pressure acts along the surface's own");
    }
    if (traction.body.empty()) continue;
    std::vector<std::string> names;
    for (const BodySettings& body : scene.bodies) names.push_back(body.name);
    if (std::ranges::find(names, traction.body) != names.end()) continue;
    draft.fail("traction", i, "body",
               fmt::format("no [[body]] has the name {}{}", in_quotes(traction.body),
                           names.empty() ? "" : suggestion(traction.body, names)));
  }
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
  complete_tractions(draft);
  complete_probes(draft);
}

}  // namespace firn
