#include <firn/core/error.h>
#include <firn/core/parallel.h>
#include <firn/geometry/closest_point.h>
#include <firn/geometry/deforming_mesh.h>
#include <firn/geometry/mesh_inside.h>
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

namespace firn {
namespace {

/// Look-up cells along the longest side when meshes are searched for overlaps.
constexpr int kOverlapCells = 32;

std::uint64_t new_number() {
  static std::atomic<std::uint64_t> last = 0;
  return ++last;
}

bool has_overlaps(const MeshSequence& sequence) {
  std::vector<char> overlap(sequence.positions.size());
  parallel_each(overlap.size(), [&](std::size_t k) {
    const MeshInside inside({sequence.positions[k], sequence.triangles}, kOverlapCells);
    overlap[k] = inside.has_overlaps() || inside.has_inverted_parts() ? 1 : 0;
  });
  return std::find(overlap.begin(), overlap.end(), 1) != overlap.end();
}

/// The point of the surface nearest to a place.
struct Nearest {
  Vec3d point, weights;
  std::uint32_t triangle = 0;
  double distance = 0;  ///< signed
};

}  // namespace

TriangleMesh MeshSequence::mesh_at(double t) const {
  TriangleMesh mesh;
  mesh.triangles = triangles;
  mesh.vertices.resize(positions.front().size());
  const SequenceClock::Sum sum = clock.at(t);
  parallel_chunks(mesh.vertices.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      Vec3d x = {};
      for (const SequenceClock::Term& term : sum) x += term.weight * positions[term.entry][v];
      mesh.vertices[v] = x;
    }
  });
  return mesh;
}

/// A DeformingMesh at one instant.
class MeshInstant final : public ShapeInMotion<3> {
 public:
  MeshInstant(const DeformingMesh& whole, double t)
      : whole_(whole), t_(t), number_(new_number()), mesh_(whole.sequence_.mesh_at(t)), tree_(whole.tree_) {
    tree_.refit(mesh_);
    if (whole.uses_winding_number_) winding_.emplace(mesh_);
    side_ = bounds().largest_side();
    fastest_ = largest_speed();
  }

  double distance(const Vec3d& x) const override {
    const double sign = whole_.inverted_ ? -1 : 1;
    const double beyond = distance_to_box(x);
    return sign * (beyond > 0.05 * side_ ? beyond : nearest(x).distance);
  }

  Vec3d normal(const Vec3d& x) const override {
    const Nearest near = nearest(x);
    const double sign = whole_.inverted_ ? -1 : 1;
    // Closer than this the difference has lost its digits.
    if (std::abs(near.distance) > 1e-9 * side_) return (sign / near.distance) * (x - near.point);
    return sign * direction(pseudonormal(mesh_, whole_.neighbours_, near.triangle, near.weights));
  }

  Bounds<3> bounds() const override { return tree_.nodes().front().box; }
  bool is_bounded() const override { return !whole_.inverted_; }

  double fastest() const override { return fastest_; }

  Vec3d velocity(const Vec3d& x, double ahead) const override {
    const Nearest near = nearest(x);
    const auto& corners = mesh_.triangles[near.triangle];
    Vec3d v = {};
    for (const SequenceClock::Term& term : whole_.sequence_.clock.at(t_ + ahead)) {
      for (std::size_t i = 0; i < 3; ++i) {
        const auto vertex = static_cast<std::size_t>(corners[i]);
        v += term.rate * near.weights[static_cast<int>(i)] * whole_.sequence_.positions[term.entry][vertex];
      }
    }
    return v;
  }

