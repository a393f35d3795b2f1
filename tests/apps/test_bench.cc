#include <firn/apps/bench_case.h>
#include <firn/apps/bench_landing.h>
#include <firn/apps/bench_process.h>
#include <firn/apps/bench_scene.h>
#include <firn/apps/bench_state.h>
#include <firn/apps/bench_targets.h>
#include <firn/core/error.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/run_program.h"
#include "support/temporary_folder.h"

namespace firn::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& [key, value] : object.items()) keys.push_back(key);
  return keys;
}

std::string bytes_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

BenchCase with(auto key, auto value, BenchCase bench = {}) {
  bench.*key = value;
  return bench;
}

/// A folder for landed states and tables.
class BenchTest : public testing::Test {
 protected:
  ProgramResult bench(const std::string& arguments) const {
    return run_firn("bench --steps 2 --threads 1 " + arguments, "XDG_CACHE_HOME='" + folder_.string() + "'");
  }
  std::vector<fs::path> states() const {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder_ / "firn" / "bench")) files.push_back(entry.path());
    return files;
  }

  const TemporaryFolder temporary_;
  const fs::path folder_ = temporary_.path();
};

TEST(BenchTargets, ScaleWithTheMeasuredRateAndHoldForTheMainCaseOnly) {
  const BenchCase main;
  EXPECT_DOUBLE_EQ(rate_target(main, "avx512", 60).value(), 15e6);
  EXPECT_DOUBLE_EQ(rate_target(main, "avx2", 90).value(), 9e6 * 1.5);
  EXPECT_DOUBLE_EQ(rate_target(with(&BenchCase::material, "fixed_corotated"), "avx512", 60).value(), 10e6);
  EXPECT_DOUBLE_EQ(rate_target(with(&BenchCase::material, "snow"), "avx512", 60).value(), 9e6);
  EXPECT_DOUBLE_EQ(rate_target(with(&BenchCase::material, "snow"), "avx2", 60).value(), 6e6);
  EXPECT_FALSE(rate_target(main, "baseline", 60));
  EXPECT_FALSE(rate_target(with(&BenchCase::threads, 2), "avx2", 60));
  EXPECT_FALSE(rate_target(with(&BenchCase::dimension, 2), "avx2", 60));
  EXPECT_FALSE(rate_target(with(&BenchCase::state, "landed"), "avx2", 60));
  EXPECT_FALSE(rate_target(with(&BenchCase::particles, 8000), "avx2", 60));
}

BenchResult result_of(const BenchCase& bench, double rate, double bytes) {
  BenchResult result;
  result.bench = bench;
  result.median = rate;
  result.bytes_per_particle = bytes;
  return result;
}

TEST(BenchTargets, SharesAreOfTheCaseThatDiffersInOneKey) {
  std::vector<BenchResult> results;
  double rate = 10;
  for (const BenchCase& bench : ratio_cases({"neo_hookean"}, 1000)) {
    results.push_back(result_of(bench, rate, rate));
    rate += 1;
  }
  const auto comparisons = compare(results);
  ASSERT_EQ(comparisons.size(), 9u);
  const std::vector<std::pair<std::string, double>> expected = {{"landed", 1.2}, {"2 threads", 1.1}, {"8 times", 1.8},
                                                                {"double", 1.3}, {"2D", 1.4},        {"linear", 1.5},
                                                                {"cubic", 1.6},  {"FLIP", 1.7}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(comparisons[i].text.substr(0, expected[i].first.size()), expected[i].first);
    EXPECT_DOUBLE_EQ(comparisons[i].reached, expected[i].second);
    EXPECT_EQ(comparisons[i].met(), comparisons[i].reached >= comparisons[i].target);
  }
  EXPECT_FALSE(comparisons[1].met()) << "1.1 of 1.85";
  EXPECT_TRUE(comparisons[8].met()) << "few bytes are good";
  const std::vector<BenchResult> alone = {result_of(with(&BenchCase::precision, "double"), 1, 1)};
  EXPECT_TRUE(compare(alone).empty()) << "nothing to compare with, and the bound on memory is one of single precision";
}

