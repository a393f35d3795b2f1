// Parameters that differ between particles, in whole simulations.

#include <firn/core/error.h>
#include <firn/integrators/reference_step.h>
#include <firn/integrators/step.h>
#include <firn/integrators/verbs.h>
#include <firn/materials/crack_band.h>
#include <firn/materials/update_stress.h>
#include <firn/measure/totals.h>
#include <firn/scene/build_world.h>
#include <firn/scene/load_scene.h>
#include <firn/simulation/simulation.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace firn {
namespace {

std::string falling_disk(const std::string& stiffness, const std::string& precision = "double") {
  return "dimension = 2\nprecision = \"" + precision +
         "\"\nend_time = 0.1\nframe_rate = 20\nresolution.particles = 600\n[material.stuff]\nmodel = "
         "\"neo_hookean\"\nyoungs_modulus = " +
         stiffness +
         "\n[[body]]\nshape = \"disk\"\nradius = 0.2\nposition = [0, 0.22]\nvelocity = [1, -2]\nangular_velocity = 4\n"
         "material = \"stuff\"\n[[collider]]\nshape = \"half_space\"\ncontact = \"slip\"\n";
}

std::unique_ptr<Simulation> make(const std::string& text) { return Simulation::create(parse_scene(text, "test.toml")); }

std::vector<double> column_of(const Snapshot& snapshot, const char* name) {
  const SnapshotColumn* column = snapshot.find(name);
  EXPECT_NE(column, nullptr) << name;
  std::vector<double> values;
  for (std::size_t p = 0; column != nullptr && p < snapshot.size(); ++p) {
    for (int c = 0; c < column->components; ++c) values.push_back(value(*column, p, c));
  }
  return values;
}

TEST(VariedMaterial, AConstantFormulaMovesParticlesAsANumberDoes) {
  for (const char* precision : {"single", "double"}) {
    const auto number = make(falling_disk("131072", precision)), formula = make(falling_disk("\"2^17\"", precision));
    number->advance_frame();
    formula->advance_frame();
    const Snapshot expected = number->snapshot(), snapshot = formula->snapshot();
    EXPECT_EQ(column_of(snapshot, "position"), column_of(expected, "position"));
    EXPECT_EQ(column_of(snapshot, "pressure"), column_of(expected, "pressure"));
    EXPECT_EQ(formula->totals().elastic_energy, number->totals().elastic_energy);
    EXPECT_EQ(expected.find("youngs_modulus"), nullptr);
    for (const double E : column_of(snapshot, "youngs_modulus")) EXPECT_EQ(E, 131072);
  }
}

TEST(VariedMaterial, ValuesTravelWithTheirParticles) {
  const auto simulation = make(falling_disk("{ value = 1e5, spread = 0.3 }"));
  const std::vector<double> before = column_of(simulation->snapshot(), "youngs_modulus");
  const std::vector<double> start = column_of(simulation->snapshot(), "position");
  simulation->advance_frame();
  simulation->advance_frame();
  EXPECT_EQ(column_of(simulation->snapshot(), "youngs_modulus"), before);
  EXPECT_GT(std::fabs(column_of(simulation->snapshot(), "position")[0] - start[0]), 0.05);
}

TEST(VariedMaterial, TheStiffestParticleSetsTheTimeStep) {
  const double stiff = make(falling_disk("4e5"))->step().dt, soft = make(falling_disk("1e5"))->step().dt;
  EXPECT_EQ(make(falling_disk("\"x > 0 ? 4e5 : 1e5\""))->step().dt, stiff);
  EXPECT_LT(stiff, 0.7 * soft);
}

TEST(VariedMaterial, EnergyIsThatOfEachParticlesOwnValue) {
  auto built = build_world<double, 2>(parse_scene(falling_disk("\"x > 0 ? 4e5 : 1e5\""), "test.toml"));
  auto& material = built.world.materials[0];
  double expected = 0;
  for (std::size_t p = 0; p < material.particles.size(); ++p) {
    const double F[] = {1.2, 0, 0, 0.9}, none[kMaxHistoryColumns] = {};
    for (int e = 0; e < 4; ++e) material.particles.real(Field::strain, e)[p] = F[e];
    ModelParameters own = material.parameters;
    own.values[0] =
        material.particles.position(p, built.world.grid.dx(), built.world.transfer.kernel)[0] > 0 ? 4e5 : 1e5;
    expected += material.particles.rest_volume(p) * energy_density<2>(material.model, own, F, none);
  }
  const MeasureContext<2> context = {built.world.grid.dx(), built.world.transfer.kernel, 1, {}};
  const Totals totals = measure_totals<double, 2>(material.particles, material.model, material.parameters, context);
  EXPECT_NEAR(totals.elastic_energy, expected, 1e-12 * expected);
}

TEST(VariedMaterial, TheStepIsThatOfTheReference) {
  const Scene scene = parse_scene(falling_disk("\"x > 0 ? 4e5 : 1e5\""), "test.toml");
  auto step = build_world<double, 2>(scene), reference = build_world<double, 2>(scene);
  for (auto* built : {&step, &reference}) {
    sort_by_block(built->world);
    // Stretching, each at a rate of its own.
    auto& particles = built->world.materials[0].particles;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      particles.real(Field::affine, 0)[p] = 3 + 0.01 * static_cast<double>(particles.id()[p]);
    }
  }
  for (int n = 0; n < 3; ++n) {
    step_explicit(step.world, 1e-3);
    reference_step(reference.world, 1e-3);
  }
  const auto &a = step.world.materials[0], &b = reference.world.materials[0];
  std::map<std::uint32_t, double> expected;
  for (std::size_t p = 0; p < b.particles.size(); ++p)
    expected[b.particles.id()[p]] = b.particles.real(Field::stress, 0)[p];
  double largest = 0;
  for (std::size_t p = 0; p < a.particles.size(); ++p) {
    const double stress = a.particles.real(Field::stress, 0)[p];
    largest = std::max(largest, std::fabs(stress));
    EXPECT_NEAR(stress, expected.at(a.particles.id()[p]), 1e-7);
  }
  EXPECT_GT(largest, 100);
  EXPECT_NEAR(a.wave_speed, b.wave_speed, 1e-10 * b.wave_speed);
}

