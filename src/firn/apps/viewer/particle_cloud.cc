#include <firn/apps/viewer/cloud_data.h>
#include <firn/apps/viewer/particle_cloud.h>
#include <firn/core/error.h>
#include <firn/render/look.h>
#include <fmt/format.h>

#include <algorithm>
#include <variant>

namespace firn {
namespace {

constexpr GLuint kPosition = 0, kValue = 1;
constexpr int kMapUnit = 0, kPaletteUnit = 1;

const char* const kVertexShader = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in float value;
uniform mat4 view, projection;
uniform float radius, height;
uniform int has_body, by_column, every, first;
uniform vec2 range;
uniform vec3 look;
uniform float jitter;
uniform sampler2D map, palette;
flat out vec3 color;
out vec3 center;

float unit_hash(uint x) {
  x ^= x >> 16; x *= 0x7feb352dU; x ^= x >> 15; x *= 0x846ca68bU; x ^= x >> 16;
  return float(x >> 8) / 16777216.0;
}

vec3 linear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045))); }

void main() {
  vec4 at = view * vec4(position, 1.0);
  cut(position);
  center = at.xyz;
  gl_Position = projection * at;
  gl_PointSize = max(height * projection[1][1] * radius / gl_Position.w, 1.0);
  if (by_column == 1) {
    float t = clamp((value - range.x) / (range.y - range.x), 0.0, 1.0);
    color = isnan(value) ? vec3(0.2) : linear(textureLod(map, vec2((t * 8.0 + 0.5) / 9.0, 0.5), 0.0).rgb);
  } else {
    vec4 body = has_body == 0 ? vec4(0.0) : texelFetch(palette, ivec2(int(value), 0), 0);
    vec3 base = body.a > 0.5 ? body.rgb : look;
    color = base * (1.0 + jitter * (2.0 * unit_hash(uint(first + gl_VertexID * every)) - 1.0));
  }
}
)";

const char* const kFragmentShader = R"(
uniform mat4 projection;
uniform float radius, wrap;
flat in vec3 color;
in vec3 center;
out vec4 pixel;
void main() {
  vec2 c = vec2(2.0, -2.0) * gl_PointCoord + vec2(-1.0, 1.0);
  float r2 = dot(c, c);
  if (r2 > 1.0) discard;
  vec3 normal = vec3(c, sqrt(1.0 - r2));
#ifdef BALL_DEPTH
  vec4 clip = projection * vec4(center + radius * normal, 1.0);
  gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
#endif
  pixel = vec4(displayed(lit(color, normal, wrap, center + radius * normal)), 1.0);
}
)";

/// New contents for a buffer, written by `write(void*)` into memory of the driver. A buffer of the right size is kept
/// and only declared void: the driver need neither wait for pictures that still use the old contents nor clear fresh
/// memory, which takes longer than the copy.
template <class Write>
void fill(GLuint buffer, std::size_t bytes, const Write& write) {
  glBindBuffer(GL_ARRAY_BUFFER, buffer);
  GLint present = 0;
  glGetBufferParameteriv(GL_ARRAY_BUFFER, GL_BUFFER_SIZE, &present);
  const auto size = static_cast<GLsizeiptr>(std::max<std::size_t>(bytes, 4));
  if (present != size) glBufferData(GL_ARRAY_BUFFER, size, nullptr, GL_STREAM_DRAW);
  void* to = glMapBufferRange(GL_ARRAY_BUFFER, 0, size, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT);
  if (to == nullptr) throw Error(ErrorKind::resources, "out of graphics memory; use fewer particles");
  write(to);
  glUnmapBuffer(GL_ARRAY_BUFFER);
}

const SnapshotColumn& find_column(const Snapshot& snapshot, const std::string& name) {
  if (const SnapshotColumn* column = snapshot.find(name)) return *column;
  throw Error(ErrorKind::usage, fmt::format("color_by: there is no column \"{}\"", name));
}

}  // namespace

ParticleCloud::ParticleCloud(bool software)
    : program_("particle", std::string(kClipGlsl) + kVertexShader,
               std::string(software ? "" : "#define BALL_DEPTH\n") + kDaylightGlsl + kFragmentShader) {}

void ParticleCloud::upload(const Snapshot& snapshot) {
  size_ = snapshot.size();
  spacing_ = static_cast<float>(snapshot.particle_spacing);
  dimension_ = snapshot.dimension;
  // Single precision is kept as it is; of double, what is left after the first particle's place has digits to spare.
  const bool doubles = std::holds_alternative<std::vector<double>>(snapshot.columns.front().values);
  origin_ = doubles && size_ > 0 ? snapshot.position(0) : Vec3d{};
  fill(positions_.id(), 3 * size_ * sizeof(float),
       [&](void* to) { write_positions(snapshot, origin_, static_cast<float*>(to)); });
}

