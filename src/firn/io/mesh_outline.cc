#include <firn/core/error.h>
#include <firn/io/mesh_parsers.h>
#include <fmt/format.h>

#include <algorithm>

namespace firn {
namespace {

using Segment = std::array<std::int32_t, 2>;

/// The sides of the faces that no other face runs along: the border of a triangulated region.
std::vector<Segment> face_borders(const ObjFile& file) {
  std::vector<Segment> sides;
  for (std::size_t i = 0, begin = 0; i < file.face_ends.size(); begin = file.face_ends[i++]) {
    const std::size_t count = file.face_ends[i] - begin;
    for (std::size_t k = 0; k < count; ++k) {
      sides.push_back({file.corners[begin + k], file.corners[begin + (k + 1) % count]});
    }
  }
  const auto undirected = [](const Segment& s) { return Segment{std::min(s[0], s[1]), std::max(s[0], s[1])}; };
  std::sort(sides.begin(), sides.end(),
            [&](const Segment& a, const Segment& b) { return undirected(a) < undirected(b); });
  std::vector<Segment> borders;
  for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
    while (end < sides.size() && undirected(sides[end]) == undirected(sides[begin])) ++end;
    if (end - begin == 1) borders.push_back(sides[begin]);
  }
  return borders;
}

/// The two neighbours of each vertex of the outline, -1 for none.
std::vector<Segment> neighbours(const std::vector<Segment>& segments, std::size_t vertex_count,
                                const std::string& name) {
  std::vector<Segment> result(vertex_count, Segment{-1, -1});
  const auto join = [&](std::int32_t from, std::int32_t to) {
    Segment& known = result[static_cast<std::size_t>(from)];
    if (known[1] >= 0)
      throw Error(ErrorKind::usage, fmt::format("{}: the outline branches at vertex {}", name, from + 1));
    known[known[0] < 0 ? 0 : 1] = to;
  };
  for (const Segment& s : segments) {
    if (s[0] == s[1]) continue;
    join(s[0], s[1]);
    join(s[1], s[0]);
  }
  return result;
}

}  // namespace

Polygon chain_outline(const ObjFile& file, const std::string& name) {
  const std::vector<Segment> segments = file.segments.empty() ? face_borders(file) : file.segments;
  if (segments.empty()) throw Error(ErrorKind::usage, name + ": the file has neither lines (l) nor faces (f)");
  const std::vector<Segment> next = neighbours(segments, file.vertices.size(), name);
  std::vector<bool> used(file.vertices.size(), false);
  Polygon polygon;
  for (std::size_t start = 0; start < next.size(); ++start) {
    if (used[start] || next[start][0] < 0) continue;
    std::vector<Vec2d> loop;
    std::int32_t previous = -1;
    for (std::int32_t v = static_cast<std::int32_t>(start); !used[static_cast<std::size_t>(v)];) {
      const auto at = static_cast<std::size_t>(v);
      const Vec3d& x = file.vertices[at];
      if (next[at][1] < 0)
        throw Error(ErrorKind::usage, fmt::format("{}: the outline ends at vertex {}; close it", name, v + 1));
      if (x[2] != 0) {
        throw Error(ErrorKind::usage,
                    fmt::format("{}: vertex {} has z = {}; a 2D outline lies in z = 0", name, v + 1, x[2]));
      }
      used[at] = true;
      loop.push_back({{x[0], x[1]}});
      const std::int32_t following = next[at][0] != previous ? next[at][0] : next[at][1];
      previous = v;
      v = following;
    }
    if (loop.size() < 3)
      throw Error(ErrorKind::usage, fmt::format("{}: the outline at vertex {} encloses nothing", name, start + 1));
    polygon.loops.push_back(std::move(loop));
  }
  orient(polygon);
  if (!(area(polygon) > 0)) throw Error(ErrorKind::usage, name + ": the outline encloses no area");
  return polygon;
}

}  // namespace firn
