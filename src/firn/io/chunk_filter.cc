#include <firn/io/chunk_filter.h>
#include <firn/io/frame_hdf5.h>
#include <zlib.h>

#include <algorithm>

namespace firn::hdf5 {
namespace {

constexpr int kLevel = 1;
/// Bytes of a plane that are tried, and the share that must be saved for it to be worth the time.
constexpr std::size_t kTried = 2048;
constexpr double kWorthwhile = 0.25;

Bytef* bytes_of(std::byte* p) { return reinterpret_cast<Bytef*>(p); }
Bytef* bytes_of(const std::byte* p) { return reinterpret_cast<Bytef*>(const_cast<std::byte*>(p)); }

void require(int status) {
  if (status != Z_OK && status != Z_STREAM_END) throw Failure{"compress a part of the file"};
}

}  // namespace

struct ChunkFilter::Streams {
  z_stream all = {}, trial = {};
};

ChunkFilter::ChunkFilter() : streams_(new Streams) {
  require(deflateInit(&streams_->all, kLevel));
  require(deflateInit(&streams_->trial, kLevel));
}

ChunkFilter::~ChunkFilter() {
  deflateEnd(&streams_->all);
  deflateEnd(&streams_->trial);
}

bool ChunkFilter::is_noise(const std::byte* plane, std::size_t size) {
  const std::size_t tried = std::min(size, kTried);
  z_stream& trial = streams_->trial;
  require(deflateReset(&trial));
  scratch_.resize(deflateBound(&trial, static_cast<uLong>(tried)));
  // From the middle: the first particles of a body may be special.
  trial.next_in = bytes_of(plane + (size - tried) / 2);
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
    const std::byte* begin = shuffled_.data() + i * plane;
    const int level = is_noise(begin, plane) ? 0 : kLevel;
    stream.next_in = bytes_of(begin);
    stream.avail_in = 0;
    require(deflateParams(&stream, level, Z_DEFAULT_STRATEGY));
    stream.avail_in = static_cast<uInt>(plane);
    require(deflate(&stream, i + 1 == element ? Z_FINISH : Z_NO_FLUSH));
  }
  result_.resize(stream.total_out);
}

const std::vector<std::byte>& ChunkFilter::apply(std::span<const std::byte> chunk, std::size_t element) {
  const std::size_t plane = chunk.size() / element;
  shuffled_.resize(chunk.size());
  for (std::size_t i = 0; i < element; ++i) {
    std::byte* to = shuffled_.data() + i * plane;
    const std::byte* from = chunk.data() + i;
    for (std::size_t n = 0; n < plane; ++n) to[n] = from[n * element];
  }
  deflate_planes(element, plane);
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
