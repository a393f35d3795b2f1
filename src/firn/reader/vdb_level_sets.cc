// The only file that reads with OpenVDB. It must not be compiled with hidden visibility: OpenVDB 10.0 crashes in
// initialize().

#include <firn/core/error.h>
#include <firn/reader/vdb_level_sets.h>
#include <fmt/format.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

namespace firn {
namespace {

namespace fs = std::filesystem;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::FloatGrid;
using openvdb::Vec3SGrid;

constexpr int kSide = VectorGrid::kSide, kRow = VectorGrid::kRow;
/// Blocks of a sequence's grid at most: far more than memory holds of nodes.
constexpr double kMostBlocks = 1 << 26;

[[noreturn]] void fail(const fs::path& file, const std::string& what, ErrorKind kind = ErrorKind::usage) {
  throw Error(kind, fmt::format("{}: {}", file.string(), what));
}

/// The grids of a file that matter.
struct VdbGrids {
  FloatGrid::Ptr distance;
  Vec3SGrid::Ptr velocity;  ///< may be null
};

FloatGrid::Ptr as_single(const openvdb::GridBase::Ptr& grid) {
  if (auto single = openvdb::gridPtrCast<FloatGrid>(grid)) return single;
  if (auto twice = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid)) return FloatGrid::Ptr(new FloatGrid(*twice));
  return nullptr;
}

std::string lower_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

VdbGrids choose_grids(const fs::path& path, const openvdb::GridPtrVec& grids) {
  VdbGrids chosen;
  std::vector<FloatGrid::Ptr> scalars, level_sets;
  std::string names;
  for (const openvdb::GridBase::Ptr& grid : grids) {
    names += fmt::format("{}\"{}\" ({})", names.empty() ? "" : ", ", grid->getName(), grid->valueType());
    const std::string name = lower_case(grid->getName());
    if (auto vectors = openvdb::gridPtrCast<Vec3SGrid>(grid);
        vectors && (name == "v" || name == "vel" || name == "velocity")) {
      chosen.velocity = vectors;
    }
    if (auto scalar = as_single(grid)) {
      scalars.push_back(scalar);
      if (scalar->getGridClass() == openvdb::GRID_LEVEL_SET) level_sets.push_back(scalar);
    }
  }
  if (level_sets.empty() && scalars.size() == 1) level_sets = scalars;
  if (level_sets.size() != 1) {
    fail(path, fmt::format("has {} level sets; it needs one grid of that class. Grids: {}", level_sets.size(),
                           names.empty() ? "none" : names));
  }
  chosen.distance = level_sets.front();
  return chosen;
}

VdbGrids read_grids(const fs::path& path) {
  openvdb::initialize();
  std::error_code ignored;
  if (!fs::exists(path, ignored) || fs::is_directory(path, ignored)) fail(path, "is not a file", ErrorKind::files);
  openvdb::GridPtrVecPtr grids;
  try {
    openvdb::io::File file(path.string());
    // Read now and not on demand, because the file may change while a run goes on.
    file.open(false);
    grids = file.getGrids();
    file.close();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    fail(path, fmt::format("cannot be read as an OpenVDB file: {}", what), ErrorKind::files);
  }
  return choose_grids(path, *grids);
}

struct Lattice {
  Vec3d origin;  ///< of node (0, 0, 0), m
  double cell;   ///< m
};

Vec3d ours(const openvdb::Vec3d& v) { return {{v.x(), v.y(), v.z()}}; }

Lattice lattice_of(const fs::path& path, const openvdb::GridBase& grid) {
  const openvdb::math::Transform& transform = grid.transform();
  const Vec3d origin = ours(transform.indexToWorld(openvdb::Vec3d(0, 0, 0)));
  const double cell = ours(transform.indexToWorld(openvdb::Vec3d(1, 0, 0)))[0] - origin[0];
  bool cubes = transform.isLinear() && cell > 0;
  for (int axis = 0; axis < 3 && cubes; ++axis) {
    openvdb::Vec3d unit(0, 0, 0);
    unit[axis] = 1;
    Vec3d along = ours(transform.indexToWorld(unit)) - origin;
    along[axis] -= cell;
    cubes = norm(along) <= 1e-5 * cell;
  }
  if (!cubes) {
    fail(path, fmt::format("the cells of grid \"{}\" are not cubes along the axes; resample it, or turn it with the "
                           "collider's rotation",
                           grid.getName()));
  }
  return {origin, cell};
}

/// Blocks of 8 cells over the active part of a grid.
struct BlockLattice {
  Coord first;  ///< node at the corner of the first block
  std::int32_t blocks[3];