TEST(BenchCases, AreEveryCombinationThatWorks) {
  BenchSelection selection;
  selection.threads = {1, 2};
  const auto cases = cases_of(selection);
  ASSERT_EQ(cases.size(), 12u);
  EXPECT_EQ(cases[0], BenchCase());
  EXPECT_EQ(cases[1], with(&BenchCase::threads, 2));
  EXPECT_EQ(cases[2], with(&BenchCase::state, "landed"));
  EXPECT_EQ(cases[4].material, "fixed_corotated");
  selection.threads = {2, 2};
  selection.kernels = {"linear", "cubic"};
  const auto kernels = cases_of(selection);
  EXPECT_EQ(kernels.size(), 9u) << "linear kernels are fresh only";
  for (const BenchCase& bench : kernels) {
    EXPECT_EQ(bench.form, bench.kernel == "linear" ? "gradient" : "mls");
    EXPECT_EQ(transfer_and_form(bench), "apic");
  }
  EXPECT_EQ(transfer_and_form(with(&BenchCase::form, "gradient")), "apic_gradient");
  selection.kernels = {"linear"};
  selection.forms = {"mls"};
  EXPECT_THROW(cases_of(selection), Error);
}

TEST(BenchLanding, PlasticMaterialHasLandedAtHalfThePeakEnergy) {
  LandingWatch watch(LandingWatch::rule_of("snow"));
  for (const double energy : {1.0, 4.0, 3.0, 2.0}) {
    watch.note({energy, -1});
    EXPECT_FALSE(watch.landed()) << energy;
  }
  watch.note({1.9, -1});
  EXPECT_TRUE(watch.landed());
  EXPECT_EQ(watch.peak_kinetic_energy(), 4);
}

TEST(BenchLanding, ElasticMaterialHasLandedAfterItsFirstRebound) {
  for (const char* material : {"neo_hookean", "fixed_corotated"}) {
    LandingWatch watch(LandingWatch::rule_of(material));
    for (const double momentum : {-2.0, -3.0, -0.1, 0.5, 1.0, 0.2}) {
      watch.note({0.01, momentum});
      EXPECT_FALSE(watch.landed()) << momentum;
    }
    watch.note({0.01, -0.1});
    EXPECT_TRUE(watch.landed());
  }
}

template <class Real, int dim>
World<Real, dim> dropped(const BenchCase& bench) {
  World<Real, dim> world = bench_world<Real, dim>(bench);
  seed_cube(world, bench, kDropStart);
  return world;
}

double least_height(const World<float, 3>& world) {
  const auto& particles = world.materials.front().particles;
  double least = 1e9;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    least = std::min(least, particles.position(p, world.grid.dx(), world.grid.kernel())[kBenchUp]);
  }
  return least;
}

TEST(BenchLanding, LandedWorldsLieOnTheGround) {
  for (const char* material : {"snow", "neo_hookean"}) {
    BenchCase bench = with(&BenchCase::particles, 8000);
    bench.material = material;
    auto world = dropped<float, 3>(bench);
    const double start = motion_of(world).kinetic_energy;
    EXPECT_GT(least_height(world), 0.1) << "not landed before the first step";
    const Landing landing = land(world, 1000);
    EXPECT_GT(landing.steps, 20u);
    EXPECT_GE(landing.peak_kinetic_energy, start);
    EXPECT_EQ(landing.kinetic_energy, motion_of(world).kinetic_energy);
    EXPECT_LT(landing.kinetic_energy, 0.5 * landing.peak_kinetic_energy) << material;
    EXPECT_LT(least_height(world), world.grid.dx()) << material;
  }
  auto late = dropped<float, 3>(with(&BenchCase::particles, 1000));
  EXPECT_THROW(land(late, 8), Error) << "8 steps are not enough to land";
}

template <class Real, int dim>
void expect_equal_worlds(const World<Real, dim>& a, const World<Real, dim>& b) {
  const auto &pa = a.materials.front().particles, &pb = b.materials.front().particles;
  ASSERT_EQ(pa.size(), pb.size());
  for (std::size_t p = 0; p < pa.size(); ++p) {
    ASSERT_EQ(pa.id()[p], pb.id()[p]);
    ASSERT_EQ(cell_of(a, p), cell_of(b, p));
    for (int i = 0; i < dim; ++i) ASSERT_EQ(pa.real(Field::offset, i)[p], pb.real(Field::offset, i)[p]);
    for (int i = 0; i < dim; ++i) ASSERT_EQ(pa.real(Field::velocity, i)[p], pb.real(Field::velocity, i)[p]);
    for (int e = 0; e < dim * dim; ++e) ASSERT_EQ(pa.real(Field::affine, e)[p], pb.real(Field::affine, e)[p]);
    for (int e = 0; e < dim * dim; ++e) ASSERT_EQ(pa.real(Field::strain, e)[p], pb.real(Field::strain, e)[p]);
    for (int h = 0; h < pa.history_count(); ++h) ASSERT_EQ(pa.history(h)[p], pb.history(h)[p]);
    ASSERT_EQ(pa.rest_volume(p), pb.rest_volume(p));
    ASSERT_EQ(pa.body(p), pb.body(p));
  }
}

