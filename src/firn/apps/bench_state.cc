#include <firn/apps/bench_scene.h>
#include <firn/apps/bench_state.h>
#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <memory>
#include <type_traits>
#include <vector>

namespace firn {
namespace {

constexpr std::array<char, 8> kMagic = {'F', 'I', 'R', 'N', 'B', 'N', 'C', 'H'};
constexpr std::size_t kMostText = 1 << 16;

struct Header {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kBenchStateVersion, text_length = 0;
  std::uint64_t particles = 0, file_length = 0;
  double rest_volume = 0;  ///< of each particle
  Landing landing;
};
static_assert(std::is_trivially_copyable_v<Header>);

class Checksum {
 public:
  Checksum() : state_(XXH64_createState()) { XXH64_reset(state_.get(), 0); }
  void add(const void* bytes, std::size_t count) { XXH64_update(state_.get(), bytes, count); }
  std::uint64_t value() const { return XXH64_digest(state_.get()); }

 private:
  struct Free {
    void operator()(XXH64_state_t* state) const { XXH64_freeState(state); }
  };
  std::unique_ptr<XXH64_state_t, Free> state_;
};

/// Writes and reads through the same calls, so that the order of columns stands in one place.
class StateWriter {
 public:
  explicit StateWriter(const std::filesystem::path& path) : file_(path, std::ios::binary) {}

  void bytes(const void* from, std::size_t count) {
    sum_.add(from, count);
    file_.write(static_cast<const char*>(from), static_cast<std::streamsize>(count));
  }
  bool finish() {
    const std::uint64_t sum = sum_.value();
    file_.write(reinterpret_cast<const char*>(&sum), sizeof(sum));
    file_.close();
    return !file_.fail();
  }

 private:
  std::ofstream file_;
  Checksum sum_;
};

class StateReader {
 public:
  explicit StateReader(const std::filesystem::path& path) : file_(path, std::ios::binary) {}

  /// False where the file ends before.
  bool bytes(void* to, std::size_t count) {
    if (!file_.read(static_cast<char*>(to), static_cast<std::streamsize>(count))) return false;
    sum_.add(to, count);
    return true;
  }
  /// Whether the checksum comes next, and nothing after it.
  bool finish() {
    std::uint64_t sum = 0;
    return file_.read(reinterpret_cast<char*>(&sum), sizeof(sum)) && sum == sum_.value() &&
           file_.peek() == std::ifstream::traits_type::eof();
  }