  BlockLattice(const fs::path& path, const openvdb::GridBase& grid) {
    const CoordBBox box = grid.evalActiveVoxelBoundingBox();
    double count = 1;
    for (int i = 0; i < 3; ++i) {
      const std::int32_t low = box.min()[i] - 1;
      first[i] = low - ((low % kSide) + kSide) % kSide;
      const double blocks_along = std::floor((double(box.max()[i]) + 1 - first[i]) / kSide) + 1;
      count *= blocks_along;
      if (count <= kMostBlocks) blocks[i] = static_cast<std::int32_t>(blocks_along);
    }
    if (!(count <= kMostBlocks)) fail(path, fmt::format("grid \"{}\" is more than 2^26 blocks", grid.getName()));
  }

  std::size_t size() const {
    return static_cast<std::size_t>(blocks[0]) * static_cast<std::size_t>(blocks[1]) *
           static_cast<std::size_t>(blocks[2]);
  }
  Coord corner(std::size_t b) const {
    const auto n1 = static_cast<std::size_t>(blocks[1]), n2 = static_cast<std::size_t>(blocks[2]);
    return first + Coord(kSide * static_cast<std::int32_t>(b / (n1 * n2)),
                         kSide * static_cast<std::int32_t>(b / n2 % n1), kSide * static_cast<std::int32_t>(b % n2));
  }
};

/// Whether a block has an active node, its upper sides included, where it meets the next block.
template <class Accessor>
bool has_active(const Accessor& accessor, const Coord& corner) {
  for (int i = 0; i < kRow; ++i) {
    for (int j = 0; j < kRow; ++j) {
      for (int k = 0; k < kRow; ++k) {
        if (accessor.isValueOn(corner + Coord(i, j, k))) return true;
      }
    }
  }
  return false;
}

Vec3d node_position(const Lattice& lattice, const Coord& node) {
  return lattice.origin + lattice.cell * Vec3d{{double(node.x()), double(node.y()), double(node.z())}};
}

/// visit(inside, outside) for all neighbouring grid nodes between which the surface is.
template <class Visit>
void visit_surface(const FloatGrid& grid, const Visit& visit) {
  const auto accessor = grid.getConstAccessor();
  for (auto value = grid.cbeginValueOn(); value; ++value) {
    if (!value.isVoxelValue() || !(*value < 0)) continue;
    const Coord node = value.getCoord();
    for (const Coord& step :
         {Coord(1, 0, 0), Coord(-1, 0, 0), Coord(0, 1, 0), Coord(0, -1, 0), Coord(0, 0, 1), Coord(0, 0, -1)}) {
      if (!(accessor.getValue(node + step) < 0)) visit(node, node + step);
    }
  }
}

LevelSet::Data level_set_of(const fs::path& path, const FloatGrid& grid, double scale) {
  const Lattice lattice = lattice_of(path, grid);
  const double band = std::abs(static_cast<double>(grid.background()));
  if (!(band >= 2 * lattice.cell * (1 - 1e-5))) {
    fail(path, fmt::format("the narrow band of grid \"{}\" is {:.3g} m on either side, {:.2g} cells; 2 are needed",
                           grid.getName(), band, band / lattice.cell));
  }
  LevelSet::Data data;
  Bounds<3> surface;
  visit_surface(grid, [&](const Coord& node, const Coord&) { surface.include(node_position(lattice, node)); });
  if (!(surface.lower[0] <= surface.upper[0])) {
    fail(path, fmt::format("grid \"{}\" has no surface: no value below 0 next to one above", grid.getName()));
  }
  const BlockLattice blocks(path, grid);
  const Vec3d margin = constant_vector<double, 3>(lattice.cell);
  data.cell = scale * lattice.cell;
  data.lower = scale * node_position(lattice, blocks.first);
  data.mesh_lower = scale * (surface.lower - margin);
  data.mesh_upper = scale * (surface.upper + margin);
  std::copy_n(blocks.blocks, 3, data.blocks);
  const auto accessor = grid.getConstAccessor();
  std::int32_t fine = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Coord corner = blocks.corner(b);
    const bool active = has_active(accessor, corner);
    data.center.push_back(static_cast<float>(scale * accessor.getValue(corner + Coord(kSide / 2))));
    data.fine.push_back(active ? fine++ : -1);
    if (!active) continue;
    for (int i = 0; i < kRow; ++i) {
      for (int j = 0; j < kRow; ++j) {
        for (int k = 0; k < kRow; ++k) {
          data.nodes.push_back(static_cast<float>(scale * accessor.getValue(corner + Coord(i, j, k))));
        }
      }
    }
  }
  return data;
}

