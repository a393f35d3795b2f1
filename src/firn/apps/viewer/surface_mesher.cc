#include <firn/apps/viewer/cloud_data.h>
#include <firn/apps/viewer/surface_mesher.h>
#include <firn/core/error.h>
#include <firn/render/particle_color.h>
#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <new>
#include <utility>

namespace firn {
namespace {

using Clock = std::chrono::steady_clock;

Vec3f single(const Vec3d& x) {
  return {{static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])}};
}

Vec3d doubled(const Vec3f& x) { return {{x[0], x[1], x[2]}}; }

/// What each particle gives to the surface.
std::vector<Vec3f> values_of(const SurfaceOrder& order) {
  const Snapshot& snapshot = *order.snapshot;
  View view;
  view.material_colors = order.material_colors;
  view.body_colors = order.body_colors;
  if (order.color_by.empty()) return particle_looks(snapshot, view).color;
  const SnapshotColumn* column = snapshot.find(order.color_by);
  if (column == nullptr) {
    throw Error(ErrorKind::usage, fmt::format("color_by: there is no column \"{}\"", order.color_by));
  }
  std::vector<Vec3f> values(snapshot.size());
  for (std::size_t p = 0; p < values.size(); ++p) {
    values[p] = {{static_cast<float>(color_value(*column, p)), 0, 0}};
  }
  return values;
}

SurfaceParticles particles_of(const Snapshot& snapshot) {
  SurfaceParticles particles;
  particles.spacing = snapshot.particle_spacing;
  particles.positions.resize(snapshot.size());
  for (std::size_t p = 0; p < snapshot.size(); ++p) particles.positions[p] = snapshot.position(p);
  return particles;
}

/// Normals of vertices: means of the triangles around, weighted with their areas.
void set_normals(const TriangleMesh& mesh, std::vector<SurfaceVertex>* vertices) {
  std::vector<Vec3d> sums(mesh.vertices.size(), Vec3d{});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3d a = mesh.corner(t, 0);
    const Vec3d area = cross(mesh.corner(t, 1) - a, mesh.corner(t, 2) - a);
    for (const std::int32_t v : mesh.triangles[t]) {
      auto& sum = sums[static_cast<std::size_t>(v)];
      sum = sum + area;
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const double length = norm(sums[v]);
    (*vertices)[v].normal = length > 0 ? single((1 / length) * sums[v]) : Vec3f{{0, 1, 0}};
  }
}

void set_form(const TriangleMesh& mesh, MeshedSurface* surface) {
  surface->triangles = mesh.triangles;
  surface->vertices.resize(mesh.vertices.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    surface->vertices[v].position = single(mesh.vertices[v] - surface->origin);
  }
  set_normals(mesh, &surface->vertices);
}

bool same_form(const SurfaceOrder& a, const SurfaceOrder& b) {
  return a.snapshot == b.snapshot && a.options == b.options;
}

}  // namespace

MeshedSurface mesh_surface(const SurfaceOrder& order, const MeshedSurface* before) {
  const auto start = Clock::now();
  const Snapshot& snapshot = *order.snapshot;
  if (snapshot.dimension != 3) throw Error(ErrorKind::usage, "particles of a 2D scene have no surface");
  SurfaceParticles particles = particles_of(snapshot);
  std::vector<Vec3f> values = values_of(order);
  MeshedSurface surface;
  if (before != nullptr && same_form(before->order, order)) {
    surface = *before;
    std::vector<Vec3d> places;
    for (const SurfaceVertex& vertex : surface.vertices) places.push_back(surface.origin + doubled(vertex.position));
    values = carried_to(particles, order.options, values, places);
  } else {
    if (snapshot.size() > 0) surface.origin = snapshot.position(0);
    particles.colors = std::move(values);
    ParticleSurface made = particle_surface(particles, order.options);
    set_form(triangulated(made.mesh), &surface);
    values = std::move(made.colors);
  }
  for (std::size_t v = 0; v < surface.vertices.size(); ++v) surface.vertices[v].carried = values[v];
  surface.order = order;
  if (!order.color_by.empty()) surface.range = sampled_color_range(*snapshot.find(order.color_by), snapshot.size());
  surface.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  return surface;
}

SurfaceMesher::SurfaceMesher(Make make) : make_(std::move(make)), thread_([this] { run(); }) {}

SurfaceMesher::~SurfaceMesher() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    changed_.notify_all();
  }
  thread_.join();
}

void SurfaceMesher::want(const SurfaceOrder& order) {
  const std::lock_guard lock(mutex_);
  if (wanted_ && wanted_->same_as(order)) return;
  wanted_ = order;
  pending_ = status_.busy = true;
  changed_.notify_all();
}

void SurfaceMesher::clear() {
  const std::lock_guard lock(mutex_);
  wanted_.reset();
  latest_.reset();
  pending_ = status_.busy = false;
  status_.message.clear();
  ++status_.version;
  ++epoch_;
  changed_.notify_all();
}

std::shared_ptr<const MeshedSurface> SurfaceMesher::latest() const {
  const std::lock_guard lock(mutex_);
  return latest_;
}

SurfaceMesher::Status SurfaceMesher::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

bool SurfaceMesher::wait(std::chrono::milliseconds timeout) const {
  std::unique_lock lock(mutex_);
  return changed_.wait_for(lock, timeout, [this] { return !status_.busy; });
}

void SurfaceMesher::run() {
  for (;;) {
    SurfaceOrder order;
    std::shared_ptr<const MeshedSurface> before;
    std::uint64_t epoch = 0;
    {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [this] { return stop_ || pending_; });
      if (stop_) return;
      order = *wanted_;
      before = latest_;
      epoch = epoch_;
      pending_ = false;
    }
    std::shared_ptr<const MeshedSurface> made;
    std::string message;
    try {
      // An arena of its own: the simulation's threads are not asked to help, and this one never works on its tasks.
      tbb::task_arena arena(order.threads, 1);
      arena.execute([&] { made = std::make_shared<const MeshedSurface>(make_(order, before.get())); });
    } catch (const std::bad_alloc&) {
      message = "no surface: out of memory; a larger voxel takes less";
    } catch (const std::exception& error) {
      message = fmt::format("no surface: {}", error.what());
    }
    const std::lock_guard lock(mutex_);
    if (epoch != epoch_) continue;
    if (made != nullptr) latest_ = std::move(made);
    status_.message = message;
    status_.busy = pending_;
    ++status_.version;
    changed_.notify_all();
  }
}

}  // namespace firn
