#include <firn/apps/viewer/scene_painter.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace firn {
namespace {

/// Within how many particle spacings things darken each other.
constexpr double kCornerReach = 6;

/// A ball around the particles, with room for what they fall onto.
std::pair<Vec3d, double> lit_ball(const Snapshot& snapshot) {
  constexpr std::size_t kSamples = 4096;
  Vec3d low = {}, high = {};
  const std::size_t every = snapshot.size() / kSamples + 1;
  for (std::size_t p = 0; p < snapshot.size(); p += every) {
    const Vec3d x = snapshot.position(p);
    for (int i = 0; i < 3; ++i) {
      low[i] = p == 0 ? x[i] : std::min(low[i], x[i]);
      high[i] = p == 0 ? x[i] : std::max(high[i], x[i]);
    }
  }
  return {0.5 * (low + high), std::max(1.1 * norm(high - low), 4 * snapshot.particle_spacing)};
}

}  // namespace

ScenePainter::ScenePainter(bool software, std::size_t moving_budget)
    : software_(software), moving_budget_(moving_budget), cloud_(software) {}

void ScenePainter::upload_grid(const ViewControls& controls) {
  auto grid = controls.source().grid();
  if (grid == grid_ && controls.color_map == grid_map_) return;
  grid_ = std::move(grid);
  grid_map_ = controls.color_map;
  const Vec3d origin = cloud_.origin();
  lines_.upload(grid_ ? grid_lines(*grid_, find_color_map(grid_map_), origin) : std::vector<LinePoint>(), origin);
}

void ScenePainter::update(const ViewControls& controls, const std::shared_ptr<const MeshedSurface>& surface,
                          bool recolor) {
  if (controls.snapshot() == nullptr) return;
  surface_.upload(surface);
  // While a surface is shown, particles that nobody sees are not copied.
  if (surface_.empty()) {
    const bool fresh = cloud_of_ != controls.status().published;
    cloud_of_ = controls.status().published;
    if (fresh) cloud_.upload(*controls.snapshot());
    if (fresh || recolor) cloud_.color(*controls.snapshot(), controls.view());
  } else if (recolor) {
    cloud_of_ = 0;
  }
  if (controls.shown() != ViewControls::Shown::material) upload_grid(controls);
}

void ScenePainter::draw(ViewControls& controls, int width, int height, bool moving, bool soft_light,
                        PanelNotes& notes) {
  const Snapshot* snapshot = controls.snapshot();
  glViewport(0, 0, width, height);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  if (width == 0 || height == 0 || snapshot == nullptr) return;
  const View view = controls.view();
  const OrbitCamera& camera = controls.camera();
  const double aspect = static_cast<double>(width) / height;
  const Thinning thinning = thin(cloud_.size(), software_ && moving ? moving_budget_ : 0, snapshot->dimension);
  notes.thinned = surface_.empty() && thinning.every > 1;
  notes.drawn = cloud_.size() / thinning.every;
  notes.range = surface_.empty() ? cloud_.range() : surface_.range(view);
  notes.aspect = aspect;

  CloudCamera seen = {camera.view_matrix(cloud_.origin()), camera.projection_matrix(aspect), height, thinning};
  std::tie(seen.clip_normal, seen.clip_offset) = controls.clip_plane();
  const Vec3d origin = cloud_.origin();
  const auto draw_material = [&](const CloudCamera& from) {
    surface_.empty() ? cloud_.draw(view, from) : surface_.draw(view, from, origin);
  };
  const bool soft = soft_light && !camera.flat();
  if (soft) {
    if (shadow_map_ == nullptr) shadow_map_ = std::make_unique<ShadowMap>();
    if (occlusion_ == nullptr) occlusion_ = std::make_unique<AmbientOcclusion>();
    const auto [center, radius] = lit_ball(*snapshot);
    seen.shadows = shadow_map_->draw(draw_material, origin, solids_, view, seen, center, radius);
    occlusion_->begin(width, height);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  }
  solids_.draw_sky(view, camera, aspect);
  glEnable(GL_DEPTH_TEST);
  if (controls.shown() != ViewControls::Shown::grid) draw_material(seen);
  if (controls.shown() != ViewControls::Shown::material) {
    CloudCamera lines = seen;
    lines.view = camera.view_matrix(lines_.origin());
    // Of 2D the lines lie in the particles' plane, which must not hide them.
    if (camera.flat()) glDisable(GL_DEPTH_TEST);
    lines_.draw(lines);
  }
  solids_.draw(view, camera, aspect, cloud_.origin(), seen.shadows);
  if (soft) occlusion_->end(seen.projection, kCornerReach * snapshot->particle_spacing);
}

}  // namespace firn
