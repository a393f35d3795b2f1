#pragma once

#include <firn/core/linear_algebra.h>
#include <firn/state/snapshot.h>
#include <firn/surface/particle_surface.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace firn {

/// What a surface is to be made of.
struct SurfaceOrder {
  std::shared_ptr<const Snapshot> snapshot;
  std::int64_t frame = 0;
  SurfaceOptions options;
  std::string color_by;                                       ///< a column; empty: the colours of the materials
  std::map<std::string, Vec3f> material_colors, body_colors;  ///< as a View has them
  int threads = 1;                                            ///< to make it with; any number gives the same bits

  /// Whether the other one would give the same surface.
  bool same_as(const SurfaceOrder& other) const {
    return snapshot == other.snapshot && options == other.options && color_by == other.color_by;
  }
};

/// Laid out for the graphics card.
struct SurfaceVertex {
  Vec3f position;  ///< from the surface's origin, m
  Vec3f normal;    ///< outwards
  Vec3f carried;   ///< linear RGB; of a column its value (the magnitude of vectors) and two zeros
};

/// The surface of a frame's particles as triangles.
struct MeshedSurface {
  SurfaceOrder order;                    ///< what it was made of
  std::array<double, 2> range = {0, 1};  ///< automatic range of the column
  Vec3d origin = {};
  std::vector<SurfaceVertex> vertices;
  std::vector<std::array<std::int32_t, 3>> triangles;  ///< counter-clockwise seen from outside
  double seconds = 0;                                  ///< that it took
};

/// Makes it. `before` may be null; if it has the same form, only its colours are made anew.
/// Throws Error as particle_surface(), and (usage) for an unknown column and for particles of 2D.
MeshedSurface mesh_surface(const SurfaceOrder& order, const MeshedSurface* before);

/// Makes surfaces in a thread of its own, always of what was wanted last: what was wanted in between is left out, and
/// what is being made is finished. Every function returns at once; only the destructor waits for the surface that is
/// being made.
class SurfaceMesher {
 public:
  using Make = std::function<MeshedSurface(const SurfaceOrder&, const MeshedSurface*)>;
  struct Status {
    bool busy = false;          ///< what was wanted last is not there yet
    std::uint64_t version = 0;  ///< another number when something is ready or has failed
    std::string message;        ///< why there is no surface of what was wanted last
  };

  explicit SurfaceMesher(Make make = mesh_surface);
  ~SurfaceMesher();
  SurfaceMesher(const SurfaceMesher&) = delete;
  SurfaceMesher& operator=(const SurfaceMesher&) = delete;

  /// Nothing new if it is what was wanted last.
  void want(const SurfaceOrder& order);
  /// Forgets all surfaces, also the one that is being made, and what was wanted.
  void clear();
  /// The last one that is ready; null if there is none.
  std::shared_ptr<const MeshedSurface> latest() const;
  Status status() const;
  /// Blocks until nothing is being made; false if that took longer.
  bool wait(std::chrono::milliseconds timeout) const;

 private:
  void run();

  const Make make_;
  mutable std::mutex mutex_;  ///< guards all below but the thread
  mutable std::condition_variable changed_;
  std::optional<SurfaceOrder> wanted_;  ///< last
  bool pending_ = false;                ///< it has not been begun
  bool stop_ = false;
  std::uint64_t epoch_ = 0;  ///< of clear(): what belongs to the one before is dropped
  std::shared_ptr<const MeshedSurface> latest_;
  Status status_;
  std::thread thread_;  ///< last: it starts when all else is there
};

}  // namespace firn
