#include <firn/materials/model_info.h>

#include <array>

namespace firn {
namespace {

// Sources that several presets share. "chosen" numbers name what they have to bring about;
// tests/materials/test_presets.cc measures it on a point, and the scenes of docs/materials.md in the whole step.
constexpr std::string_view kStomakhin = "Stomakhin et al. 2013, table 2, doi:10.1145/2461912.2461948";
constexpr std::string_view kKlar = "Klar et al. 2016, doi:10.1145/2897824.2925906";
constexpr std::string_view kTaylorBar =
    "Taylor bar benchmark of Simo 1992, after Wilkins and Guinan 1973, doi:10.1063/1.1662328";
constexpr std::string_view kTaitOfWater = "Becker and Teschner 2007: 7 for water";
constexpr std::string_view kWaterTable = "CRC Handbook of Chemistry and Physics, properties of water at 20 C";
constexpr std::string_view kSlowSound = "chosen: sound at 45 m/s; density within 1 % under 2 m of liquid";
constexpr std::string_view kHoldsTogether = "chosen: never opens by itself";
constexpr std::string_view kNearlyIncompressible = "chosen: volume changes much less than shape";
constexpr std::string_view kHoldsItsVolume = "chosen: 10 cm of it are squeezed by their weight by less than 2 %";
constexpr std::string_view kForgets = "chosen: opened by more than 65 % it is spray, which lands as grains";
constexpr std::string_view kSnowCap = "chosen: bounds the loss of time step to a factor of 2.8";
constexpr std::string_view kFirmerThanItsYield = "chosen: yields at an elastic strain of a few per cent";

constexpr Preset::Value kSnow[] = {
    {"youngs_modulus", 1.4e5, kStomakhin},
    {"poisson_ratio", 0.2, kStomakhin},
    {"critical_compression", 2.5e-2, kStomakhin},
    {"critical_stretch", 7.5e-3, kStomakhin},
    {"hardening", 10, kStomakhin},
    {"hardening_cap", 8, kSnowCap},
};
constexpr Preset::Value kWetSnow[] = {
    {"youngs_modulus", 1.4e5, kStomakhin},
    {"poisson_ratio", 0.2, kStomakhin},
    {"critical_compression", 5e-2, "chosen: packs at twice the pressure of snow"},
    {"critical_stretch", 1.5e-2, "chosen: bears twice the tension of snow"},
    {"hardening", 10, kStomakhin},
    {"hardening_cap", 8, kSnowCap},
};
constexpr Preset::Value kPowderSnow[] = {
    {"youngs_modulus", 5e4, "chosen: a third of the stiffness of snow"},
    {"poisson_ratio", 0.2, kStomakhin},
    {"critical_compression", 2e-2, "chosen: packs under 0.4 of the pressure of snow"},
    {"critical_stretch", 1e-3, "chosen: bears less than a tenth of the tension of snow"},
    {"hardening", 7, "chosen: packed by a fifth it hardens by 4, snow by 7"},
    {"hardening_cap", 8, kSnowCap},
};
constexpr Preset::Value kJelly[] = {
    {"youngs_modulus", 2e4, "chosen: a block of 10 cm wobbles 5 to 10 times a second"},
    {"poisson_ratio", 0.4, kNearlyIncompressible},
};
constexpr Preset::Value kRubber[] = {
    {"youngs_modulus", 2e6, "chosen: a block of 10 cm rings 5 times faster than jelly or more"},
    {"poisson_ratio", 0.47, kNearlyIncompressible},
};
constexpr Preset::Value kYogurt[] = {
    {"youngs_modulus", 3e3, kFirmerThanItsYield},
    {"poisson_ratio", 0.495, kHoldsItsVolume},
    {"shear_yield_stress", 60, "chosen: a cone of 2 cm stands, one of 5 cm sinks"},
    {"consistency", 10, "chosen: stirred at 20/s it is thinner than honey"},
    {"flow_index", 0.5, "chosen: thins when stirred"},
};
constexpr Preset::Value kWhippedCream[] = {
    {"youngs_modulus", 6e3, kFirmerThanItsYield},
    {"poisson_ratio", 0.48, kHoldsItsVolume},
    {"shear_yield_stress", 90, "chosen: a cone of 8 cm stands"},
    {"consistency", 15, "chosen: stirred at 20/s it is thinner than honey"},
    {"flow_index", 0.5, "chosen: thins when stirred"},
};
constexpr Preset::Value kToothpaste[] = {
    {"youngs_modulus", 2e4, kFirmerThanItsYield},
    {"poisson_ratio", 0.49, kHoldsItsVolume},
    {"shear_yield_stress", 200, "chosen: a strand of 1 cm keeps its round shape"},
    {"consistency", 30, "chosen: pressed from a tube at 10/s by less than 500 Pa"},
    {"flow_index", 0.5, "chosen: thins when pressed"},
};
constexpr Preset::Value kFoam[] = {
    {"youngs_modulus", 1.5e3, kFirmerThanItsYield},
    {"poisson_ratio", 0.45, kHoldsItsVolume},
    {"shear_yield_stress", 40, "chosen: a cone of 15 cm stands"},
    {"consistency", 20, "chosen: stirred at 20/s it is thinner than honey"},
    {"flow_index", 0.4, "chosen: thins when stirred"},
};
constexpr Preset::Value kMud[] = {
    {"youngs_modulus", 2e4, kFirmerThanItsYield},
    {"poisson_ratio", 0.49, kHoldsItsVolume},
    {"shear_yield_stress", 100, "chosen: a layer of 3 cm rests on a slope of 10 degrees, one of 5 cm does not"},
    {"consistency", 20, "chosen: sheared at 1/s it bears a fifth more than its yield stress"},
    {"flow_index", 0.6, "chosen: thins when stirred"},
};
constexpr Preset::Value kLava[] = {
    {"youngs_modulus", 2e5, kFirmerThanItsYield},
    {"poisson_ratio", 0.49, kHoldsItsVolume},
    {"shear_yield_stress", 2000, "chosen: the front of a flow on a slope of 10 degrees is half a metre thick"},
    {"consistency", 1000, "chosen: two orders of magnitude more viscous than honey"},
    {"flow_index", 1, "chosen: Bingham, the simplest law with a yield stress"},
};
constexpr Preset::Value kHoney[] = {
    {"bulk_modulus", 3e6, kSlowSound},
    {"tait_exponent", 7, kTaitOfWater},
    {"viscosity", 10, "chosen: a ball of 2 cm and twice its density sinks 3 cm a second"},
    {"tensile_strength", 1e12, kHoldsTogether},
};
constexpr Preset::Value kWater[] = {
    {"bulk_modulus", 2e6, kSlowSound},
    {"tait_exponent", 7, kTaitOfWater},
    {"viscosity", 1.002e-3, kWaterTable},
    {"tensile_strength", 1e12, kHoldsTogether},
};
constexpr Preset::Value kSand[] = {
    {"youngs_modulus", 3.537e5, kKlar},
    {"poisson_ratio", 0.3, kKlar},
    {"friction_angle", 30, "chosen: rests at a slope of 34.7 degrees"},
    {"cohesion", 0, "chosen: dry grains do not stick"},
    {"dilation_limit", 0.5, kForgets},
};
constexpr Preset::Value kWetSand[] = {
    {"youngs_modulus", 3.537e5, kKlar},
    {"poisson_ratio", 0.3, kKlar},
    {"friction_angle", 33, "chosen: a little rougher than dry sand"},
    {"cohesion", 800, "chosen: a vertical cut of 30 cm stands, one of 50 cm does not"},
    {"dilation_limit", 0.5, kForgets},
};
constexpr Preset::Value kClay[] = {
    {"youngs_modulus", 5e6, "chosen: squeezed by less than 1 % when it begins to pack"},
    {"poisson_ratio", 0.35, kNearlyIncompressible},
    {"friction_angle", 22, "chosen: less rough than sand"},
    {"preconsolidation_pressure", 4e4, "chosen: a block of 1 m stands, one of 10 m does not"},
    {"cohesion_ratio", 0.5, "chosen: torn off by half the pressure that dents it"},
    {"packing_hardening", 0.05, "chosen: sheared by 10 % it keeps three quarters of its strength"},
    {"dilation_limit", 0.5, kForgets},
};
constexpr Preset::Value kPlasticine[] = {
    {"youngs_modulus", 5e6, "chosen: yields at a strain of 1 %"},
    {"poisson_ratio", 0.4, kNearlyIncompressible},
    {"yield_stress", 5e4, "chosen: a column of 2 m stands, fingers leave dents"},
    {"hardening_modulus", 2e4, "chosen: hardens by 40 % at a plastic strain of 1"},
};
constexpr Preset::Value kSteel[] = {
    {"youngs_modulus", 2.1e11, "EN 1993-1-1, section 3.2.6"},
    {"poisson_ratio", 0.3, "EN 1993-1-1, section 3.2.6"},
    {"yield_stress", 2.35e8, "EN 1993-1-1, table 3.1: S 235"},
    {"hardening_modulus", 2.1e9, "EN 1993-1-5, annex C.6: a hundredth of the modulus of elasticity"},
};
constexpr Preset::Value kCopper[] = {
    {"youngs_modulus", 1.17e11, kTaylorBar},
    {"poisson_ratio", 0.35, kTaylorBar},
    {"yield_stress", 4e8, kTaylorBar},
    {"hardening_modulus", 1e8, kTaylorBar},
};
constexpr Preset::Value kConcrete[] = {
    {"youngs_modulus", 3.1e10, "EN 1992-1-1, table 3.1: C25/30"},
    {"poisson_ratio", 0.2, "EN 1992-1-1, section 3.1.3"},
    {"cracking_stress", 2.6e6, "EN 1992-1-1, table 3.1: C25/30, mean tensile strength"},
    {"fracture_energy", 100, "chosen: a crack of 77 micrometres still bears a little tension"},
};

constexpr Preset kPresets[] = {
    {"snow", "snow", "Fresh snow that packs to a snowball.", 400, kStomakhin, kSnow},
    {"wet_snow", "snow", "Heavy snow that sticks and breaks in lumps.", 600, "chosen: half as heavy again as snow",
     kWetSnow},
    {"powder_snow", "snow", "Light dry snow that falls apart.", 120, "chosen: a third of snow", kPowderSnow},
    {"jelly", "fixed_corotated", "Firm gelatine dessert.", 1000, "chosen: as water", kJelly},
    {"rubber", "neo_hookean", "Soft technical rubber.", 1100, "chosen: sinks in water", kRubber},
    {"yogurt", "herschel_bulkley", "Set yogurt that keeps a small peak.", 1030, "chosen: a little more than water",
     kYogurt},
    {"whipped_cream", "herschel_bulkley", "Stiff whipped cream.", 450, "chosen: half of it is air", kWhippedCream},
    {"toothpaste", "herschel_bulkley", "Paste that keeps the shape of its strand.", 1300, "chosen: floats on honey",
     kToothpaste},
    {"honey", "newtonian_fluid", "Runny honey at room temperature.", 1400, "chosen: between water and its sugar",
     kHoney},
    {"water", "newtonian_fluid", "Water at 20 C, with sound slowed down.", 998.2, kWaterTable, kWater},
    {"mud", "herschel_bulkley", "Mud that comes to rest on gentle slopes.", 1600, "chosen: between water and stone",
     kMud},
    {"sand", "drucker_prager", "Dry sand.", 1600, "chosen: quartz with 40 % of pores", kSand},
    {"wet_sand", "drucker_prager", "Moist sand for castles.", 1800, "chosen: sand with half of its pores filled",
     kWetSand},
    {"clay", "cam_clay", "Firm potter's clay.", 1800, "chosen: as wet sand", kClay},
    {"plasticine", "von_mises", "Modelling clay that keeps every dent.", 1800, "chosen: sinks in water", kPlasticine},
    {"steel", "von_mises", "Structural steel S 235.", 7850, "EN 1991-1-1, table A.4", kSteel},
    {"copper", "von_mises", "Cold-worked copper.", 8930, kTaylorBar, kCopper},
    {"concrete", "rankine_damage", "Concrete C25/30 that cracks in tension; it is not crushed.", 2400,
     "EN 1991-1-1, table A.1", kConcrete},
    {"foam", "herschel_bulkley", "Shaving foam.", 80, "chosen: mostly air", kFoam},
    {"lava", "herschel_bulkley", "Basalt lava at a fixed temperature, as it creeps.", 2600, "chosen: molten basalt",
     kLava},
};

}  // namespace

std::span<const Preset> all_presets() { return kPresets; }

const Preset* find_preset(std::string_view name) {
  for (const Preset& preset : kPresets) {
    if (preset.name == name) return &preset;
  }
  return nullptr;
}

}  // namespace firn
