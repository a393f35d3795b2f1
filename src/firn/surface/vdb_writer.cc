// One of the few files that know OpenVDB. None of them may be compiled with hidden visibility: OpenVDB 10.0 crashes in
// initialize().

#include <firn/surface/vdb_writer.h>
#include <fmt/format.h>
#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <memory>
#include <mutex>
#include <sstream>
#include <utility>

namespace firn {
namespace {

constexpr std::size_t kVoxels = LeafSet::kVoxels;

template <class Grid>
typename Grid::Ptr make_grid(const LeafSet& leaves, const SparseVolume& volume) {
  using Leaf = typename Grid::TreeType::LeafNodeType;
  using Value = typename Grid::ValueType;
  auto grid = Grid::create(Value(volume.background));
  static_assert(Leaf::SIZE == kVoxels);
  const auto components = static_cast<std::size_t>(volume.components);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (volume.active[i].none() && volume.kind != SparseVolume::Kind::level_set) continue;
    const auto corner = leaves.corner(i);
    auto leaf = std::make_unique<Leaf>(openvdb::Coord(corner[0], corner[1], corner[2]), Value(volume.background));
    const float* values = volume.values.data() + i * components * kVoxels;
    for (std::size_t v = 0; v < kVoxels; ++v) {
      const auto at = static_cast<openvdb::Index>(v);
      Value number;
      if constexpr (std::is_same_v<Value, float>) {
        number = values[v];
      } else {
        number = Value(values[v], values[kVoxels + v], values[2 * kVoxels + v]);
      }
      if (volume.active[i].test(v)) {
        leaf->setValueOn(at, number);
      } else {
        leaf->setValueOff(at, number);
      }
    }
    grid->tree().addLeaf(leaf.release());
  }
  return grid;
}

openvdb::GridBase::Ptr make_grid(const LeafSet& leaves, const SparseVolume& volume) {
  openvdb::GridBase::Ptr base;
  if (volume.components == 3) {
    auto grid = make_grid<openvdb::Vec3SGrid>(leaves, volume);
    if (volume.kind == SparseVolume::Kind::vectors) grid->setVectorType(openvdb::VEC_CONTRAVARIANT_RELATIVE);
    base = grid;
  } else {
    auto grid = make_grid<openvdb::FloatGrid>(leaves, volume);
    const bool is_level_set = volume.kind == SparseVolume::Kind::level_set;
    if (is_level_set) openvdb::tools::signedFloodFill(grid->tree());
    grid->setGridClass(is_level_set ? openvdb::GRID_LEVEL_SET : openvdb::GRID_FOG_VOLUME);
    base = grid;
  }
  base->setName(volume.name);
  base->setTransform(openvdb::math::Transform::createLinearTransform(leaves.voxel));
  return base;
}

/// OpenVDB gives each file a random number, behind the magic word, the versions and a flag. A file of the same content
/// shall be the same.
void replace_random_name(std::string& bytes) {
  constexpr std::size_t kAt = 8 + 4 + 4 + 4 + 1, kLength = 36;
  const bool is_name = bytes.size() > kAt + kLength && bytes[kAt + 8] == '-' && bytes[kAt + 13] == '-' &&
                       bytes[kAt + 18] == '-' && bytes[kAt + 23] == '-';
  if (!is_name) return;
  bytes.replace(kAt, kLength, kLength, '0');
  // FNV-1a; that two files differ is all that it has to tell.
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  bytes.replace(kAt, kLength,
                fmt::format("{:08x}-{:04x}-4{:03x}-8{:03x}-{:012x}", hash >> 32, hash >> 16 & 0xffff, hash & 0xfff,
                            hash >> 12 & 0xfff, hash >> 16));
}

/// Into memory and not into a file: io::File does not notice a disk that is full.
class MemoryArchive : public openvdb::io::Archive {
 public:
  std::string bytes(const openvdb::GridCPtrVec& grids, const openvdb::MetaMap& metadata) const {
    std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
    stream.exceptions(std::ios::badbit | std::ios::failbit);
    write(stream, grids, true, metadata);
    return std::move(stream).str();
  }
};

}  // namespace

std::string vdb_bytes(const LeafSet& leaves, const std::vector<SparseVolume>& volumes,
                      const std::map<std::string, std::string>& metadata) {
  static std::once_flag once;
  std::call_once(once, [] { openvdb::initialize(); });
  openvdb::GridCPtrVec grids;
  for (const SparseVolume& volume : volumes) grids.push_back(make_grid(leaves, volume));
  openvdb::MetaMap meta;
  for (const auto& [key, text] : metadata) meta.insertMeta(key, openvdb::StringMetadata(text));
  std::string bytes = MemoryArchive().bytes(grids, meta);
  replace_random_name(bytes);
  return bytes;
}

}  // namespace firn
