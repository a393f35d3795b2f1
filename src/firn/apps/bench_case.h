#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace firn {

/// What one row of `firn bench` runs. Words are those of the JSON document, of the filters and of scene files.
struct BenchCase {
  std::string material = "neo_hookean";  ///< a model's name
  std::string state = "fresh";
  int dimension = 3;
  std::string precision = "single";
  std::string kernel = "quadratic";
  std::string transfer = "apic";
  std::string form = "mls";
  int threads = 1;
  std::int64_t particles = 1000000;  ///< wanted; a cube holds the nearest power

  bool operator==(const BenchCase&) const = default;
};

/// Names of all models.
std::vector<std::string> bench_materials();
inline const std::vector<std::string> kBenchStates = {"fresh", "landed"};
inline const std::vector<std::string> kBenchPrecisions = {"single", "double"};
inline const std::vector<std::string> kBenchKernels = {"linear", "quadratic", "cubic"};
inline const std::vector<std::string> kBenchTransfers = {"pic", "flip", "pic_flip", "apic"};
inline const std::vector<std::string> kBenchForms = {"mls", "gradient"};

/// Particles along each side of the case's cube.
std::int64_t bench_side(const BenchCase& bench);

/// The form that a kernel is used with unless another is asked for: mls, and for linear kernels, which mls does not
/// work with, gradient.
std::string usual_form(const std::string& kernel);

/// How the material moves between particles and grid, in one word: "apic", and "apic_gradient" for the form that is
/// not the usual one, because two cases of one document must not have the same keys.
std::string transfer_and_form(const BenchCase& bench);

/// For messages: snow, landed, 3D, single, quadratic, apic, mls, 1 thread, 1000000 particles.
std::string describe(const BenchCase& bench);

/// Values of each key to run; every combination is a case. An empty list of forms: the usual one of
/// each kernel; of threads: 1 and as many as there are.
struct BenchSelection {
  std::vector<std::string> materials = {"neo_hookean", "fixed_corotated", "snow"};
  std::vector<std::string> states = kBenchStates;
  std::vector<int> dimensions = {3};
  std::vector<std::string> precisions = {"single"};
  std::vector<std::string> kernels = {"quadratic"};
  std::vector<std::string> transfers = {"apic"};
  std::vector<std::string> forms = {};
  std::vector<int> threads = {};
  std::vector<std::int64_t> particles = {1000000};
};

/// Every combination that works, a repeated one once. Left out: linear kernels with the form mls, and their landed
/// states, because their gradient does not vanish where a node's mass does and what lands tears at its surface.
/// Error(usage) if nothing is left.
std::vector<BenchCase> cases_of(const BenchSelection& selection);

/// The cases behind the targets that are shares of another case's rate, after the one that they are shares of: landed,
/// two threads, and what differs in one key from 3D, single precision, quadratic, APIC.
std::vector<BenchCase> ratio_cases(const std::vector<std::string>& materials, std::int64_t particles);

}  // namespace firn
