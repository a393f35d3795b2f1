#pragma once

#include <firn/apps/viewer/gallery.h>
#include <firn/apps/viewer/gl_object.h>
#include <firn/apps/viewer/panel_state.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace firn {

/// A page of scenes with their pictures. Needs a current context.
class StartPage {
 public:
  explicit StartPage(std::vector<GalleryEntry> entries);
  ~StartPage();

  /// Inside a frame of Dear ImGui, over the whole window. The scene that was double-clicked, if one was. `message`
  /// stands below the heading. @param double_clicked whether the last click was the second one of two: only events
  /// know, a picture may take longer than both clicks
  std::optional<std::filesystem::path> draw(const std::string& message, bool double_clicked, UiItems& items);
  /// Whether pictures are still to be read: a few are in each draw.
  bool loading() const { return next_ < entries_.size(); }
  const std::vector<GalleryEntry>& entries() const { return entries_; }

 private:
  struct Thumbnail {
    GlTexture texture;
    int width = 0, height = 0;
  };
  void read_some();
  bool draw_entry(std::size_t i, bool double_clicked, UiItems& items);

  std::vector<GalleryEntry> entries_;
  std::vector<std::unique_ptr<Thumbnail>> thumbnails_;
  std::size_t next_ = 0;
  std::optional<std::size_t> chosen_;
};

}  // namespace firn
