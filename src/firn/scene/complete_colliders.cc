#include <firn/scene/complete_objects.h>
#include <firn/scene/nearest.h>
#include <firn/scene/sequence_files.h>
#include <firn/scene/value_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace firn {
namespace {

using Kind = ShapeSettings::Shape;

void normalize_key(const SceneDraft& draft, std::string_view section, std::size_t i, std::string_view key, Vec3d& v) {
  if (!draft.has(section, i, key)) v = up_direction(draft.scene);
  if (norm(v) == 0) draft.fail(section, i, key, fmt::format("{} must not be zero", key));
  v = unit_key(v);
}

void check_dimension(const SceneDraft& draft, std::string_view section, std::size_t i, Kind shape) {
  const bool flat = draft.scene.dimension == 2;
  const bool solid = shape == Kind::cylinder || shape == Kind::cone || shape == Kind::torus ||
                     shape == Kind::height_field || shape == Kind::mesh || shape == Kind::mesh_sequence ||
                     shape == Kind::level_set_sequence;
  if (flat && solid) {
    draft.fail(section, i, "shape",
               "this shape needs a 3D scene; in 2D use box, rounded_box, sphere, capsule or polygon");
  }
  if (!flat && shape == Kind::polygon) draft.fail(section, i, "shape", "polygon needs dimension = 2; in 3D use mesh");
}

/// @param earlier how many of the scene's parts a shape may be made of
void check_parts(const SceneDraft& draft, std::string_view section, std::size_t i, const ShapeSettings& shape,
                 std::size_t earlier) {
  if (shape.parts.empty()) draft.fail(section, i, "parts", "parts must name at least one [[part]]");
  std::vector<std::string> names;
  for (std::size_t p = 0; p < earlier; ++p) names.push_back(draft.scene.parts[p].name);
  for (const std::string& part : shape.parts) {
    if (std::ranges::find(names, part) != names.end()) continue;
    if (draft.scene.find_part(part)) {
      draft.fail(section, i, "parts",
                 fmt::format("the [[part]] {} must stand before what it is a part of", in_quotes(part)));
    }
    draft.fail(
        section, i, "parts",
        fmt::format("no [[part]] has the name {}{}", in_quotes(part), names.empty() ? "" : suggestion(part, names)));
  }
}

}  // namespace

void complete_shape(SceneDraft& draft, std::string_view section, std::size_t i, ShapeSettings& shape,
                    std::size_t earlier) {
  check_dimension(draft, section, i, shape.shape);
  switch (shape.shape) {
    case Kind::half_space:
      return normalize_key(draft, section, i, "normal", shape.normal);
    case Kind::capsule:
    case Kind::cylinder:
    case Kind::cone:
    case Kind::torus:
      return normalize_key(draft, section, i, "axis", shape.axis);
    case Kind::height_field:
      if (!draft.has(section, i, "depth")) {
        const int up = draft.scene.up == Scene::Up::y ? 1 : 2;
        shape.depth = 0.25 * std::max(shape.size[0], shape.size[3 - up]);
      }
      return check_file(draft, section, i, "file", shape.file);
    case Kind::polygon:
    case Kind::mesh:
      return check_file(draft, section, i, "file", shape.file);
    case Kind::union_:
    case Kind::intersection:
    case Kind::difference:
      return check_parts(draft, section, i, shape, earlier);
    default:
      return;
  }
}

