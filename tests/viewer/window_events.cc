#include "viewer/window_events.h"

#include <X11/XKBlib.h>
#include <X11/Xlib.h>
#include <X11/Xutil.h>

namespace firn::test {
namespace {

/// The window of this title, or with any, at or below another one; 0 for none.
::Window find_window(Display* display, ::Window at, const std::string& title) {
  char* name = nullptr;
  const bool found = XFetchName(display, at, &name) != 0 && (title.empty() || name == title);
  if (name != nullptr) XFree(name);
  if (found) return at;
  ::Window root = 0, parent = 0, *children = nullptr, result = 0;
  unsigned count = 0;
  if (XQueryTree(display, at, &root, &parent, &children, &count) == 0) return 0;
  for (unsigned i = 0; i < count && result == 0; ++i) result = find_window(display, children[i], title);
  if (children != nullptr) XFree(children);
  return result;
}

/// Key, button and motion events have the same members.
template <class Event>
Event event_for(Display* display, ::Window window, int type, int x, int y) {
  Event event = {};
  event.type = type;
  event.display = display;
  event.window = window;
  event.root = DefaultRootWindow(display);
  event.time = CurrentTime;
  event.x = event.x_root = x;
  event.y = event.y_root = y;
  event.same_screen = True;
  return event;
}

void send(Display* display, ::Window window, long mask, XEvent event) {
  XSendEvent(display, window, True, mask, &event);
  // The server writes to all of its clients before it reads on: with the answer to a second question, the event has
  // been written, too.
  XSync(display, False);
  XSync(display, False);
}

unsigned state_of(int modifiers) {
  constexpr int kShift = 1, kControl = 2;  // GLFW's
  return ((modifiers & kShift) != 0 ? ShiftMask : 0U) | ((modifiers & kControl) != 0 ? ControlMask : 0U);
}

}  // namespace

WindowEvents::WindowEvents(const std::string& title) {
  Display* display = XOpenDisplay(nullptr);
  display_ = display;
  if (display != nullptr) window_ = find_window(display, DefaultRootWindow(display), title);
}

WindowEvents::~WindowEvents() {
  if (display_ != nullptr) XCloseDisplay(static_cast<Display*>(display_));
}

void WindowEvents::key(const std::string& name, bool down, int modifiers) const {
  auto* display = static_cast<Display*>(display_);
  // Characters of Latin 1 are their own symbols.
  const auto symbol = name.size() == 1 ? static_cast<KeySym>(name[0]) : XStringToKeysym(name.c_str());
  const KeyCode code = XKeysymToKeycode(display, symbol);
  const bool shifted = XkbKeycodeToKeysym(display, code, 0, 0) != symbol;
  XEvent event = {};
  event.xkey = event_for<XKeyEvent>(display, window_, down ? KeyPress : KeyRelease, 1, 1);
  event.xkey.keycode = code;
  event.xkey.state = state_of(modifiers) | (shifted ? ShiftMask : 0U);
  send(display, window_, down ? KeyPressMask : KeyReleaseMask, event);
}

void WindowEvents::move(int x, int y) const {
  auto* display = static_cast<Display*>(display_);
  XEvent event = {};
  event.xmotion = event_for<XMotionEvent>(display, window_, MotionNotify, x, y);
  send(display, window_, PointerMotionMask, event);
}

void WindowEvents::button(unsigned button, bool down, int x, int y, int modifiers) const {
  auto* display = static_cast<Display*>(display_);
  XEvent event = {};
  event.xbutton = event_for<XButtonEvent>(display, window_, down ? ButtonPress : ButtonRelease, x, y);
  event.xbutton.button = button;
  event.xbutton.state = state_of(modifiers);
  send(display, window_, down ? ButtonPressMask : ButtonReleaseMask, event);
}

}  // namespace firn::test
