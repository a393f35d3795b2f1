#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/render/particle_color.h>
#include <fmt/format.h>

namespace firn {

namespace {

constexpr std::size_t kGrain = 4096;

const SnapshotColumn* color_column(const Snapshot& snapshot, const View& view) {
  if (view.color_by.empty()) return nullptr;
  if (const SnapshotColumn* column = snapshot.find(view.color_by)) return column;
  std::string known;
  for (const SnapshotColumn& column : snapshot.columns) known += (known.empty() ? "" : ", ") + column.name;
  throw Error(ErrorKind::usage,
              fmt::format("color_by: there is no column \"{}\"; the columns are {}", view.color_by, known));
}

/// The colour of each body, where the view gives it one.
std::vector<std::optional<Vec3f>> body_colors(const Snapshot& snapshot, const View& view) {
  std::vector<std::optional<Vec3f>> colors;
  for (const std::string& body : snapshot.bodies) {
    const auto found = view.body_colors.find(body);
    colors.push_back(found != view.body_colors.end() ? std::optional(found->second) : std::nullopt);
  }
  return colors;
}

void color_by_column(std::size_t count, ParticleLooks* looks) {
  const double scale = 1 / (looks->range[1] - looks->range[0]);
  parallel_chunks(count, kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3f srgb = color_at(*looks->map, (color_value(*looks->column, p) - looks->range[0]) * scale);
      for (int c = 0; c < 3; ++c) looks->color[p][c] = linear_from_srgb(srgb[c]);
    }
  });
}

void color_by_look(const Snapshot& snapshot, const View& view, ParticleLooks* looks) {
  const SnapshotColumn* ids = snapshot.find("id");
  const SnapshotColumn* bodies = snapshot.find("body");
  const auto colors = body_colors(snapshot, view);
  parallel_chunks(snapshot.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Look& look = looks->looks[looks->look_of[p]];
      const auto id = ids != nullptr ? static_cast<std::uint64_t>(value(*ids, p)) : p;
      const auto body = bodies != nullptr ? static_cast<std::size_t>(value(*bodies, p)) : colors.size();
      const Vec3f base = body < colors.size() && colors[body] ? *colors[body] : look.color;
      looks->color[p] = (1 + look.jitter * (2 * mixed_unit(id, 1) - 1)) * base;
    }
  });
}

}  // namespace

ParticleLooks particle_looks(const Snapshot& snapshot, const View& view) {
  ParticleLooks result;
  result.color.resize(snapshot.size());
  result.look_of.resize(snapshot.size());
  for (std::size_t m = 0; m < snapshot.materials.size(); ++m) {
    const SnapshotMaterial& material = snapshot.materials[m];
    Look look = find_look(material);
    const auto color = view.material_colors.find(material.name);
    if (color != view.material_colors.end()) look.color = color->second;
    result.looks.push_back(look);
    for (std::size_t p = material.begin; p < material.end; ++p) result.look_of[p] = static_cast<std::uint16_t>(m);
  }
  result.column = color_column(snapshot, view);
  if (result.column != nullptr) {
    result.map = &find_color_map(view.color_map);
    result.range = view.color_range ? *view.color_range : automatic_color_range(*result.column, snapshot.size());
    if (!(result.range[1] > result.range[0])) {
      throw Error(ErrorKind::usage,
                  fmt::format("color_range: the second number must be larger than the first, got {} and {}",
                              result.range[0], result.range[1]));
    }
    // A colour must mean one value: nothing of the look may tint it.
    for (Look& look : result.looks) look = {.name = "", .color = {}, .wrap = 0.25F, .smooth = look.smooth};
    color_by_column(snapshot.size(), &result);
  } else {
    color_by_look(snapshot, view, &result);
  }
  return result;
}

std::uint32_t mixed_bits(std::uint64_t a, std::uint32_t b) {
  std::uint64_t x = a * 0x9E3779B97F4A7C15ULL + b * 0xD1B54A32D192ED03ULL;
  x = (x ^ (x >> 33)) * 0xFF51AFD7ED558CCDULL;
  x = (x ^ (x >> 33)) * 0xC4CEB9FE1A85EC53ULL;
  return static_cast<std::uint32_t>((x ^ (x >> 33)) >> 32);
}

float mixed_unit(std::uint64_t a, std::uint32_t b) { return static_cast<float>(mixed_bits(a, b) >> 8) * 0x1p-24F; }

}  // namespace firn
