#include <firn/render/density_field.h>

#include <algorithm>
#include <cmath>

namespace firn {

namespace {

/// 64 MiB. A box of particles needs 1/8 node per particle; only runaway particles make it grow.
constexpr double kMaxNodes = 16.0 * 1024 * 1024;

}  // namespace

DensityField::DensityField(const std::vector<Vec3f>& centers, float spacing) : step_(2 * spacing) {
  if (centers.empty() || !(spacing > 0)) return;
  choose_box(centers);
  nodes_.assign(
      static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(size_[2]),
      0.0F);
  const float share = std::pow(spacing / step_, 3.0F);
  for (const Vec3f& x : centers) {
    Stencil s;
    if (!locate(x, &s)) continue;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        float* row = &nodes_[index(s.base[0], s.base[1] + j, s.base[2] + k)];
        const float weight = share * s.weight[2][k] * s.weight[1][j];
        for (int i = 0; i < 3; ++i) row[i] += weight * s.weight[0][i];
      }
    }
  }
}

void DensityField::choose_box(const std::vector<Vec3f>& centers) {
  // Shrink the box towards the quantiles until it fits; runaway particles are few and drop out first.
  for (const double outliers : {0.0, 0.001, 0.01, 0.05, 0.2, 0.4}) {
    double count = 1;
    for (int a = 0; a < 3; ++a) {
      std::vector<float> values;
      values.reserve(centers.size());
      for (const Vec3f& x : centers) values.push_back(x[a]);
      const auto skip = static_cast<std::ptrdiff_t>(outliers * static_cast<double>(values.size() - 1));
      std::nth_element(values.begin(), values.begin() + skip, values.end());
      const float low = values[static_cast<std::size_t>(skip)];
      std::nth_element(values.begin(), values.end() - 1 - skip, values.end());
      const float high = values[values.size() - 1 - static_cast<std::size_t>(skip)];
      origin_[a] = low - 2 * step_;
      const double nodes = std::ceil(static_cast<double>(high - low) / static_cast<double>(step_)) + 5;
      count *= nodes;
      size_[a] = static_cast<int>(std::min(nodes, 1e6));
    }
    if (count <= kMaxNodes) return;
  }
  std::fill(size_, size_ + 3, 3);  // particles strewn over all space: none is dense
}

bool DensityField::locate(const Vec3f& x, Stencil* s) const {
  for (int a = 0; a < 3; ++a) {
    const float u = (x[a] - origin_[a]) / step_;
    if (!(u >= 0.5F) || !(u < static_cast<float>(size_[a]) - 1.5F)) return false;
    s->base[a] = static_cast<int>(u - 0.5F);
    const float f = u - static_cast<float>(s->base[a]);  // in [0.5, 1.5]
    s->weight[a][0] = 0.5F * (1.5F - f) * (1.5F - f);
    s->weight[a][1] = 0.75F - (f - 1) * (f - 1);
    s->weight[a][2] = 0.5F * (f - 0.5F) * (f - 0.5F);
    s->slope[a][0] = (f - 1.5F) / step_;
    s->slope[a][1] = -2 * (f - 1) / step_;
    s->slope[a][2] = (f - 0.5F) / step_;
  }
  return true;
}

DensityField::Sample DensityField::sample(const Vec3f& x) const {
  Sample result;
  Stencil s;
  if (nodes_.empty() || !locate(x, &s)) return result;
  for (int k = 0; k < 3; ++k) {
    for (int j = 0; j < 3; ++j) {
      const float* row = &nodes_[index(s.base[0], s.base[1] + j, s.base[2] + k)];
      const float value = s.weight[0][0] * row[0] + s.weight[0][1] * row[1] + s.weight[0][2] * row[2];
      const float slope = s.slope[0][0] * row[0] + s.slope[0][1] * row[1] + s.slope[0][2] * row[2];
      result.density += s.weight[2][k] * s.weight[1][j] * value;
      result.gradient[0] += s.weight[2][k] * s.weight[1][j] * slope;
      result.gradient[1] += s.weight[2][k] * s.slope[1][j] * value;
      result.gradient[2] += s.slope[2][k] * s.weight[1][j] * value;
    }
  }
  return result;
}

}  // namespace firn