/// Writes the state of a landed world, reads it into another one and steps both.
template <class Real, int dim>
void expect_same_after_restore(const fs::path& file, BenchCase bench) {
  bench.dimension = dim;
  bench.particles = 1000;
  auto world = dropped<Real, dim>(bench);
  TimeStepLimits limits;
  limits.max_dt = 1e-4;  // binds, so that the speeds which only a step finds out do not matter
  run_steps(world, limits, 200);
  write_bench_state(file, world, "some settings", {7, 2, 1});
  const auto landing = check_bench_state(file, "some settings");
  ASSERT_TRUE(landing);
  EXPECT_EQ(landing->steps, 7u);
  EXPECT_EQ(landing->peak_kinetic_energy, 2);
  auto restored = bench_world<Real, dim>(bench);
  read_bench_state(file, restored);
  run_steps(world, limits, 3);
  run_steps(restored, limits, 3);
  expect_equal_worlds(world, restored);
}

TEST_F(BenchTest, RestoredWorldsGoOnWithTheSameBits) {
  expect_same_after_restore<float, 3>(folder_ / "a", {});
  expect_same_after_restore<double, 2>(folder_ / "b", {});
  expect_same_after_restore<double, 3>(folder_ / "c", with(&BenchCase::kernel, "cubic"));
  expect_same_after_restore<float, 2>(folder_ / "d", with(&BenchCase::form, "gradient"));
}

/// Jp by id.
std::vector<double> history_by_id(const World<float, 3>& world) {
  const auto& particles = world.materials.front().particles;
  std::vector<double> values(particles.size());
  for (std::size_t p = 0; p < particles.size(); ++p) values[particles.id()[p]] = particles.history(0)[p];
  return values;
}

TEST_F(BenchTest, RestoredSnowRemembersHowItWasPacked) {
  const BenchCase bench = with(&BenchCase::particles, 1000, with(&BenchCase::material, "snow"));
  auto world = dropped<float, 3>(bench);
  land(world, 1000);
  write_bench_state(folder_ / "snow", world, "settings", {});
  auto restored = bench_world<float, 3>(bench);
  read_bench_state(folder_ / "snow", restored);
  const std::vector<double> before = history_by_id(world), after = history_by_id(restored);
  double packed = 1;
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_NEAR(after[i], before[i], 1e-5) << "stress of a state at its yield stretch rounds once more";
    packed = std::min(packed, before[i]);
  }
  EXPECT_LT(packed, 0.9) << "there must be something to remember";
}

TEST_F(BenchTest, DamagedStatesAreNotUsed) {
  const fs::path file = folder_ / "state";
  const auto world = dropped<float, 2>(with(&BenchCase::dimension, 2, with(&BenchCase::particles, 1000)));
  write_bench_state(file, world, "settings", {});
  ASSERT_TRUE(check_bench_state(file, "settings"));
  EXPECT_FALSE(check_bench_state(file, "other settings"));
  EXPECT_FALSE(check_bench_state(folder_ / "none", "settings"));
  const std::string good = bytes_of(file);
  for (const std::size_t place : {std::size_t(0), std::size_t(9), good.size() / 2, good.size() - 1}) {
    std::string bad = good;
    bad[place] = static_cast<char>(bad[place] ^ 1);
    std::ofstream(file, std::ios::binary) << bad;
    EXPECT_FALSE(check_bench_state(file, "settings")) << "byte " << place;
  }
  for (const std::size_t length : {std::size_t(0), std::size_t(10), std::size_t(70), good.size() - 1}) {
    std::ofstream(file, std::ios::binary) << good.substr(0, length);
    EXPECT_FALSE(check_bench_state(file, "settings")) << length << " bytes";
  }
  std::ofstream(file, std::ios::binary) << good << "x";
  EXPECT_FALSE(check_bench_state(file, "settings")) << "a byte too many";
  std::ofstream(file, std::ios::binary) << good;
  EXPECT_TRUE(check_bench_state(file, "settings"));
}

