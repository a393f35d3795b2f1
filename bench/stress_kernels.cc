// Nanoseconds per matrix of the decompositions, and per particle of each material's stress update, for data in the
// first-level cache and one thread. The least of many repetitions: other work on the machine only ever adds.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stress_kernels.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h.
#include <firn/core/svd-inl.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace firn {
namespace HWY_NAMESPACE {

// Matrices are read by entry (9 columns of `count` numbers); results are written as columns too.

template <class Real>
HWY_INLINE Mat<Lanes<Real>, 3> load_matrix(const Real* A, std::size_t count, std::size_t p) {
  Mat<Lanes<Real>, 3> a;
  for (std::size_t e = 0; e < 9; ++e) a.e[e] = load_lanes(A + e * count + p);
  return a;
}

template <class Real>
HWY_INLINE void store_columns(const Lanes<Real>* values, std::size_t columns, Real* to, std::size_t count,
                              std::size_t p) {
  for (std::size_t e = 0; e < columns; ++e) store_lanes(values[e], to + e * count + p, Lanes<Real>::kCount);
}

template <class Real>
void svd_kernel(const Real* A, std::size_t count, Real* out) {
  for (std::size_t p = 0; p < count; p += Lanes<Real>::kCount) {
    const Svd<Lanes<Real>, 3> s = svd(load_matrix(A, count, p));
    store_columns(s.U.e, 9, out, count, p);
    store_columns(s.V.e, 9, out + 9 * count, count, p);
    store_columns(s.sigma.e, 3, out + 18 * count, count, p);
  }
}

template <class Real>
void polar_kernel(const Real* A, std::size_t count, Real* out) {
  for (std::size_t p = 0; p < count; p += Lanes<Real>::kCount) {
    const Polar<Lanes<Real>, 3> decomposition = polar(load_matrix(A, count, p));
    store_columns(decomposition.R.e, 9, out, count, p);
    store_columns(decomposition.S.e, 9, out + 9 * count, count, p);
  }
}

void svd_float(const float* A, std::size_t count, float* out) { svd_kernel(A, count, out); }
void svd_double(const double* A, std::size_t count, double* out) { svd_kernel(A, count, out); }
void polar_float(const float* A, std::size_t count, float* out) { polar_kernel(A, count, out); }
void polar_double(const double* A, std::size_t count, double* out) { polar_kernel(A, count, out); }

}  // namespace HWY_NAMESPACE
}  // namespace firn
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <firn/core/simd.h>
#include <firn/materials/model_info.h>
#include <firn/materials/update_stress.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace firn {
namespace {

HWY_EXPORT(svd_float);
HWY_EXPORT(svd_double);
HWY_EXPORT(polar_float);
HWY_EXPORT(polar_double);

void run_svd(const float* A, std::size_t count, float* out) { FIRN_DISPATCH(svd_float)(A, count, out); }
void run_svd(const double* A, std::size_t count, double* out) { FIRN_DISPATCH(svd_double)(A, count, out); }
void run_polar(const float* A, std::size_t count, float* out) { FIRN_DISPATCH(polar_float)(A, count, out); }
void run_polar(const double* A, std::size_t count, double* out) { FIRN_DISPATCH(polar_double)(A, count, out); }

constexpr std::size_t kCount = 144;  // whole vectors, and no two columns at the same place of a page
constexpr int kRepeats = 200, kCallsPerRepeat = 400;

/// In [-1, 1).
double random_number(std::uint64_t& state) {
  state = state * 6364136223846793005u + 1442695040888963407u;
  return static_cast<double>(state >> 11) * 0x1p-52 - 1;
}

/// Identity plus random entries of the given size, by entry.
template <class Real>
std::vector<Real> matrices(double size) {
  std::vector<Real> A(9 * kCount);
  std::uint64_t state = 1;
  for (std::size_t e = 0; e < 9; ++e) {
    for (std::size_t p = 0; p < kCount; ++p) {
      A[e * kCount + p] = static_cast<Real>((e % 4 == 0 ? 1 : 0) + size * random_number(state));
    }
  }
  return A;
}

/// Least time per element over the repetitions, ns.
template <class Work>
double nanoseconds(const Work& work) {
  using Clock = std::chrono::steady_clock;
  double best = 1e30;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    const auto start = Clock::now();
    for (int call = 0; call < kCallsPerRepeat; ++call) work();
    const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
    best = std::min(best, elapsed.count() / (kCallsPerRepeat * static_cast<double>(kCount)));
  }
  return best;
}

template <class Real>
double decomposition_time(void (*decompose)(const Real*, std::size_t, Real*), double size) {
  const std::vector<Real> A = matrices<Real>(size);
  std::vector<Real> out(21 * kCount);
  return nanoseconds([&] { decompose(A.data(), kCount, out.data()); });
}

ModelParameters default_parameters(const ModelInfo& info) {
  ModelParameters parameters;
  for (const Parameter& p : info.parameters) parameters.values.push_back(p.default_value);
  return parameters;
}

/// Time of the model's update at strains I + random entries of the given size. The time step is zero, so that the state
/// stays what it is; the operations are those of any other step.
template <class Real>
double update_time(int model, double size) {
  const ModelInfo& info = all_models()[static_cast<std::size_t>(model)];
  const ModelParameters parameters = default_parameters(info);
  std::vector<Real> strain = matrices<Real>(size), grad_v = matrices<Real>(size);
  std::vector<Real> history(kMaxHistoryColumns * kCount, Real(1)), stress(6 * kCount);
  MaterialColumns<Real, 3> columns = {};
  for (std::size_t e = 0; e < 9; ++e) {
    columns.grad_v[e] = &grad_v[e * kCount];
    columns.strain[e] = &strain[e * kCount];
  }
  for (std::size_t h = 0; h < kMaxHistoryColumns; ++h) columns.history[h] = &history[h * kCount];
  for (std::size_t s = 0; s < 6; ++s) columns.stress[s] = &stress[s * kCount];
  const auto update = update_stress_function<Real, 3>(model);
  return nanoseconds([&] { update(parameters, columns, 0, kCount, Real(0)); });
}

template <class Real>
void print_times(const char* precision, double fresh, double deformed) {
  const auto print = [&](const std::string& what, double of_fresh, double of_deformed) {
    std::printf("%-24s %-8s %8.2f %8.2f\n", what.c_str(), precision, of_fresh, of_deformed);
  };
  print("svd", decomposition_time<Real>(run_svd, fresh), decomposition_time<Real>(run_svd, deformed));
  print("polar", decomposition_time<Real>(run_polar, fresh), decomposition_time<Real>(run_polar, deformed));
  for (int model = 0; model < static_cast<int>(all_models().size()); ++model) {
    print("update " + std::string(all_models()[static_cast<std::size_t>(model)].name), update_time<Real>(model, fresh),
          update_time<Real>(model, deformed));
  }
}

}  // namespace
}  // namespace firn

int main() {
  std::printf("SIMD target %s; ns per matrix or particle, data in cache\n", firn::simd_target().c_str());
  std::printf("%-24s %-8s %8s %8s\n", "", "", "fresh", "deformed");
  firn::print_times<float>("single", 1e-3, 0.3);
  firn::print_times<double>("double", 1e-3, 0.3);
}
#endif  // HWY_ONCE