 private:
  std::ifstream file_;
  Checksum sum_;
};

/// Columns that a step reads and that do not follow from others.
template <int dim>
constexpr std::array<std::pair<Field, int>, 4> kStateFields = {
    {{Field::offset, dim}, {Field::velocity, dim}, {Field::affine, dim* dim}, {Field::strain, dim* dim}}};

/// Calls visit(column) for each column but the cells; column[p] reads and writes particle p.
template <int dim, class Particles, class Visit>
void for_each_column(Particles& particles, const Visit& visit) {
  for (const auto& [field, components] : kStateFields<dim>) {
    for (int c = 0; c < components; ++c) visit(particles.real(field, c));
  }
  for (int h = 0; h < particles.history_count(); ++h) visit(particles.history(h));
  visit(particles.id());
}

template <class Column>
using ColumnValue = std::remove_cvref_t<decltype(std::declval<Column>()[0] + 0)>;

/// Particles of a slab: a sixteenth, because each one that is read is one growth of the particles' memory.
std::size_t slab_size(std::size_t particles) { return std::max<std::size_t>(1 << 16, (particles + 15) / 16); }

template <class Real, int dim>
std::uint64_t state_length(const Particles<Real, dim>& particles, std::size_t text_length) {
  std::uint64_t each = dim * sizeof(std::int32_t);
  for_each_column<dim>(particles, [&](auto column) { each += sizeof(ColumnValue<decltype(column)>); });
  return sizeof(Header) + text_length + each * particles.size() + sizeof(std::uint64_t);
}

/// Header and text, if they are what a file of this version begins with.
bool read_header(StateReader& reader, Header& header, std::string& text) {
  if (!reader.bytes(&header, sizeof(header)) || header.magic != kMagic || header.version != kBenchStateVersion ||
      header.text_length > kMostText) {
    return false;
  }
  text.resize(header.text_length);
  return reader.bytes(text.data(), text.size());
}

[[noreturn]] void fail(const std::filesystem::path& path, const char* what) {
  throw Error(
      ErrorKind::files,
      fmt::format("{}: {}; choose another cache folder with XDG_CACHE_HOME or free some space", path.string(), what));
}

}  // namespace

template <class Real, int dim>
void write_bench_state(const std::filesystem::path& path, const World<Real, dim>& world, const std::string& settings,
                       const Landing& landing) {
  const auto& particles = world.materials.front().particles;
  AtomicFile file(path);
  StateWriter writer(file.part_path());
  Header header;
  header.text_length = static_cast<std::uint32_t>(settings.size());
  header.particles = particles.size();
  header.rest_volume = static_cast<double>(particles.rest_volume(0));
  header.file_length = state_length(particles, settings.size());
  header.landing = landing;
  writer.bytes(&header, sizeof(header));
  writer.bytes(settings.data(), settings.size());
  const std::size_t slab = slab_size(particles.size());
  std::vector<std::int32_t> cells;
  for (std::size_t first = 0; first < particles.size(); first += slab) {
    const std::size_t count = std::min(slab, particles.size() - first);
    cells.clear();
    for (std::size_t p = first; p < first + count; ++p) {
      for (const std::int64_t c : cell_of(world, p)) cells.push_back(static_cast<std::int32_t>(c));
    }
    writer.bytes(cells.data(), cells.size() * sizeof(cells[0]));
    for_each_column<dim>(particles, [&](auto column) {
      std::vector<ColumnValue<decltype(column)>> values(count);
      for (std::size_t i = 0; i < count; ++i) values[i] = column[first + i];
      writer.bytes(values.data(), count * sizeof(values[0]));
    });
  }
  if (!writer.finish()) fail(path, "cannot write the landed state");
  file.commit();
}

std::optional<Landing> check_bench_state(const std::filesystem::path& path, const std::string& settings) {
  std::error_code error;
  const auto length = std::filesystem::file_size(path, error);
  if (error) return std::nullopt;
  StateReader reader(path);
  Header header;
  std::string text;
  if (!read_header(reader, header, text) || text != settings || header.file_length != length) return std::nullopt;
  const std::size_t begin = sizeof(header) + text.size();
  if (length < begin + sizeof(std::uint64_t)) return std::nullopt;
  std::vector<char> buffer(1 << 20);
  for (std::size_t left = length - begin - sizeof(std::uint64_t); left > 0;) {
    const std::size_t count = std::min(left, buffer.size());
    if (!reader.bytes(buffer.data(), count)) return std::nullopt;
    left -= count;
  }
  return reader.finish() ? std::optional(header.landing) : std::nullopt;
}

template <class Real, int dim>
void read_bench_state(const std::filesystem::path& path, World<Real, dim>& world) {
  StateReader reader(path);
  Header header;
  std::string text;
  const auto require = [&](bool good) {
    if (!good) fail(path, "the landed state changed while it was read");
  };
  require(read_header(reader, header, text));
  auto& particles = world.materials.front().particles;
  const double dx = world.grid.dx(), inside = cell_offset(world.grid.kernel()) + 0.5;
  const std::size_t slab = slab_size(header.particles);
  std::vector<std::int32_t> cells;
  std::vector<Vec<double, dim>> positions;
  for (std::size_t first = 0; first < header.particles; first += slab) {
    const std::size_t count = std::min<std::size_t>(slab, header.particles - first);
    cells.resize(count * dim);
    require(reader.bytes(cells.data(), cells.size() * sizeof(cells[0])));
    // The middle of the cell decides it without rounding; the offset column says where in it.
    positions.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (int d = 0; d < dim; ++d) positions[i][d] = dx * (cells[i * dim + static_cast<std::size_t>(d)] + inside);
    }
    particles.append(positions, dx, world.grid.kernel(), world.grid.period(), header.rest_volume, 0, 0);
    for_each_column<dim>(particles, [&](auto column) {
      std::vector<ColumnValue<decltype(column)>> values(count);
      require(reader.bytes(values.data(), count * sizeof(values[0])));
      for (std::size_t i = 0; i < count; ++i) column[first + i] = values[i];
    });
  }
  require(reader.finish());
  require(!prepare(world).failure);
}

#define FIRN_INSTANTIATE(Real, dim)                                                                 \
  template void write_bench_state<Real, dim>(const std::filesystem::path&, const World<Real, dim>&, \
                                             const std::string&, const Landing&);                   \
  template void read_bench_state<Real, dim>(const std::filesystem::path&, World<Real, dim>&);
FIRN_INSTANTIATE(float, 2)
FIRN_INSTANTIATE(float, 3)
FIRN_INSTANTIATE(double, 2)
FIRN_INSTANTIATE(double, 3)
#undef FIRN_INSTANTIATE

}  // namespace firn