TEST(BenchProcess, GivesResultsAndErrorsBack) {
  EXPECT_EQ(in_own_process<int>([] { return 42; }), 42);
  try {
    bytes_from_own_process([]() -> std::string { throw Error(ErrorKind::numerical, "it burst"); });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::numerical);
    EXPECT_STREQ(error.what(), "it burst");
  }
  try {
    bytes_from_own_process([] { return std::to_string(std::raise(SIGKILL)); });
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::resources);
    EXPECT_TRUE(matches(error.what(), ".*killed.*--particles"));
  }
}

TEST_F(BenchTest, JsonHasTheKeysOfTheSchemaAndNoOthers) {
  const ProgramResult result =
      bench("--json --particles 8000 --material snow --state fresh landed --precision double --dimension 2");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const Json document = Json::parse(result.output);
  EXPECT_EQ(keys_of(document), (std::vector<std::string>{"machine", "cases"}));
  const Json& machine = document["machine"];
  EXPECT_EQ(keys_of(machine), (std::vector<std::string>{"cpu", "simd", "fma_gflops_per_core", "copy_gbps_per_core"}));
  EXPECT_GT(machine["fma_gflops_per_core"].get<double>(), 0.1);
  EXPECT_GT(machine["copy_gbps_per_core"].get<double>(), 0.1);
  ASSERT_EQ(document["cases"].size(), 2u);
  for (const Json& one : document["cases"]) {
    EXPECT_EQ(keys_of(one), (std::vector<std::string>{"material", "state", "dimension", "precision", "kernel",
                                                      "transfer", "simd", "threads", "particles",
                                                      "particle_steps_per_second", "bytes_per_particle", "stages"}));
    EXPECT_EQ(one["material"], "snow");
    EXPECT_EQ(one["dimension"], 2);
    EXPECT_EQ(one["precision"], "double");
    EXPECT_EQ(one["kernel"], "quadratic");
    EXPECT_EQ(one["transfer"], "apic");
    EXPECT_EQ(one["simd"], machine["simd"]);
    EXPECT_EQ(one["threads"], 1);
    EXPECT_EQ(one["particles"], 89 * 89);
    const double rate = one["particle_steps_per_second"].get<double>();
    EXPECT_GT(rate, 1e3);
    EXPECT_TRUE(one["bytes_per_particle"].is_null() || one["bytes_per_particle"].get<double>() > 100);
    double nanoseconds = 0;
    for (const auto& [verb, time] : one["stages"].items()) {
      EXPECT_NE(std::find(kVerbNames.begin(), kVerbNames.end(), verb), kVerbNames.end()) << verb;
      nanoseconds += time.get<double>();
    }
    EXPECT_EQ(one["stages"].size(), kVerbNames.size());
    EXPECT_GT(nanoseconds, 1);
  }
  EXPECT_EQ(document["cases"][0]["state"], "fresh");
  EXPECT_EQ(document["cases"][1]["state"], "landed");
}

TEST_F(BenchTest, BadFilterValuesAreRefused) {
  const auto error = [&](const std::string& arguments) {
    const ProgramResult result = bench(arguments);
    EXPECT_EQ(result.exit_code, 2) << arguments;
    EXPECT_EQ(result.output, "") << arguments;
    return result.errors;
  };
  EXPECT_TRUE(matches(error("--material snwo"), "firn: .*no material \"snwo\"; did you mean \"snow\"\\?; .*\n"));
  EXPECT_TRUE(matches(error("--state snow"), "firn: .*no state \"snow\"; known: \"?fresh.*\n"));
  EXPECT_TRUE(matches(error("--precision singel"), "firn: .*\"singel\"; did you mean \"single\"\\?; .*\n"));
  EXPECT_TRUE(matches(error("--dimension 4"), "firn: --dimension: .*4 not in range 2 to 3.*\n"));
  EXPECT_TRUE(matches(error("--threads 0"), "firn: --threads: .*0 not in range 1 to 1024.*\n"));
  EXPECT_TRUE(matches(error("--particles 10"), "firn: --particles: .*10 not in range 1000 to 100000000.*\n"));
  EXPECT_TRUE(matches(error("--kernel linear --form mls"), "firn: nothing to run: .*--form gradient.*\n"));
  EXPECT_TRUE(matches(error("--ratios --state fresh"), "firn: .*excludes.*\n"));
}

