#include <firn/apps/particle_colors.h>
#include <firn/io/point_files.h>
#include <firn/render/particle_color.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace firn {
namespace {

Vec3f color_of(const Vec3d& color) {
  return {{static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])}};
}

}  // namespace

std::vector<Vec3f> particle_colors(const Snapshot& snapshot, const Scene* scene) {
  View view;
  if (scene != nullptr) {
    for (const BodySettings& body : scene->bodies) {
      if (body.color) view.body_colors[body.name] = color_of(*body.color);
    }
    for (const EmitterSettings& emitter : scene->emitters) {
      if (emitter.color) view.body_colors[emitter.name] = color_of(*emitter.color);
    }
  }
  return particle_looks(snapshot, view).color;
}

void add_color_column(Snapshot& snapshot, const Scene* scene) {
  const std::vector<Vec3f> colors = particle_colors(snapshot, scene);
  std::vector<std::int32_t> values;
  values.reserve(3 * colors.size());
  for (const Vec3f& color : colors) {
    for (const float linear : color.e) {
      const float srgb = srgb_from_linear(std::clamp(linear, 0.0F, 1.0F));
      values.push_back(static_cast<std::int32_t>(std::lround(255 * srgb)));
    }
  }
  snapshot.columns.push_back({kColorColumn, "", "sRGB, 0 to 255.", 3, std::move(values)});
}

void add_light_column(Snapshot& snapshot, const Scene* scene) {
  std::vector<float> values;
  for (const Vec3f& color : particle_colors(snapshot, scene)) values.insert(values.end(), color.e, color.e + 3);
  snapshot.columns.push_back({kColorColumn, "", "Linear RGB.", 3, std::move(values)});
}

}  // namespace firn
