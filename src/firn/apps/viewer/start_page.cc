#include <firn/apps/viewer/start_page.h>
#include <imgui.h>

#include <algorithm>
#include <cstdint>

namespace firn {
namespace {

constexpr int kThumbnailWidth = 188;
constexpr float kThumbnailHeight = 106, kRowHeight = 142;
constexpr std::size_t kReadPerDraw = 3;

ImTextureID texture_of(GLuint id) { return reinterpret_cast<ImTextureID>(static_cast<std::uintptr_t>(id)); }

void note_item(UiItems& items, const std::string& label) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  items[label] = {low.x, low.y, high.x, high.y};
}

}  // namespace

StartPage::StartPage(std::vector<GalleryEntry> entries) : entries_(std::move(entries)), thumbnails_(entries_.size()) {}

StartPage::~StartPage() = default;

void StartPage::read_some() {
  for (std::size_t n = 0; n < kReadPerDraw && loading(); ++n, ++next_) {
    const auto image = read_thumbnail(entries_[next_].picture, kThumbnailWidth);
    if (!image) continue;
    auto thumbnail = std::make_unique<Thumbnail>();
    thumbnail->width = image->width;
    thumbnail->height = image->height;
    glBindTexture(GL_TEXTURE_2D, thumbnail->texture.id());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, image->width, image->height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 image->rgb.data());
    thumbnails_[next_] = std::move(thumbnail);
  }
}

/// True if it was double-clicked.
bool StartPage::draw_entry(std::size_t i, bool double_clicked, UiItems& items) {
  const GalleryEntry& entry = entries_[i];
  ImGui::PushID(static_cast<int>(i));
  ImGui::BeginGroup();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool chosen = chosen_ == i;
  bool open = false;
  if (ImGui::Selectable("##entry", chosen, ImGuiSelectableFlags_AllowDoubleClick, {kThumbnailWidth, kRowHeight - 12})) {
    chosen_ = i;
    open = double_clicked;
  }
  note_item(items, entry.scene.stem().string());
  if (ImGui::IsItemHovered() && !entry.text.empty()) {
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(360);
    ImGui::TextUnformatted(entry.text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
  }
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (const auto& thumbnail = thumbnails_[i]) {
    // Cut to the shape of the frame, in the middle.
    const float wanted = kThumbnailWidth / kThumbnailHeight;
    const float present = static_cast<float>(thumbnail->width) / static_cast<float>(thumbnail->height);
    const float u = present > wanted ? 0.5F * (1 - wanted / present) : 0,
                v = present < wanted ? 0.5F * (1 - present / wanted) : 0;
    list->AddImage(texture_of(thumbnail->texture.id()), at, {at.x + kThumbnailWidth, at.y + kThumbnailHeight}, {u, v},
                   {1 - u, 1 - v});
  } else {
    list->AddRectFilled(at, {at.x + kThumbnailWidth, at.y + kThumbnailHeight}, IM_COL32(52, 60, 74, 255));
  }
  list->AddText({at.x + 4, at.y + kThumbnailHeight + 4}, IM_COL32(230, 233, 238, 255), entry.title.c_str());
  ImGui::EndGroup();
  ImGui::PopID();
  return open;
}

std::optional<std::filesystem::path> StartPage::draw(const std::string& message, bool double_clicked, UiItems& items) {
  read_some();
  items.clear();
  std::optional<std::filesystem::path> opened;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0, 0});
  ImGui::SetNextWindowSize(size);
  ImGui::Begin("Start", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::SetWindowFontScale(1.5F);
  ImGui::TextUnformatted("Firn: choose a scene");
  ImGui::SetWindowFontScale(1);
  ImGui::TextDisabled(
      "Double click opens a scene; the mouse over it tells what there is to see. In the window, ? lists the keys.");
  if (!message.empty()) ImGui::TextColored({1, 0.6F, 0.4F, 1}, "%s", message.c_str());
  if (entries_.empty()) ImGui::TextWrapped("There are no scenes beside the program: firn view SCENE.toml opens one.");
  ImGui::BeginChild("scenes");
  const int columns = std::max(1, static_cast<int>((size.x - 30) / (kThumbnailWidth + 10)));
  std::string group;
  int column = 0;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].group != group) {
      group = entries_[i].group;
      column = 0;
      ImGui::Spacing();
      ImGui::TextUnformatted(group == "gallery" ? "Substances" : group == "obstacles" ? "Obstacles" : "Classroom");
      ImGui::Separator();
    }
    if (column > 0) ImGui::SameLine(static_cast<float>(column) * (kThumbnailWidth + 10) + 8);
    if (draw_entry(i, double_clicked, items)) opened = entries_[i].scene;
    column = (column + 1) % columns;
  }
  ImGui::EndChild();
  ImGui::End();
  return opened;
}

}  // namespace firn
