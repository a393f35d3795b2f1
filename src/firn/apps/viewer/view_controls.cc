#include <firn/apps/scene_view.h>
#include <firn/apps/viewer/view_controls.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>
#include <utility>

namespace firn {
namespace {

constexpr double kMovingSeconds = 0.25;
constexpr double kZoomPerNotch = 0.88;
/// What the mouse holds at first, cells.
constexpr double kHandCells = 4;
/// Particles that the bounds of a clip plane are taken from.
constexpr std::size_t kBoundsSamples = 4096;

/// Lowest and highest corner of some of the particles.
std::array<Vec3d, 2> sampled_bounds(const Snapshot& snapshot) {
  std::array<Vec3d, 2> bounds = {};
  const std::size_t every = snapshot.size() / kBoundsSamples + 1;
  for (std::size_t p = 0; p < snapshot.size(); p += every) {
    const Vec3d x = snapshot.position(p);
    for (int i = 0; i < 3; ++i) {
      bounds[0][i] = p == 0 ? x[i] : std::min(bounds[0][i], x[i]);
      bounds[1][i] = p == 0 ? x[i] : std::max(bounds[1][i], x[i]);
    }
  }
  return bounds;
}

}  // namespace

ViewControls::ViewControls(const Scene& scene, FrameSource& source)
    : running_(std::make_shared<const Scene>(scene)),
      wanted_(running_),
      drawing_(std::make_unique<SceneDrawing>(*running_)),
      source_(source) {
  const View view = drawing_->view_at(0);
  color_by = view.color_by;
  color_map = view.color_map;
  range = view.color_range;
  status_ = source.status();
  take_scene();
}

void ViewControls::take_scene() {
  if (auto wanted = source_.scene()) wanted_ = std::move(wanted);
  auto running = source_.running_scene();
  if (!running || running == running_) return;
  auto drawing = std::make_unique<SceneDrawing>(*running);
  drawing_ = std::move(drawing);
  running_ = std::move(running);
}

bool ViewControls::key(char key) {
  switch (key) {
    case ' ':
      if (source_.status().state == PlayState::playing) {
        source_.pause();
      } else {
        source_.play();
      }
      return true;
    case '.':
      source_.step();
      return true;
    case 'r':
      source_.reset();
      return true;
    case 'f':
      if (snapshot_ != nullptr) camera_.frame_all(*snapshot_, view());
      moved_ = true;
      return true;
    case 'p':
      set_orthographic(!camera_.orthographic());
      return true;
    case '1':
    case '2':
    case '3':
      camera_.look_from(key - '1');
      moved_ = true;
      return true;
    case 'g':
      set_shown(static_cast<Shown>((static_cast<int>(shown_) + 1) % 3));
      return true;
    case 'u':
      set_as_surface(!as_surface_);
      return true;
    case 'c':
      clip.on = !clip.on;
      return true;
    default:
      return false;
  }
}

void ViewControls::set_orthographic(bool orthographic) {
  camera_.set_orthographic(orthographic);
  moved_ = true;
}

void ViewControls::set_shown(Shown shown) {
  shown_ = shown;
  source_.want_grid(shown != Shown::material);
}

void ViewControls::set_as_surface(bool as_surface) {
  if (!can_have_surface()) return;
  as_surface_ = as_surface;
  if (shown_ == Shown::grid) set_shown(Shown::material);
}

std::optional<SurfaceOrder> ViewControls::wanted_surface() const {
  if (!as_surface_ || shown_ == Shown::grid || snapshot_ == nullptr || snapshot_->dimension != 3) return std::nullopt;
  const View view = this->view();
  // A simulation that goes on needs the processors more than the picture of it does.
  const bool simulates = !source_.follows_clock() && (status_.busy || status_.state == PlayState::playing);
  const int processors = static_cast<int>(std::thread::hardware_concurrency());
  return SurfaceOrder{snapshot_,
                      status_.frame.frame,
                      surface_options,
                      view.color_by,
                      view.material_colors,
                      view.body_colors,
                      simulates ? 1 : std::max(processors / 2, 1)};
}

void ViewControls::drag(Drag kind, double right, double up) {
  if (kind == Drag::orbit && !camera_.flat()) {
    // Once across the picture is half a turn. The scene follows the mouse: it goes down if the camera rises.
    camera_.orbit(-right * std::numbers::pi, -up * std::numbers::pi);
  } else {
    camera_.pan(right, up);
  }
  moved_ = true;
}

void ViewControls::scroll(double notches) {
  camera_.zoom(std::pow(kZoomPerNotch, notches));
  moved_ = true;
}

bool ViewControls::update() {
  status_ = source_.status();
  take_scene();
  if (status_.published == seen_) return false;
  const bool first = seen_ == 0;
  seen_ = status_.published;
  snapshot_ = source_.snapshot();
  bounds_ = sampled_bounds(*snapshot_);
  if (hand_radius == 0) hand_radius = kHandCells * (snapshot_->cell_size > 0 ? snapshot_->cell_size : 0.05);
  if (first) {
    const View view = this->view();
    const bool orthographic = camera_.orthographic();
    camera_ =
        OrbitCamera(view.camera ? *view.camera : automatic_camera(*snapshot_, view), view.up, snapshot_->dimension);
    camera_.set_orthographic(orthographic);
  }
  return true;
}

bool ViewControls::moving(double now) {
  if (std::exchange(moved_, false)) moved_at_ = now;
  return now - moved_at_ < kMovingSeconds;
}

std::vector<std::string> ViewControls::choices() const {
  std::vector<std::string> names = {""};
  if (snapshot_ == nullptr) return names;
  for (std::size_t c = 1; c < snapshot_->columns.size(); ++c) names.push_back(snapshot_->columns[c].name);
  return names;
}

std::string ViewControls::choice_name(const std::string& column) {
  if (column.empty()) return "material";
  if (column == "velocity") return "speed";
  if (column == "material") return "number of the material";
  if (column == "body") return "number of the body";
  std::string name = column;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::pair<Vec3d, double> ViewControls::clip_plane() const {
  if (!clip.on) return {};
  Vec3d normal = {};
  normal[clip.axis] = clip.flipped ? -1 : 1;
  const double place = bounds_[0][clip.axis] + clip.place * (bounds_[1][clip.axis] - bounds_[0][clip.axis]);
  return {normal, normal[clip.axis] * place};
}

void ViewControls::pick_at(const PicturePlace& place) {
  if (snapshot_ == nullptr) return;
  picked_ = pick(*snapshot_, view(), camera_.ray(place.x, place.y, place.aspect), clip_plane());
}

std::optional<std::size_t> ViewControls::picked_particle() const {
  if (snapshot_ == nullptr || picked_.kind != Picked::Kind::particle) return std::nullopt;
  return find_particle(*snapshot_, picked_.id);
}

std::optional<Vec3d> ViewControls::failed_place() const {
  if (!status_.failed || snapshot_ == nullptr) return std::nullopt;
  const auto particle = find_particle(*snapshot_, status_.failed->id);
  return particle ? snapshot_->position(*particle) : status_.failed->position;
}

bool ViewControls::begin_grab(const PicturePlace& place) {
  if (snapshot_ == nullptr || !editable()) return false;
  const Picked at = pick(*snapshot_, view(), camera_.ray(place.x, place.y, place.aspect), clip_plane());
  if (at.kind != Picked::Kind::particle) return false;
  grab_ = Grab{at.point, at.point, hand_radius};
  source_.grab(grab_);
  return true;
}

void ViewControls::move_grab(const PicturePlace& place) {
  if (!grab_) return;
  // Across the line of sight, at the depth where it was taken.
  const Ray ray = camera_.ray(place.x, place.y, place.aspect);
  const Vec3d forward = normalized(camera_.camera().target - camera_.camera().position);
  grab_->to = ray.origin + (dot(grab_->from - ray.origin, forward) / dot(ray.direction, forward)) * ray.direction;
  source_.grab(grab_);
}

void ViewControls::end_grab() {
  grab_.reset();
  source_.grab(std::nullopt);
}

/// The middle of something of the hand's size that rests on what is seen there.
std::optional<Vec3d> ViewControls::hand_place(const PicturePlace& place, double above) const {
  if (snapshot_ == nullptr || !editable()) return std::nullopt;
  if (camera_.flat()) {
    Vec3d x = camera_.at_target(place.x, place.y, place.aspect);
    x[2] = 0;
    return x;
  }
  const Picked at = pick(*snapshot_, view(), camera_.ray(place.x, place.y, place.aspect), clip_plane());
  if (at.kind == Picked::Kind::nothing) return camera_.at_target(place.x, place.y, place.aspect);
  return at.point + above * view().up;
}

bool ViewControls::drop_at(const PicturePlace& place) {
  const auto x = hand_place(place, 1.5 * hand_radius);
  if (!x) return false;
  source_.drop({drop_preset, *x, hand_radius});
  return true;
}

bool ViewControls::place_collider_at(const PicturePlace& place) {
  const auto x = hand_place(place, hand_radius);
  if (!x) return false;
  using Shape = ShapeSettings::Shape;
  source_.edit([&](Scene& scene) {
    scene.colliders.push_back(placed_collider(scene, place_box ? Shape::box : Shape::sphere, *x, hand_radius));
  });
  return true;
}

View ViewControls::view() const {
  View view = drawing_->view_at(snapshot_ != nullptr ? snapshot_->time : 0);
  // A column that the frame lacks is no reason to show nothing.
  view.color_by = snapshot_ != nullptr && snapshot_->find(color_by) == nullptr ? "" : color_by;
  view.color_map = color_map;
  view.color_range = range;
  return view;
}

}  // namespace firn
