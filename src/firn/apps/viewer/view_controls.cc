#include <firn/apps/scene_view.h>
#include <firn/apps/viewer/view_controls.h>

#include <cmath>
#include <numbers>
#include <utility>

namespace firn {
namespace {

constexpr double kMovingSeconds = 0.25;
constexpr double kZoomPerNotch = 0.88;

}  // namespace

ViewControls::ViewControls(const Scene& scene, FrameSource& source) : scene_(scene), drawing_(scene_), source_(source) {
  const View view = drawing_.view_at(0);
  color_by = view.color_by;
  range = view.color_range;
  status_ = source.status();
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
    default:
      return false;
  }
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
  if (status_.published == seen_) return false;
  const bool first = seen_ == 0;
  seen_ = status_.published;
  snapshot_ = source_.snapshot();
  if (first) {
    const View view = this->view();
    camera_ =
        OrbitCamera(view.camera ? *view.camera : automatic_camera(*snapshot_, view), view.up, snapshot_->dimension);
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

View ViewControls::view() const {
  View view = drawing_.view_at(snapshot_ != nullptr ? snapshot_->time : 0);
  // A column that the frame lacks is no reason to show nothing.
  view.color_by = snapshot_ != nullptr && snapshot_->find(color_by) == nullptr ? "" : color_by;
  view.color_range = range;
  return view;
}

}  // namespace firn