/// The vector at a node; of a staggered grid, whose components lie on faces, the mean of both sides.
Vec3f vector_at(const Vec3SGrid::ConstAccessor& accessor, const Coord& node, bool staggered) {
  const openvdb::Vec3s v = accessor.getValue(node);
  if (!staggered) return {{v.x(), v.y(), v.z()}};
  return {{0.5F * (v.x() + accessor.getValue(node + Coord(1, 0, 0)).x()),
           0.5F * (v.y() + accessor.getValue(node + Coord(0, 1, 0)).y()),
           0.5F * (v.z() + accessor.getValue(node + Coord(0, 0, 1)).z())}};
}

std::optional<VectorGrid::Data> velocity_of(const fs::path& path, const Vec3SGrid& grid, double scale) {
  if (grid.activeVoxelCount() == 0) return std::nullopt;
  const Lattice lattice = lattice_of(path, grid);
  const BlockLattice blocks(path, grid);
  VectorGrid::Data data;
  data.cell = scale * lattice.cell;
  data.lower = scale * node_position(lattice, blocks.first);
  std::copy_n(blocks.blocks, 3, data.blocks);
  const auto accessor = grid.getConstAccessor();
  const bool staggered = grid.getGridClass() == openvdb::GRID_STAGGERED;
  std::int32_t stored = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const Coord corner = blocks.corner(b);
    const bool active = has_active(accessor, corner);
    data.stored.push_back(active ? stored++ : -1);
    if (!active) continue;
    for (int i = 0; i < kRow; ++i) {
      for (int j = 0; j < kRow; ++j) {
        for (int k = 0; k < kRow; ++k) {
          Vec3f v = vector_at(accessor, corner + Coord(i, j, k), staggered);
          for (int c = 0; c < 3; ++c) v[c] = static_cast<float>(scale * v[c]);
          data.nodes.push_back(v);
        }
      }
    }
  }
  return data;
}

/// The nodes on both sides of one surface must be in the other's band: the surface moves with the difference of the two
/// distances there, and beyond the band they are no distances.
void check_band(const fs::path& file, const FloatGrid& surface, const fs::path& band_file, const FloatGrid& band) {
  const auto accessor = band.getConstAccessor();
  const auto has = [&](const Coord& node) {
    return accessor.isValueOn(Coord::round(band.worldToIndex(surface.indexToWorld(node))));
  };
  visit_surface(surface, [&](const Coord& inside, const Coord& outside) {
    if (has(inside) && has(outside)) return;
    const double width = std::abs(static_cast<double>(band.background())), cell = surface.voxelSize()[0];
    fail(file, fmt::format("its surface is too far from that of {}: a narrow band of {:.3g} m and cells of {:.3g} m "
                           "are good for {:.3g} m; export more frames or a wider band",
                           band_file.string(), width, cell, width - cell));
  });
}

}  // namespace

void read_vdb_level_sets(const std::vector<fs::path>& files, double scale,
                         const std::function<void(LevelSetParts)>& take) {
  VdbGrids last;
  for (std::size_t k = 0; k < files.size(); ++k) {
    VdbGrids grids = read_grids(files[k]);
    LevelSetParts parts = {level_set_of(files[k], *grids.distance, scale), std::nullopt};
    if (grids.velocity) parts.velocity = velocity_of(files[k], *grids.velocity, scale);
    if (k > 0) {
      check_band(files[k], *grids.distance, files[k - 1], *last.distance);
      check_band(files[k - 1], *last.distance, files[k], *grids.distance);
    }
    last = std::move(grids);
    take(std::move(parts));
  }
}

std::string vdb_version() { return openvdb::getLibraryVersionString(); }

}  // namespace firn