void check_sequence(const SceneDraft& draft, std::size_t i, const ColliderSettings& collider) {
  if (!collider.is_sequence()) return;
  const bool meshes = collider.shape == Kind::mesh_sequence;
  const std::string_view key = meshes ? "meshes" : "level_sets";
  const auto given = [&](std::string_view name) { return draft.has("collider", i, name); };
  std::size_t count = 0;
  try {
    count = sequence_files(draft.scene, collider).size();
  } catch (const Error& error) {
    draft.fail("collider", i, key, fmt::format("{}: {}", key, error.what()), error.kind());
  }
  if (given("fps") == given("times")) {
    draft.fail("collider", i, given("times") ? "times" : "shape",
               fmt::format("a sequence needs one of fps and times, got {}", given("fps") ? "both" : "none"));
  }
  if (given("times") && collider.times.size() != count) {
    draft.fail("collider", i, "times",
               fmt::format("times has {} numbers for {} files of {}", collider.times.size(), count, key));
  }
  for (std::size_t k = 1; k < collider.times.size(); ++k) {
    if (collider.times[k - 1] < collider.times[k]) continue;
    draft.fail("collider", i, "times",
               fmt::format("times must increase, got {} s after {} s", number_text(collider.times[k]),
                           number_text(collider.times[k - 1])));
  }
  if (!meshes && collider.interpolation == ColliderSettings::Interpolation::smooth) {
    draft.fail(
        "collider", i, "interpolation",
        "level sets are interpolated linearly, which keeps them distances; use a mesh_sequence for smooth motion");
  }
  if (collider.at_end == ColliderSettings::AtEnd::cycle && count < 2) {
    draft.fail("collider", i, "at_end", fmt::format("a cycle needs at least 2 entries, {} has {}", key, count));
  }
}

void complete_keyframes(const SceneDraft& draft, std::string_view section, std::size_t i, const Vec3d& position,
                        const Vec3d& rotation, std::vector<KeyframeSettings>& keyframes) {
  const auto given = [&](std::string_view key) { return draft.has(section, i, key); };
  if (given("keyframes") && given("trajectory")) {
    draft.fail(section, i, "trajectory", "keyframes and trajectory exclude each other; keep one");
  }
  if (given("keyframes") && keyframes.empty()) {
    draft.fail(section, i, "keyframes", "keyframes must have at least one entry");
  }
  const auto fail = [&](std::size_t k, const std::string& what) {
    draft.fail(section, i, "keyframes", fmt::format("keyframes: entry {}: {}", k + 1, what));
  };
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    KeyframeSettings& frame = keyframes[k];
    if (!frame.position) frame.position = position;
    if (!frame.rotation) frame.rotation = rotation;
    if (!frame.scale) frame.scale = 1;
    if (k == 0) continue;
    const KeyframeSettings& last = keyframes[k - 1];
    if (!(last.time < frame.time)) {
      fail(k, fmt::format("times must increase, got {} s after {} s", number_text(frame.time), number_text(last.time)));
    }
    for (int axis = 0; axis < 3 && draft.scene.dimension == 3; ++axis) {
      const double turn = std::abs((*frame.rotation)[axis] - (*last.rotation)[axis]);
      if (turn < 180) continue;
      fail(k,
           fmt::format("rotation changes by {} degrees about {}; the shortest way is taken, so keep changes below 180 "
                       "(more keyframes, or angular_velocity)",
                       number_text(turn), "xyz"[axis]));
    }
  }
}

void complete_motion(const SceneDraft& draft, std::string_view section, std::size_t i, ColliderSettings& collider) {
  complete_keyframes(draft, section, i, collider.position, collider.rotation, collider.keyframes);
  const auto given = [&](std::string_view key) { return draft.has(section, i, key); };
  const bool framed = given("keyframes") || given("trajectory");
  for (const std::string_view key : {"velocity", "angular_velocity"}) {
    const Vec3d& value = key == "velocity" ? collider.velocity : collider.angular_velocity;
    if (framed && given(key) && norm(value) > 0) {
      draft.fail(section, i, key, fmt::format("{} excludes keyframes and trajectory; keep one", key));
    }
  }
  if (!collider.trajectory.empty()) check_file(draft, section, i, "trajectory", collider.trajectory);
}

void complete_colliders(SceneDraft& draft) {
  Scene& scene = draft.scene;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    if (scene.parts[i].shape == Kind::mesh_sequence || scene.parts[i].shape == Kind::level_set_sequence) {
      draft.fail("part", i, "shape", "a sequence cannot be a part of other shapes; make it a [[collider]] of its own");
    }
    complete_shape(draft, "part", i, scene.parts[i], i);
  }
  for (std::size_t i = 0; i < scene.colliders.size(); ++i) {
    complete_shape(draft, "collider", i, scene.colliders[i], scene.parts.size());
    check_sequence(draft, i, scene.colliders[i]);
    complete_motion(draft, "collider", i, scene.colliders[i]);
  }
}

}  // namespace firn
