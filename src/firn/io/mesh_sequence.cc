#include <firn/core/error.h>
#include <firn/geometry/prepare_mesh.h>
#include <firn/io/mesh_reader.h>
#include <firn/io/mesh_sequence.h>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace firn {
namespace {

std::string size_text(const TriangleMesh& mesh) {
  return fmt::format("{} vertices and {} triangles", mesh.vertices.size(), mesh.triangles.size());
}

void check_topology(const TriangleMesh& mesh, const std::string& name, const TriangleMesh& first,
                    const std::string& first_name) {
  constexpr const char* kRule = "all meshes of a sequence need the same vertices and triangles in the same order";
  if (mesh.vertices.size() != first.vertices.size() || mesh.triangles.size() != first.triangles.size()) {
    throw Error(ErrorKind::usage, fmt::format("{}: has {}, but {} has {}; {}", name, size_text(mesh), first_name,
                                              size_text(first), kRule));
  }
  const auto [other, own] = std::mismatch(first.triangles.begin(), first.triangles.end(), mesh.triangles.begin());
  if (other == first.triangles.end()) return;
  const auto corners = [](const std::array<std::int32_t, 3>& t) {
    return fmt::format("{} {} {}", t[0] + 1, t[1] + 1, t[2] + 1);
  };
  throw Error(ErrorKind::usage,
              fmt::format("{}: triangle {} has the corners {}, but in {} {}; {}", name,
                          own - mesh.triangles.begin() + 1, corners(*own), first_name, corners(*other), kRule));
}

bool before(const Vec3d& a, const Vec3d& b) {
  return std::lexicographical_compare(std::begin(a.e), std::end(a.e), std::begin(b.e), std::end(b.e));
}
bool same(const Vec3d& a, const Vec3d& b) { return std::equal(std::begin(a.e), std::end(a.e), std::begin(b.e)); }

/// Makes vertices that are at one place in all meshes one.
void merge_vertices(MeshSequence& sequence) {
  const auto& positions = sequence.positions;
  std::vector<std::int32_t> order(positions.front().size());
  std::iota(order.begin(), order.end(), 0);
  const auto at = [](const std::vector<Vec3d>& list, std::int32_t v) { return list[static_cast<std::size_t>(v)]; };
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    for (const auto& list : positions) {
      if (!same(at(list, a), at(list, b))) return before(at(list, a), at(list, b));
    }
    return a < b;
  });
  std::vector<std::int32_t> stands_for(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_new = i == 0 || std::any_of(positions.begin(), positions.end(), [&](const auto& list) {
                          return !same(at(list, order[i]), at(list, order[i - 1]));
                        });
    stands_for[static_cast<std::size_t>(order[i])] =
        is_new ? order[i] : stands_for[static_cast<std::size_t>(order[i - 1])];
  }
  for (auto& triangle : sequence.triangles) {
    for (std::int32_t& v : triangle) v = stands_for[static_cast<std::size_t>(v)];
  }
  std::erase_if(sequence.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

}  // namespace

MeshSequence read_mesh_sequence(const std::vector<std::filesystem::path>& files, SequenceClock clock, bool strict) {
  const std::string first_name = files.front().string();
  const TriangleMesh first = read_mesh(files.front());
  MeshSequence sequence = {first.triangles, {}, std::move(clock)};
  for (const std::filesystem::path& file : files) {
    TriangleMesh mesh = read_mesh(file);
    check_topology(mesh, file.string(), first, first_name);
    sequence.positions.push_back(std::move(mesh.vertices));
  }
  merge_vertices(sequence);
  const PreparedMesh prepared = prepare_mesh({first.vertices, sequence.triangles}, first_name, strict);
  if (prepared.flipped) {
    for (auto& triangle : sequence.triangles) std::swap(triangle[1], triangle[2]);
  }
  for (std::size_t k = 1; k < files.size() && prepared.report.is_closed(); ++k) {
    const double volume = enclosed_volume({sequence.positions[k], sequence.triangles});
    if (volume > 0) continue;
    throw Error(ErrorKind::usage,
                fmt::format("{}: encloses {:.3g} m^3, against {:.3g} m^3 in {}: the surface is turned inside out on "
                            "the way",
                            files[k].string(), volume, prepared.report.volume, first_name));
  }
  return sequence;
}

}  // namespace firn