constexpr double kE = 1e5, kStrength = 1e3, kFractureEnergy = 5, kHeight = 0.2;

/// Work that cracks have taken from a bar pulled apart by its ends, per area of its cross-section, J/m^2. By the area
/// between the curve of the softening law and the line back to zero; the law itself is tested alone.
double work_of_tearing(double cell_size, double regularised_for) {
  // One place is weaker than all others, else the bar tears twice.
  const double energy = kFractureEnergy * cell_size / regularised_for;
  const std::string text =
      "dimension = 2\nprecision = \"double\"\nend_time = 1\nframe_rate = 1\ngravity = [0, 0]\n"
      "resolution.cell_size = " +
      std::to_string(cell_size) +
      "\n[material.bar]\nmodel = \"rankine_damage\"\nyoungs_modulus = 1e5\npoisson_ratio = 0\n"
      "cracking_stress = \"1000 - 300 * exp(-((x - 0.013) / 0.1)^2)\"\nfracture_energy = " +
      std::to_string(energy) +
      "\n[[body]]\nshape = \"box\"\nsize = [1.2, 0.2]\nfill = \"lattice\"\nmaterial = \"bar\"\n"
      "velocity = [\"0.02 * min(max(x / 0.5, -1), 1)\", 0]\n"
      "[[collider]]\nshape = \"box\"\nsize = [0.2, 1]\nposition = [-0.6, 0]\nvelocity = [-0.02, 0]\ncontact = "
      "\"sticky\"\n"
      "[[collider]]\nshape = \"box\"\nsize = [0.2, 1]\nposition = [0.6, 0]\nvelocity = [0.02, 0]\ncontact = "
      "\"sticky\"\n";
  const auto simulation = make(text);
  simulation->advance_frame();
  const Snapshot snapshot = simulation->snapshot();
  const std::vector<double> damage = column_of(snapshot, "damage"), strength = column_of(snapshot, "cracking_stress");
  double work = 0, most = 0;
  for (std::size_t p = 0; p < damage.size(); ++p) {
    const double opening = opening_strain(strength[p], energy, cell_size), limit = kE * opening;
    const double sound = 1 - damage[p];
    // Stress on the softening line over the strength.
    const double share = sound * limit / (sound * (limit - strength[p]) + strength[p]);
    work += 0.5 * strength[p] * opening * (1 - share) * cell_size * cell_size / 4;
    most = std::max(most, damage[p]);
  }
  EXPECT_EQ(most, 1) << "the bar is torn";
  return work / kHeight;
}

TEST(Fracture, TearingABarTakesTheSameWorkWithCellsOfTwoSizes) {
  const double coarse = work_of_tearing(0.05, 0.05), fine = work_of_tearing(0.025, 0.025);
  RecordProperty("coarse", std::to_string(coarse / kFractureEnergy));
  RecordProperty("fine", std::to_string(fine / kFractureEnergy));
  // 1.13 and 1.11 were measured: beside the cell that tears, its neighbours crack a little.
  EXPECT_NEAR(fine / coarse, 1, 0.05);
  EXPECT_GT(coarse / kFractureEnergy, 1);
  EXPECT_LT(coarse / kFractureEnergy, 1.2);
  // Softening as for the coarse cells whatever the size.
  const double wrong = work_of_tearing(0.025, 0.05);
  RecordProperty("wrong", std::to_string(wrong / kFractureEnergy));
  EXPECT_LT(wrong / coarse, 0.7);
}

}  // namespace
}  // namespace firn
