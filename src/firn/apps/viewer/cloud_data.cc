#include <firn/apps/viewer/cloud_data.h>
#include <firn/render/color_map.h>

#include <cmath>
#include <cstring>
#include <type_traits>
#include <vector>

namespace firn {
namespace {

constexpr std::size_t kRangeSamples = 4096;

/// Twelve numbers are four particles and, for the compiler, whole vectors without a remainder.
template <class T>
void write_shifted(const std::vector<T>& x, const Vec3d& origin, float* to) {
  constexpr std::size_t kBlock = 12;
  T shift[kBlock];
  for (std::size_t k = 0; k < kBlock; ++k) shift[k] = static_cast<T>(origin[static_cast<int>(k % 3)]);
  const std::size_t whole = x.size() / kBlock * kBlock;
  const T* from = x.data();
  for (std::size_t i = 0; i < whole; i += kBlock) {
    for (std::size_t k = 0; k < kBlock; ++k) to[i + k] = static_cast<float>(from[i + k] - shift[k]);
  }
  for (std::size_t i = whole; i < x.size(); ++i) to[i] = static_cast<float>(from[i] - shift[i % 3]);
}

/// In single precision, whose roots take a fraction of the time; that squares vanish below 1e-38 is not seen in
/// colours.
template <class T>
void write_magnitudes(const std::vector<T>& x, std::size_t components, float* to) {
  const T* from = x.data();
  const std::size_t count = x.size() / components;
  if (components == 3) {
    for (std::size_t p = 0; p < count; ++p) {
      const auto a = static_cast<float>(from[3 * p]), b = static_cast<float>(from[3 * p + 1]),
                 c = static_cast<float>(from[3 * p + 2]);
      to[p] = std::sqrt(a * a + b * b + c * c);
    }
    return;
  }
  for (std::size_t p = 0; p < count; ++p) {
    float sum = 0;
    for (std::size_t c = 0; c < components; ++c) {
      const auto v = static_cast<float>(from[p * components + c]);
      sum += v * v;
    }
    to[p] = std::sqrt(sum);
  }
}

/// What is coloured by at every so many particles.
std::vector<double> sampled_values(const SnapshotColumn& column, std::size_t particles, std::size_t every) {
  const auto components = static_cast<std::size_t>(column.components);
  std::vector<double> sample;
  sample.reserve(particles / every + 1);
  std::visit(
      [&](const auto& values) {
        for (std::size_t p = 0; p < particles; p += every) {
          double sum = 0;
          for (std::size_t c = 0; c < components; ++c) {
            const auto v = static_cast<double>(values[p * components + c]);
            sum += v * v;
          }
          sample.push_back(components == 1 ? static_cast<double>(values[p]) : std::sqrt(sum));
        }
      },
      column.values);
  return sample;
}

}  // namespace

void write_positions(const Snapshot& snapshot, const Vec3d& origin, float* to) {
  std::visit([&](const auto& x) { write_shifted(x, origin, to); }, snapshot.columns.front().values);
}

void write_values(const SnapshotColumn& column, float* to) {
  std::visit(
      [&](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        if (column.components > 1) {
          write_magnitudes(values, static_cast<std::size_t>(column.components), to);
        } else if constexpr (std::is_same_v<T, float>) {
          if (!values.empty()) std::memcpy(to, values.data(), values.size() * sizeof(float));
        } else {
          for (std::size_t p = 0; p < values.size(); ++p) to[p] = static_cast<float>(values[p]);
        }
      },
      column.values);
}

std::array<double, 2> sampled_color_range(const SnapshotColumn& column, std::size_t particles) {
  if (particles <= kRangeSamples) return automatic_color_range(column, particles);
  const std::size_t every = particles / kRangeSamples + 1;
  SnapshotColumn sample;
  sample.values = sampled_values(column, particles, every);
  return automatic_color_range(sample, (particles + every - 1) / every);
}

}  // namespace firn