void ParticleCloud::color(const Snapshot& snapshot, const View& view) {
  by_column_ = !view.color_by.empty();
  const SnapshotColumn* column = by_column_ ? &find_column(snapshot, view.color_by) : snapshot.find("body");
  has_values_ = column != nullptr;
  if (column != nullptr) {
    fill(values_.id(), size_ * sizeof(float), [&](void* to) { write_values(*column, static_cast<float*>(to)); });
  }
  if (by_column_) {
    range_ = view.color_range ? *view.color_range : sampled_color_range(*column, size_);
    set_color_map(find_color_map(view.color_map));
  }
  parts_.clear();
  for (const SnapshotMaterial& material : snapshot.materials) {
    const Look& look = find_look(material);
    const auto color = view.material_colors.find(material.name);
    parts_.push_back({material.begin, material.end, color != view.material_colors.end() ? color->second : look.color,
                      by_column_ ? 0.25F : look.wrap, look.jitter});
  }
  set_palette(snapshot, view);
}

void ParticleCloud::set_color_map(const ColorMap& map) {
  upload_row(map_.id(), static_cast<int>(map.srgb.size()), GL_RGB, GL_UNSIGNED_BYTE, map.srgb.data(), GL_RGB8);
}

void ParticleCloud::set_palette(const Snapshot& snapshot, const View& view) {
  std::vector<float> rgba(4 * std::max<std::size_t>(snapshot.bodies.size(), 1), 0.0F);
  for (std::size_t b = 0; b < snapshot.bodies.size(); ++b) {
    const auto color = view.body_colors.find(snapshot.bodies[b]);
    if (color == view.body_colors.end()) continue;
    for (int c = 0; c < 3; ++c) rgba[4 * b + static_cast<std::size_t>(c)] = color->second[c];
    rgba[4 * b + 3] = 1;
  }
  upload_row(palette_.id(), static_cast<int>(rgba.size() / 4), GL_RGBA, GL_FLOAT, rgba.data(), GL_RGBA32F);
}

/// Thinning costs nothing here: it is the distance from one particle to the next in the buffers.
void ParticleCloud::bind_attributes(std::size_t begin, std::size_t every) const {
  const auto pointer = [&](GLuint index, GLuint buffer, int components) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    const std::size_t bytes = sizeof(float) * begin * static_cast<std::size_t>(components);
    glVertexAttribPointer(index, components, GL_FLOAT, GL_FALSE,
                          static_cast<GLsizei>(sizeof(float) * every) * components,
                          reinterpret_cast<const void*>(bytes));
    glEnableVertexAttribArray(index);
  };
  pointer(kPosition, positions_.id(), 3);
  if (has_values_) {
    pointer(kValue, values_.id(), 1);
  } else {
    glDisableVertexAttribArray(kValue);
    glVertexAttrib1f(kValue, 0);
  }
}

void ParticleCloud::draw(const View& view, const CloudCamera& camera) const {
  if (size_ == 0) return;
  const std::size_t every = camera.thinning.every;
  program_.use();
  program_.set("view", camera.view);
  program_.set("projection", camera.projection);
  program_.set("radius", static_cast<float>(view.radius_per_spacing * camera.thinning.radius) * spacing_);
  program_.set("height", static_cast<float>(camera.height));
  program_.set("has_body", has_values_ && !by_column_ ? 1 : 0);
  program_.set("by_column", by_column_ ? 1 : 0);
  program_.set("range", static_cast<float>(range_[0]), static_cast<float>(range_[1]));
  program_.set("map", kMapUnit);
  program_.set("palette", kPaletteUnit);
  program_.set("every", static_cast<int>(every));
  set_clip(program_, camera.clip_normal, camera.clip_offset, origin_);
  set_daylight(program_, view, camera.view, camera.shadows);
  glActiveTexture(GL_TEXTURE0 + kPaletteUnit);
  glBindTexture(GL_TEXTURE_2D, palette_.id());
  glActiveTexture(GL_TEXTURE0 + kMapUnit);
  glBindTexture(GL_TEXTURE_2D, map_.id());
  glBindVertexArray(array_.id());
  glEnable(GL_PROGRAM_POINT_SIZE);
  glEnable(GL_CLIP_DISTANCE0);
  for (const Part& part : parts_) {
    if (part.begin == part.end) continue;
    program_.set("look", part.color);
    program_.set("wrap", part.wrap);
    program_.set("jitter", part.jitter);
    program_.set("first", static_cast<int>(part.begin));
    bind_attributes(part.begin, every);
    glDrawArrays(GL_POINTS, 0, static_cast<GLsizei>((part.end - part.begin + every - 1) / every));
  }
  glDisable(GL_CLIP_DISTANCE0);
  glBindVertexArray(0);
}

}  // namespace firn
