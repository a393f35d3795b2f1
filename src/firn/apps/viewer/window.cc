#include <firn/apps/viewer/window_state.h>
// After epoxy and GLFW.
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <firn/apps/viewer/panel.h>
#include <firn/core/error.h>
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <utility>

namespace firn {
namespace {

/// How long the window sleeps if nothing happens, s.
constexpr double kSleep = 0.05;
/// Wider windows begin with the side panel.
constexpr int kWideWindow = 1000;

/// Of this thread, s: what others do on the same processor does not count.
double processor_seconds() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

ViewerWindow& of(GLFWwindow* window) { return *static_cast<ViewerWindow*>(glfwGetWindowUserPointer(window)); }

void install_callbacks(GLFWwindow* window) {
  glfwSetKeyCallback(
      window, [](GLFWwindow* w, int key, int code, int action, int mods) { of(w).on_key(key, code, action, mods); });
  glfwSetCharCallback(window, [](GLFWwindow* w, unsigned code) { of(w).on_character(code); });
  glfwSetMouseButtonCallback(
      window, [](GLFWwindow* w, int button, int action, int mods) { of(w).on_button(button, action, mods); });
  glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) { of(w).on_cursor(x, y); });
  glfwSetScrollCallback(window, [](GLFWwindow* w, double dx, double dy) { of(w).on_scroll(dx, dy); });
}

void fill(std::array<char, 512>& text, const std::string& value) {
  text = {};
  std::copy_n(value.begin(), std::min(value.size(), text.size() - 1), text.begin());
}

}  // namespace

ViewerWindow::State::State(const Options& wanted)
    : options(wanted),
      display(wanted.width, wanted.height, wanted.title),
      interface(display.window()),
      software(display.software()),
      start_page(wanted.gallery) {
  panel.side = wanted.width >= kWideWindow;
  panel.soft_light = !software;
  notes.has_start_page = static_cast<bool>(wanted.open);
}

ViewerWindow::ViewerWindow(const Options& options) : state_(std::make_unique<State>(options)) {
  glfwSetWindowUserPointer(state_->display.window(), this);
  install_callbacks(state_->display.window());
}

ViewerWindow::ViewerWindow(const Scene& scene, FrameSource& source, const Options& options) : ViewerWindow(options) {
  state_->look_at(scene, source);
}

ViewerWindow::~ViewerWindow() = default;

void ViewerWindow::require_display() { WindowDisplay::require(); }

bool ViewerWindow::has_scene() const { return state_->controls != nullptr; }
ViewControls& ViewerWindow::controls() { return *state_->controls; }
PanelState& ViewerWindow::panel() { return state_->panel; }
const PanelNotes& ViewerWindow::notes() const { return state_->notes; }
const ViewerWindow::Times& ViewerWindow::times() const { return state_->times; }
bool ViewerWindow::software() const { return state_->software; }
unsigned ViewerWindow::error() const { return glGetError(); }

void ViewerWindow::State::look_at(const Scene& scene, FrameSource& source) {
  controls = std::make_unique<ViewControls>(scene, source);
  painter = std::make_unique<ScenePainter>(software, options.moving_budget);
  const std::string name = scene.file.stem().empty() ? "scene" : scene.file.stem().string();
  recorder = std::make_unique<Recorder>(options.record_stem.empty() ? name + "_view" : options.record_stem);
  film_rate = scene.render.film_rate_of(scene.frame_rate);
  fill(panel.save_path, name + "_changed.toml");
  panel.knobs_of.clear();
  panel.numbers.clear();
  panel.run_to = 0;
  notes.message.clear();
  wanted_draws = kDrawsPerEvent;
}

void ViewerWindow::State::leave() {
  guarded([&] {
    if (recorder) recorder->stop();
  });
  if (controls) controls->source().pace(false);
  surface.clear();
  film_waits = false;
  controls.reset();
  painter.reset();
  recorder.reset();
  shown.reset();
  wanted_draws = kDrawsPerEvent;
}

void ViewerWindow::show(Show show) {
  State& s = *state_;
  s.leave();
  s.shown = std::move(show);
  glfwSetWindowTitle(s.display.window(), s.shown->title.c_str());
  s.look_at(s.shown->scene, *s.shown->source);
  if (!s.options.paused) s.shown->source->play();
}

void ViewerWindow::State::open(const std::filesystem::path& path) {
  try {
    double_clicked = false;
    Show next = options.open(path);
    start_message.clear();
    of(display.window()).show(std::move(next));
  } catch (const std::exception& error) {
    start_message = error.what();
  }
}

/// Where the mouse is.
PicturePlace ViewerWindow::State::place() const {
  int width = 0, height = 0;
  glfwGetWindowSize(display.window(), &width, &height);
  const double w = std::max(width, 1), h = std::max(height, 1);
  return {2 * (cursor[0] + 0.5) / w - 1, 1 - 2 * (cursor[1] + 0.5) / h, w / h};
}

void ViewerWindow::State::draw_scene() {
  int width = 0, height = 0;
  glfwGetFramebufferSize(display.window(), &width, &height);
  if (on_start_page()) {
    glViewport(0, 0, width, height);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    return;
  }
  painter->draw(*controls, width, height, controls->moving(glfwGetTime()), panel.soft_light, notes);
}