TEST_F(BenchTest, LandedStatesAreSimulatedOnce) {
  const std::string arguments = "--particles 1000 --material neo_hookean --state landed";
  const ProgramResult first = bench(arguments);
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_TRUE(matches(first.errors, "firn: simulating [^]*landed after [0-9]+ steps[^]*"));
  EXPECT_TRUE(matches(first.output, "[^]*\nneo_hookean +landed +3 single [^]*"));
  ASSERT_EQ(states().size(), 1u);
  const std::string state = bytes_of(states()[0]);
  EXPECT_EQ(bench(arguments).errors, "") << "the second run uses what the first one kept";
  EXPECT_TRUE(matches(bench(arguments + " --no-cache").errors, "firn: simulating [^]*"));
  EXPECT_TRUE(bytes_of(states()[0]) == state) << "equal settings, equal state";
  std::string damaged = state;
  damaged[state.size() / 3] = static_cast<char>(damaged[state.size() / 3] ^ 1);
  std::ofstream(states()[0], std::ios::binary) << damaged;
  EXPECT_TRUE(matches(bench(arguments).errors, "firn: simulating [^]*"));
  EXPECT_TRUE(bytes_of(states()[0]) == state);
  ASSERT_EQ(bench("--particles 1331 --material neo_hookean --state landed").exit_code, 0);
  EXPECT_EQ(states().size(), 2u) << "other settings, another file";
}

TEST_F(BenchTest, TableTakesOneRowPerCase) {
  const std::string file = (folder_ / "table.csv").string();
  const std::string arguments = "--state fresh --material snow --particles 27000 --csv '" + file + "' --form ";
  ASSERT_EQ(bench(arguments + "mls").exit_code, 0);
  ASSERT_EQ(bench(arguments + "gradient").exit_code, 0);
  std::istringstream table(bytes_of(file));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(table, line);) {
    const std::size_t quote = line.find('"');
    if (quote != line.npos) line.replace(quote, line.find('"', quote + 1) + 1 - quote, "cpu");
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
    rows.push_back(cells);
  }
  ASSERT_EQ(rows.size(), 3u);
  const auto column = [&](const std::string& name) {
    return static_cast<std::size_t>(std::find(rows[0].begin(), rows[0].end(), name) - rows[0].begin());
  };
  for (std::size_t row = 1; row < 3; ++row) {
    ASSERT_EQ(rows[row].size(), rows[0].size());
    EXPECT_TRUE(matches(rows[row][column("date")], "[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9:]{8}Z"));
    EXPECT_EQ(rows[row][column("material")], "snow");
    EXPECT_EQ(rows[row][column("particles")], "27000");
    const double changed = std::stod(rows[row][column("changed_cell")]);
    EXPECT_GT(changed, 0.03) << "particles must cross cells as in a real run";
    EXPECT_LT(changed, 0.05);
    EXPECT_LE(std::stod(rows[row][column("min_particle_steps_per_second")]),
              std::stod(rows[row][column("max_particle_steps_per_second")]));
  }
  EXPECT_EQ(rows[1][column("form")], "mls");
  EXPECT_EQ(rows[2][column("form")], "gradient");

  const fs::path other = folder_ / "other.csv";
  std::ofstream(other) << "name,value\n";
  const ProgramResult refused = bench("--state fresh --particles 1000 --csv '" + other.string() + "'");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_TRUE(matches(refused.errors, "firn: .*other.csv:1: not a table of .*choose another file with --csv\n"));
  EXPECT_EQ(bytes_of(other), "name,value\n");
  EXPECT_EQ(bench("--state fresh --particles 1000 --csv '" + folder_.string() + "/none/x.csv'").exit_code, 3);
}

TEST_F(BenchTest, RatiosRunWhatTheTargetsCompare) {
  const ProgramResult result =
      run_firn("bench --steps 2 --ratios --particles 1000", "XDG_CACHE_HOME='" + folder_.string() + "'");
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  for (const char* text : {"landed / fresh", "2 threads / 1", "8 times the particles", "double / single", "2D / 3D",
                           "linear / quadratic", "cubic / quadratic", "FLIP / APIC"}) {
    EXPECT_NE(result.output.find(text), std::string::npos) << text;
  }
  EXPECT_TRUE(matches(result.output, "[^]*>= +1.85 [^]*"));
}

}  // namespace
}  // namespace firn::test
