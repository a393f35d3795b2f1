#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/io/atomic_file.h>
#include <firn/io/level_set_file.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>

namespace firn {
namespace {

/// To be changed with the layout of the file or with the meaning of its numbers.
constexpr char kMagic[8] = {'f', 'i', 'r', 'n', 'l', 's', '0', '1'};

struct Header {
  char magic[8];
  std::uint64_t hash;  ///< of what follows the header
  Vec3d lower, mesh_lower, mesh_upper;
  double cell;
  std::int32_t blocks[4];
  std::uint64_t fine_blocks, nodes;
};

std::string file_name(const TriangleMesh& mesh, double cell) {
  XXH64_state_t* state = XXH64_createState();
  XXH64_reset(state, 1);
  XXH64_update(state, &cell, sizeof(cell));
  XXH64_update(state, mesh.vertices.data(), mesh.vertices.size() * sizeof(Vec3d));
  XXH64_update(state, mesh.triangles.data(), mesh.triangles.size() * sizeof(mesh.triangles[0]));
  const std::uint64_t hash = XXH64_digest(state);
  XXH64_freeState(state);
  return fmt::format("{:016x}-{}.levelset", hash, mesh.triangles.size());
}

std::string encoded(const LevelSet::Data& data) {
  std::string body;
  const auto append = [&](const auto& list) {
    body.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(list[0]));
  };
  append(data.center);
  append(data.fine);
  append(data.nodes);
  Header header = {};
  std::memcpy(header.magic, kMagic, sizeof(kMagic));
  header.hash = XXH64(body.data(), body.size(), 0);
  header.lower = data.lower;
  header.mesh_lower = data.mesh_lower;
  header.mesh_upper = data.mesh_upper;
  header.cell = data.cell;
  std::copy_n(data.blocks, 3, header.blocks);
  header.fine_blocks = data.fine.size();
  header.nodes = data.nodes.size();
  return std::string(reinterpret_cast<const char*>(&header), sizeof(header)) + body;
}

/// Nothing if the file is missing, damaged or of another version.
std::optional<LevelSet::Data> read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  Header header;
  if (bytes.size() < sizeof(header)) return std::nullopt;
  std::memcpy(&header, bytes.data(), sizeof(header));
  const std::size_t body = bytes.size() - sizeof(header);
  if (std::memcmp(header.magic, kMagic, sizeof(kMagic)) != 0 || header.fine_blocks > body || header.nodes > body ||
      body != 8 * header.fine_blocks + 4 * header.nodes ||
      XXH64(bytes.data() + sizeof(header), body, 0) != header.hash) {
    return std::nullopt;
  }
  LevelSet::Data data;
  data.lower = header.lower;
  data.mesh_lower = header.mesh_lower;
  data.mesh_upper = header.mesh_upper;
  data.cell = header.cell;
  std::copy_n(header.blocks, 3, data.blocks);
  const char* at = bytes.data() + sizeof(header);
  const auto take = [&](auto& list, std::size_t count) {
    list.resize(count);
    std::memcpy(list.data(), at, count * sizeof(list[0]));
    at += count * sizeof(list[0]);
  };
  take(data.center, header.fine_blocks);
  take(data.fine, header.fine_blocks);
  take(data.nodes, header.nodes);
  if (!LevelSet::is_consistent(data)) return std::nullopt;
  return data;
}

}  // namespace

std::filesystem::path cache_folder() {
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != 0) {
    return std::filesystem::path(cache) / "firn";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != 0) {
    return std::filesystem::path(home) / ".cache" / "firn";
  }
  return {};
}

std::shared_ptr<const LevelSet> cached_level_set(const TriangleMesh& mesh, double cell,
                                                 const std::filesystem::path& cache) {
  if (cache.empty()) return std::make_shared<LevelSet>(mesh, cell);
  const std::filesystem::path path = cache / file_name(mesh, cell);
  if (auto data = read_file(path)) return std::make_shared<LevelSet>(std::move(*data));
  auto made = std::make_shared<LevelSet>(mesh, cell);
  try {
    std::error_code ignored;
    std::filesystem::create_directories(cache, ignored);
    write_file_atomically(path, encoded(made->data()));
  } catch (const Error& error) {
    log_warning(fmt::format("a level set is not kept for the next run: {}", error.what()));
  }
  return made;
}

}  // namespace firn