  Vec3d displacement(const Vec3d& x, double duration) const override {
    const Nearest near = nearest(x);
    const SequenceClock::Sum later = whole_.sequence_.clock.at(t_ + duration);
    Vec3d moved = {};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto vertex = static_cast<std::size_t>(mesh_.triangles[near.triangle][i]);
      Vec3d there = {};
      for (const SequenceClock::Term& term : later)
        there += term.weight * whole_.sequence_.positions[term.entry][vertex];
      moved += near.weights[static_cast<int>(i)] * (there - mesh_.vertices[vertex]);
    }
    return moved;
  }

 private:
  /// Of the vertices, and so of all that lies between them.
  double largest_speed() const {
    const SequenceClock::Sum sum = whole_.sequence_.clock.at(t_);
    constexpr std::size_t kChunk = 4096;
    std::vector<double> squares(mesh_.vertices.size() / kChunk + 1);
    parallel_chunks(mesh_.vertices.size(), kChunk, [&](std::size_t begin, std::size_t end) {
      for (std::size_t vertex = begin; vertex < end; ++vertex) {
        Vec3d v = {};
        for (const SequenceClock::Term& term : sum) v += term.rate * whole_.sequence_.positions[term.entry][vertex];
        squares[begin / kChunk] = std::max(squares[begin / kChunk], dot(v, v));
      }
    });
    return std::sqrt(*std::max_element(squares.begin(), squares.end()));
  }

  double distance_to_box(const Vec3d& x) const {
    const Bounds<3>& box = tree_.nodes().front().box;
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
      const double beyond = std::max({box.lower[i] - x[i], x[i] - box.upper[i], 0.0});
      sum += beyond * beyond;
    }
    return std::sqrt(sum);
  }

  Nearest nearest(const Vec3d& x) const {
    // Contact asks for distance, normal and velocity at one place after the other, and for places side by side: what a
    // thread has found last is the answer or bounds it, and changes no bit of it.
    struct Last {
      std::uint64_t number = 0;
      Vec3d x;
      Nearest nearest;
    };
    thread_local Last last;
    double within = std::numeric_limits<double>::infinity();
    if (last.number == number_) {
      const double moved = norm(x - last.x);
      if (moved == 0) return last.nearest;
      within = std::abs(last.nearest.distance) + moved + 1e-9 * side_;
    }
    last = {number_, x, search(x, within)};
    return last.nearest;
  }

  Nearest search(const Vec3d& x, double within) const {
    const ClosestPoint found = closest_point(tree_, x, within);
    const TriangleBvh::Triangle triangle = {mesh_.corner(found.triangle, 0), mesh_.corner(found.triangle, 1),
                                            mesh_.corner(found.triangle, 2)};
    const TrianglePoint place = weighted_closest_point_of(triangle, x);
    Nearest near = {place.point, place.weights, found.triangle, found.distance};
    const bool inside =
        winding_ ? (*winding_)(x) > 0.5
                 : dot(x - place.point, pseudonormal(mesh_, whole_.neighbours_, found.triangle, place.weights)) < 0;
    if (inside) near.distance = -near.distance;
    return near;
  }

  const DeformingMesh& whole_;
  double t_;
  std::uint64_t number_;  ///< of no other instant, ever: addresses are used again
  TriangleMesh mesh_;
  TriangleBvh tree_;
  std::optional<WindingNumber> winding_;
  double side_ = 0, fastest_ = 0;
};

DeformingMesh::DeformingMesh(MeshSequence sequence, bool inverted)
    : sequence_(std::move(sequence)),
      inverted_(inverted),
      neighbours_({sequence_.positions.at(0), sequence_.triangles}),
      tree_({sequence_.positions.at(0), sequence_.triangles}) {
  if (sequence_.triangles.empty() || sequence_.positions.size() != times().size()) {
    throw Error(ErrorKind::usage,
                fmt::format("a sequence of meshes: {} triangles, and {} lists of positions for {} times",
                            sequence_.triangles.size(), sequence_.positions.size(), times().size()));
  }
  for (const auto& positions : sequence_.positions) {
    if (positions.size() == sequence_.positions.front().size()) continue;
    throw Error(ErrorKind::usage, fmt::format("a sequence of meshes: {} vertices after {}", positions.size(),
                                              sequence_.positions.front().size()));
  }
  uses_winding_number_ = !neighbours_.is_closed_manifold() || has_overlaps(sequence_);
}

std::shared_ptr<const ShapeInMotion<3>> DeformingMesh::at(double t) const {
  {
    const std::lock_guard lock(mutex_);
    for (const Cached& cached : cached_) {
      if (cached.shape && cached.t == t) return cached.shape;
    }
  }
  // Made without the lock, because a thread that waits for its parallel loops may be given other work that asks.
  auto made = std::make_shared<MeshInstant>(*this, t);
  const std::lock_guard lock(mutex_);
  cached_[next_slot_] = {t, made};
  next_slot_ = (next_slot_ + 1) % cached_.size();
  return made;
}

double gap_of_cycle(const MeshSequence& sequence) {
  const auto gap = [&](const std::vector<Vec3d>& from, const std::vector<Vec3d>& to) {
    const TriangleBvh tree({to, sequence.triangles});
    double largest = 0;
    for (const Vec3d& x : from) largest = std::max(largest, closest_point(tree, x).distance);
    return largest;
  };
  const auto &first = sequence.positions.front(), &last = sequence.positions.back();
  return std::max(gap(first, last), gap(last, first));
}

}  // namespace firn
