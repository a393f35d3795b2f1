#include <firn/io/chunk_filter.h>
#include <firn/io/frame_hdf5.h>
#include <zlib.h>

#include <algorithm>
#include <new>
#include <type_traits>

namespace firn::hdf5 {
namespace {

constexpr int kLevel = 1;
/// Bytes of a plane that are tried, and the share that must be saved for it to be worth the time.
constexpr std::size_t kTried = 1024;
constexpr double kWorthwhile = 0.5;
/// For zlib: memory just large enough for what is tried, as it is cleared each time.
constexpr int kTrialWindow = 12, kTrialMemory = 4;

Bytef* bytes_of(std::byte* p) { return reinterpret_cast<Bytef*>(p); }
Bytef* bytes_of(const std::byte* p) { return reinterpret_cast<Bytef*>(const_cast<std::byte*>(p)); }

void require(int status) {
  if (status == Z_MEM_ERROR) throw std::bad_alloc();
  if (status != Z_OK && status != Z_STREAM_END) throw Failure{"compress a part of the file"};
}

/// Byte i of every element to plane i.
template <class Size>
void split_planes(std::span<const std::byte> chunk, Size element, std::byte* planes) {
  const std::size_t count = chunk.size() / element;
  for (std::size_t i = 0; i < element; ++i, planes += count) {
    for (std::size_t n = 0; n < count; ++n) planes[n] = chunk[n * element + i];
  }
}

/// Sizes that are known when this is compiled let many bytes be moved at once.
void shuffle(std::span<const std::byte> chunk, std::size_t element, std::byte* planes) {
  if (element == 4) return split_planes(chunk, std::integral_constant<std::size_t, 4>(), planes);
  if (element == 8) return split_planes(chunk, std::integral_constant<std::size_t, 8>(), planes);
  split_planes(chunk, element, planes);
}

}  // namespace

struct ChunkFilter::Streams {
  z_stream all = {}, trial = {};
};

ChunkFilter::ChunkFilter() : streams_(new Streams) {
  require(deflateInit(&streams_->all, kLevel));
  require(deflateInit2(&streams_->trial, kLevel, Z_DEFLATED, kTrialWindow, kTrialMemory, Z_DEFAULT_STRATEGY));
}

ChunkFilter::~ChunkFilter() {
  deflateEnd(&streams_->all);
  deflateEnd(&streams_->trial);
}

bool ChunkFilter::is_noise(std::span<const std::byte> plane) {
  const std::size_t tried = std::min(plane.size(), kTried);
  z_stream& trial = streams_->trial;
  require(deflateReset(&trial));
  scratch_.resize(deflateBound(&trial, static_cast<uLong>(tried)));
  // From the middle: the first particles of a body may be special.
  trial.next_in = bytes_of(plane.data() + (plane.size() - tried) / 2);
  trial.avail_in = static_cast<uInt>(tried);
  trial.next_out = bytes_of(scratch_.data());
  trial.avail_out = static_cast<uInt>(scratch_.size());
  require(deflate(&trial, Z_FINISH));
  return static_cast<double>(trial.total_out) > (1 - kWorthwhile) * static_cast<double>(tried);
}

void ChunkFilter::deflate_planes(std::size_t element, std::size_t plane) {
  z_stream& stream = streams_->all;
  require(deflateReset(&stream));
  // Changes of the level end blocks, a few bytes each.
  result_.resize(deflateBound(&stream, static_cast<uLong>(shuffled_.size())) + 64 * element);
  stream.next_out = bytes_of(result_.data());
  stream.avail_out = static_cast<uInt>(result_.size());
  for (std::size_t i = 0; i < element; ++i) {
    const std::span<const std::byte> bytes = std::span(shuffled_).subspan(i * plane, plane);
    const int level = is_noise(bytes) ? 0 : kLevel;
    stream.next_in = bytes_of(bytes.data());
    stream.avail_in = 0;
    require(deflateParams(&stream, level, Z_DEFAULT_STRATEGY));
    stream.avail_in = static_cast<uInt>(plane);
    require(deflate(&stream, i + 1 == element ? Z_FINISH : Z_NO_FLUSH));
  }
  result_.resize(stream.total_out);
}

const std::vector<std::byte>& ChunkFilter::apply(std::span<const std::byte> chunk, std::size_t element) {
  shuffled_.resize(chunk.size());
  shuffle(chunk, element, shuffled_.data());
  deflate_planes(element, chunk.size() / element);
  std::uint32_t sum = fletcher32(result_);
  for (int i = 0; i < 4; ++i, sum >>= 8) result_.push_back(static_cast<std::byte>(sum & 0xff));
  return result_;
}

std::uint32_t fletcher32(std::span<const std::byte> bytes) {
  const auto word = [](std::byte high, std::byte low) {
    return std::to_integer<std::uint32_t>(high) << 8 | std::to_integer<std::uint32_t>(low);
  };
  const auto fold = [](std::uint32_t& sum) { sum = (sum & 0xffff) + (sum >> 16); };
  std::uint32_t first = 0, second = 0;
  std::size_t at = 0;
  while (at + 1 < bytes.size()) {
    // As many as 32 bits hold without a carry.
    const std::size_t end = std::min(bytes.size() - 1, at + 2 * 360);
    for (; at < end; at += 2) {
      first += word(bytes[at], bytes[at + 1]);
      second += first;
    }
    fold(first);
    fold(second);
  }
  if (bytes.size() % 2 != 0) {
    first += word(bytes.back(), std::byte(0));
    second += first;
    fold(first);
    fold(second);
  }
  fold(first);
  fold(second);
  return second << 16 | first;
}

}  // namespace firn::hdf5
