#include <firn/core/error.h>
#include <firn/io/mesh_parsers.h>
#include <firn/io/mesh_text.h>
#include <fmt/format.h>

#include <limits>

namespace firn {
namespace {

/// An index beyond the vertices read so far: legal if they follow.
struct ForwardReference {
  std::int64_t vertex;  ///< from 1
  std::size_t line, column;
  const char* user;
};

class ObjParser {
 public:
  ObjParser(std::string_view bytes, const std::string& name)
      : scanner_(bytes, name, TextScanner::Continuation::backslash) {}

  ObjFile parse() {
    while (scanner_.next_line()) {
      const std::string_view keyword = scanner_.word();
      if (keyword == "v") {
        read_vertex();
      } else if (keyword == "f") {
        read_face();
      } else if (keyword == "l") {
        read_line_element();
      }
    }
    check_forward_references();
    if (file_.vertices.empty())
      scanner_.fail_at(1, 1, "the file has no vertices (no line starts with 'v'); is it an OBJ file?");
    return std::move(file_);
  }

 private:
  void read_vertex() {
    if (file_.vertices.size() >= std::size_t(std::numeric_limits<std::int32_t>::max())) {
      scanner_.fail("more than 2147483647 vertices");
    }
    Vec3d x;
    const std::size_t number = file_.vertices.size() + 1;
    for (int i = 0; i < 3; ++i) x[i] = scanner_.number(fmt::format("{} of vertex {}", "xyz"[i], number));
    file_.vertices.push_back(x);
  }

  void read_face() {
    const std::size_t line = scanner_.line(), column = scanner_.column(), begin = file_.corners.size();
    for (std::string_view text = scanner_.word(); !text.empty(); text = scanner_.word()) {
      file_.corners.push_back(vertex_index(text, "face"));
    }
    const std::size_t count = file_.corners.size() - begin;
    if (count < 3) scanner_.fail_at(line, column, fmt::format("a face needs at least 3 corners, got {}", count));
    file_.face_ends.push_back(file_.corners.size());
  }

  void read_line_element() {
    const std::size_t line = scanner_.line(), column = scanner_.column();
    std::int32_t previous = -1;
    std::size_t count = 0;
    for (std::string_view text = scanner_.word(); !text.empty(); text = scanner_.word(), ++count) {
      const std::int32_t index = vertex_index(text, "line");
      if (count > 0) file_.segments.push_back({previous, index});
      previous = index;
    }
    if (count < 2) scanner_.fail_at(line, column, fmt::format("a line needs at least 2 points, got {}", count));
  }

  /// The vertex of "v", "v/vt", "v//vn" or "v/vt/vn".
  std::int32_t vertex_index(std::string_view text, const char* user) {
    const std::size_t slash = text.find('/');
    const std::int64_t given = scanner_.to_integer(text.substr(0, slash), fmt::format("vertex of a {}", user));
    if (slash != std::string_view::npos) check_texture_and_normal(text.substr(slash + 1));
    const auto known = static_cast<std::int64_t>(file_.vertices.size());
    if (given == 0) scanner_.fail(fmt::format("{} refers to vertex 0; OBJ files count from 1", user));
    if (given < -known) {
      scanner_.fail(fmt::format("{} refers to vertex {}, but only {} vertices come before it", user, given, known));
    }
    const std::int64_t vertex = given > 0 ? given : known + given + 1;
    if (vertex > std::numeric_limits<std::int32_t>::max()) {
      scanner_.fail(fmt::format("{} refers to vertex {}; the largest possible is 2147483647", user, vertex));
    }
    if (vertex > known) forward_.push_back({vertex, scanner_.line(), scanner_.column(), user});
    return static_cast<std::int32_t>(vertex - 1);
  }

  void check_texture_and_normal(std::string_view text) const {
    const std::size_t slash = text.find('/');
    const std::string_view texture = text.substr(0, slash);
    if (!texture.empty()) scanner_.to_integer(texture, "texture coordinate of a face");
    if (slash == std::string_view::npos) return;
    const std::string_view normal = text.substr(slash + 1);
    if (!normal.empty()) scanner_.to_integer(normal, "normal of a face");
  }

  void check_forward_references() const {
    for (const ForwardReference& reference : forward_) {
      if (reference.vertex <= static_cast<std::int64_t>(file_.vertices.size())) continue;
      scanner_.fail_at(reference.line, reference.column,
                       fmt::format("{} refers to vertex {}, the file has {}", reference.user, reference.vertex,
                                   file_.vertices.size()));
    }
  }

  TextScanner scanner_;
  ObjFile file_;
  std::vector<ForwardReference> forward_;
};

}  // namespace

ObjFile parse_obj(std::string_view bytes, const std::string& name) { return ObjParser(bytes, name).parse(); }

void add_fan(const std::int32_t* corners, std::size_t count, TriangleMesh& mesh) {
  for (std::size_t i = 2; i < count; ++i) mesh.triangles.push_back({corners[0], corners[i - 1], corners[i]});
}

TriangleMesh triangulate(const ObjFile& file, const std::string& name) {
  TriangleMesh mesh;
  mesh.vertices = file.vertices;
  for (std::size_t i = 0, begin = 0; i < file.face_ends.size(); begin = file.face_ends[i++]) {
    add_fan(file.corners.data() + begin, file.face_ends[i] - begin, mesh);
  }
  if (mesh.triangles.empty()) {
    const char* hint = file.segments.empty() ? "" : "; its lines are an outline for a 2D scene";
    throw Error(ErrorKind::usage,
                fmt::format("{}: the file has {} vertices but no faces{}", name, file.vertices.size(), hint));
  }
  return mesh;
}

}  // namespace firn