void ViewerWindow::State::draw_interface() {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  // The backend asks the system where the mouse is; here the events tell, also those of tests.
  ImGuiIO& io = ImGui::GetIO();
  io.MousePos = {static_cast<float>(cursor[0]), static_cast<float>(cursor[1])};
  for (std::size_t b = 0; b < kButtons; ++b) io.MouseDown[b] = down[b];
  ImGui::NewFrame();
  std::optional<std::filesystem::path> opened;
  if (on_start_page()) {
    opened = start_page.draw(start_message, double_clicked, panel.items);
  } else if (draw_panels(*controls, notes, panel)) {
    recolor = true;
  }
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (opened) open(*opened);
}

/// What goes wrong becomes a message in the window.
void ViewerWindow::State::guarded(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    notes.message = error.what();
  }
  wanted_draws = kDrawsPerEvent;
}

/// Does what the panels have asked for.
void ViewerWindow::State::serve() {
  if (on_start_page()) return;
  if (std::exchange(panel.wants_picture, false)) {
    guarded([&] {
      of(display.window()).capture();
      notes.message = fmt::format("wrote {}", recorder->picture(picture).string());
    });
  }
  if (std::exchange(panel.wants_film, false)) {
    guarded([&] {
      if (recorder->recording()) {
        const auto path = recorder->stop();
        notes.message = path ? fmt::format("wrote {}, {} pictures", path->string(), recorder->pictures())
                             : "the film had no picture: they come with the frames, so play while it records";
      } else {
        int width = 0, height = 0;
        glfwGetFramebufferSize(display.window(), &width, &height);
        recorder->start(width, height, film_rate);
        notes.message =
            fmt::format("recording {}: a picture for every new frame, until v", recorder->film_path().string());
      }
    });
  }
  if (auto path = std::exchange(panel.wants_save, std::nullopt)) {
    guarded([&] {
      save_scene(*path, controls->scene(), controls->look(), controls->source().changes());
      notes.message = fmt::format("wrote {}", *path);
    });
  }
  notes.recording = recorder->recording();
  notes.pictures = recorder->pictures();
  if (std::exchange(panel.wants_start_page, false) && notes.has_start_page) leave();
}

/// A new frame becomes a picture of the film, panels included if they are seen; that of a surface when its surface is
/// in it.
void ViewerWindow::State::record(bool fresh) {
  if (on_start_page()) return;
  film_waits = recorder->recording() && (film_waits || fresh);
  if (film_waits && surface.settled()) {
    film_waits = false;
    guarded([&] {
      picture = display.read_picture();
      recorder->add(picture);
      if (!recorder->recording()) {
        notes.message =
            fmt::format("the window changed its size, which ends the film: {}", recorder->film_path().string());
      }
    });
  }
  notes.recording = recorder->recording();
  notes.pictures = recorder->pictures();
  FrameSource& source = controls->source();
  source.pace(notes.recording && surface.notes().wanted);
  if (!film_waits) source.taken(controls->status().published);
}

/// Takes what is new of the scene; true if there is a new frame.
bool ViewerWindow::State::update_scene(double seconds) {
  controls->source().advance(film_waits ? 0 : seconds);
  const bool fresh = controls->update();
  const auto meshed = surface.update(*controls);
  notes.surface = surface.notes();
  painter->update(*controls, meshed, std::exchange(recolor, false));
  return fresh;
}

void ViewerWindow::draw() {
  State& s = *state_;
  glfwPollEvents();
  s.take_inputs();
  s.serve();
  const double now = glfwGetTime(), start = processor_seconds();
  const bool fresh = !s.on_start_page() && s.update_scene(s.last_draw ? now - *s.last_draw : 0);
  s.last_draw = now;
  const double uploaded = processor_seconds();
  if (fresh) s.times.upload = uploaded - start;
  s.draw_scene();
  s.draw_interface();
  s.times.draw = processor_seconds() - uploaded;
  s.record(fresh);
  s.notes.frame_milliseconds = 1e3 * (s.times.draw + (fresh ? s.times.upload : 0));
  s.wanted_draws = std::max(s.wanted_draws - 1, 0);
  ++s.pictures_drawn;
  glfwSwapBuffers(s.display.window());
}

void ViewerWindow::run() {
  State& s = *state_;
  SourceStatus shown;
  std::uint64_t surface_shown = 0;
  bool was_moving = false;
  while (glfwWindowShouldClose(s.display.window()) == GLFW_FALSE) {
    glfwPollEvents();
    bool wanted = s.wanted_draws > 0 || s.recolor || s.dragging || was_moving;
    if (s.on_start_page()) {
      wanted = wanted || s.start_page.loading();
    } else {
      FrameSource& source = s.controls->source();
      const SourceStatus now = source.status();
      const bool changed = now.published != shown.published || now.state != shown.state || now.busy != shown.busy ||
                           now.frame_count != shown.frame_count || now.message != shown.message ||
                           now.note != shown.note || now.waits_for_reset != shown.waits_for_reset;
      was_moving = s.controls->moving(glfwGetTime());
      // Software OpenGL would take the simulation's processors for pictures that do not differ.
      const bool playback = source.follows_clock() && now.state == PlayState::playing;
      const std::uint64_t surface_now = s.surface.version();
      wanted = wanted || changed || was_moving || playback || surface_now != surface_shown;
      shown = now;
      surface_shown = surface_now;
    }
    if (wanted) {
      draw();
    } else {
      glfwWaitEventsTimeout(kSleep);
    }
  }
  s.guarded([&] {
    if (s.recorder) s.recorder->stop();
  });
}

const Image& ViewerWindow::capture() {
  // What is in the back buffer after a swap is undefined: the picture is drawn once more, and not shown.
  state_->draw_scene();
  if (ImGui::GetDrawData() != nullptr) ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  state_->picture = state_->display.read_picture();
  return state_->picture;
}

}  // namespace firn
