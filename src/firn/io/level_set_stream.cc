#include <firn/core/error.h>
#include <firn/io/level_set_stream.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace firn {
namespace {

constexpr std::string_view kMark = "firnls-1";
constexpr std::size_t kNodes = std::size_t(VectorGrid::kRow) * VectorGrid::kRow * VectorGrid::kRow;
/// Of a grid along all axes: what is more does not fit into memory either.
constexpr std::size_t kMostBlocks = std::size_t(1) << 26;

template <class T>
void append(std::string& bytes, const T& value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

template <class T>
void append_list(std::string& bytes, const std::vector<T>& list) {
  append(bytes, static_cast<std::uint64_t>(list.size()));
  bytes.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
}

class Parser {
 public:
  Parser(std::string_view bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  template <class T>
  void take(T& value) {
    need(1, sizeof(T));
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
  }

  template <class T>
  void take_list(std::vector<T>& list) {
    std::uint64_t count = 0;
    take(count);
    need(count, sizeof(T));
    list.resize(count);
    if (count > 0) std::memcpy(list.data(), bytes_.data() + at_, count * sizeof(T));
    at_ += count * sizeof(T);
  }

  bool at_end() const { return at_ == bytes_.size(); }

  void require(bool holds, const char* what) const {
    if (!holds) throw Error(ErrorKind::files, fmt::format("{}: not a level set: {}", name_, what));
  }

 private:
  void need(std::uint64_t count, std::size_t size) const {
    require(count <= (bytes_.size() - at_) / size, "it ends before its parts do");
  }

  std::string_view bytes_;
  const std::string& name_;
  std::size_t at_ = 0;
};

template <int dim, class Real>
bool is_finite(const Vec<Real, dim>& v) {
  for (int i = 0; i < dim; ++i) {
    if (!std::isfinite(v[i])) return false;
  }
  return true;
}

bool all_finite(const std::vector<float>& values) {
  return std::ranges::all_of(values, [](float v) { return std::isfinite(v); });
}

std::size_t block_count(const std::int32_t (&blocks)[3]) {
  std::size_t count = 1;
  for (const std::int32_t n : blocks) {
    if (n <= 0 || count > kMostBlocks) return 0;
    count *= static_cast<std::size_t>(n);
  }
  return count <= kMostBlocks ? count : 0;
}

LevelSet::Data take_distance(Parser& parser) {
  LevelSet::Data data;
  parser.take(data.lower);
  parser.take(data.cell);
  parser.take(data.mesh_lower);
  parser.take(data.mesh_upper);
  parser.take(data.blocks);
  parser.take_list(data.center);
  parser.take_list(data.fine);
  parser.take_list(data.nodes);
  parser.require(block_count(data.blocks) > 0 && LevelSet::is_consistent(data), "its parts do not fit together");
  parser.require(std::isfinite(data.cell) && is_finite(data.lower) && is_finite(data.mesh_lower) &&
                     is_finite(data.mesh_upper) && all_finite(data.center) && all_finite(data.nodes),
                 "it has distances that are not finite");
  return data;
}

VectorGrid::Data take_velocity(Parser& parser) {
  VectorGrid::Data data;
  parser.take(data.lower);
  parser.take(data.cell);
  parser.take(data.blocks);
  parser.take_list(data.stored);
  parser.take_list(data.nodes);
  const auto runs = static_cast<std::int64_t>(data.nodes.size() / kNodes);
  parser.require(data.cell > 0 && block_count(data.blocks) > 0 && data.stored.size() == block_count(data.blocks) &&
                     data.nodes.size() % kNodes == 0 &&
                     std::ranges::all_of(data.stored, [&](std::int32_t s) { return s < runs; }),
                 "the parts of its velocity do not fit together");
  parser.require(std::isfinite(data.cell) && is_finite(data.lower) &&
                     std::ranges::all_of(data.nodes, [](const Vec3f& v) { return is_finite(v); }),
                 "it has velocities that are not finite");
  return data;
}

}  // namespace

std::string level_set_bytes(const LevelSetParts& parts) {
  std::string bytes(kMark);
  const LevelSet::Data& distance = parts.distance;
  append(bytes, distance.lower);
  append(bytes, distance.cell);
  append(bytes, distance.mesh_lower);
  append(bytes, distance.mesh_upper);
  append(bytes, distance.blocks);
  append_list(bytes, distance.center);
  append_list(bytes, distance.fine);
  append_list(bytes, distance.nodes);
  if (parts.velocity) {
    append(bytes, parts.velocity->lower);
    append(bytes, parts.velocity->cell);
    append(bytes, parts.velocity->blocks);
    append_list(bytes, parts.velocity->stored);
    append_list(bytes, parts.velocity->nodes);
  }
  return bytes;
}

LevelSetParts parse_level_set(std::string_view bytes, const std::string& name) {
  Parser parser(bytes, name);
  char mark[kMark.size()];
  parser.take(mark);
  parser.require(std::string_view(mark, sizeof mark) == kMark, "it does not begin as one");
  LevelSetParts parts;
  parts.distance = take_distance(parser);
  if (!parser.at_end()) parts.velocity = take_velocity(parser);
  parser.require(parser.at_end(), "more follows than belongs to it");
  return parts;
}

}  // namespace firn
