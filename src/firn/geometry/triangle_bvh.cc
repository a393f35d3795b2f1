#include <firn/core/parallel.h>
#include <firn/geometry/triangle_bvh.h>

#include <numeric>

namespace firn {
namespace {

constexpr std::uint32_t kLeafSize = 6;

Vec3d middle(const TriangleMesh& mesh, std::uint32_t t) {
  return (1.0 / 3) * (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2));
}

}  // namespace

TriangleBvh::TriangleBvh(const TriangleMesh& mesh) : order_(mesh.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  std::vector<Vec3d> middles(order_.size());
  for (std::uint32_t t = 0; t < middles.size(); ++t) middles[t] = middle(mesh, t);

  nodes_.push_back({{}, 0, static_cast<std::uint32_t>(order_.size()), 0});
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    const std::uint32_t begin = nodes_[n].begin, end = nodes_[n].end;
    Bounds<3> box, spread;
    for (std::uint32_t i = begin; i < end; ++i) {
      for (int corner = 0; corner < 3; ++corner) box.include(mesh.corner(order_[i], corner));
      spread.include(middles[order_[i]]);
    }
    nodes_[n].box = box;
    if (end - begin <= kLeafSize) continue;
    const Vec3d size = spread.size();
    const int axis = size[0] >= size[1] && size[0] >= size[2] ? 0 : size[1] >= size[2] ? 1 : 2;
    const std::uint32_t half = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + half, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                       return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b;
                     });
    nodes_[n].first_child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, begin, half, 0});
    nodes_.push_back({{}, half, end, 0});
  }
  place_triangles(mesh);
}

void TriangleBvh::place_triangles(const TriangleMesh& mesh) {
  triangles_.resize(order_.size());
  parallel_chunks(order_.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      triangles_[i] = {mesh.corner(order_[i], 0), mesh.corner(order_[i], 1), mesh.corner(order_[i], 2)};
    }
  });
}

void TriangleBvh::refit(const TriangleMesh& mesh) {
  place_triangles(mesh);
  for (std::size_t n = nodes_.size(); n-- > 0;) {
    Node& node = nodes_[n];
    node.box = {};
    if (node.first_child == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) {
        for (const Vec3d& corner : triangles_[i]) node.box.include(corner);
      }
      continue;
    }
    for (std::uint32_t child = node.first_child; child < node.first_child + 2; ++child) {
      node.box.include(nodes_[child].box.lower);
      node.box.include(nodes_[child].box.upper);
    }
  }
}

}  // namespace firn
