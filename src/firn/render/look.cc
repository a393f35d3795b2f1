#include <firn/render/look.h>

namespace firn {

namespace {

// Colours are estimates by eye unless a source is given: pictures need them plausible, not measured. Darker than life
// where a substance is nearly white, so that sunlit places keep their shape (tone.h).

/// Crystals that light enters and leaves: white, glittering.
constexpr Look snow(std::string_view name, Vec3f color, float smooth, float jitter, float sparkle) {
  return {.name = name,
          .color = color,
          .wrap = 0.22F,
          .smooth = smooth,
          .jitter = jitter,
          .sparkle = sparkle,
          .gloss = 0,
          .glow = {{0.02F, 0.03F, 0.05F}}};
}

/// A smooth soft body through which light is scattered; glow is its colour in depth.
constexpr Look soft(std::string_view name, Vec3f color, float gloss, float wrap, Vec3f glow) {
  return {.name = name,
          .color = color,
          .wrap = wrap,
          .smooth = 0.97F,
          .jitter = 0,
          .sparkle = 0,
          .gloss = gloss,
          .glow = glow};
}

/// An opaque body with a smooth surface.
constexpr Look solid(std::string_view name, Vec3f color, float gloss) {
  return {.name = name,
          .color = color,
          .wrap = 0.05F,
          .smooth = 0.95F,
          .jitter = 0,
          .sparkle = 0,
          .gloss = gloss,
          .glow = {}};
}

/// Grains of different brightness.
constexpr Look grains(std::string_view name, Vec3f color, float smooth, float jitter, float sparkle = 0) {
  return {.name = name,
          .color = color,
          .wrap = 0.1F,
          .smooth = smooth,
          .jitter = jitter,
          .sparkle = sparkle,
          .gloss = 0,
          .glow = {}};
}

constexpr Look kLooks[] = {
    // Fresh snow reflects 0.85 to 0.95 of visible light, blue a little more than red (Warren 1982, fig. 10); wet snow
    // less, as water lets light go deeper.
    snow("snow", {{0.90F, 0.925F, 0.95F}}, 0.80F, 0.05F, 1.2F),
    snow("wet_snow", {{0.74F, 0.79F, 0.85F}}, 0.88F, 0.03F, 0.6F),
    snow("powder_snow", {{0.92F, 0.935F, 0.95F}}, 0.60F, 0.05F, 1.5F),

    soft("jelly", {{0.55F, 0.035F, 0.05F}}, 0.9F, 0.55F, {{0.20F, 0.015F, 0.02F}}),
    soft("yogurt", {{0.80F, 0.77F, 0.70F}}, 0.35F, 0.30F, {{0.04F, 0.035F, 0.03F}}),
    soft("whipped_cream", {{0.84F, 0.80F, 0.71F}}, 0.05F, 0.35F, {{0.04F, 0.035F, 0.03F}}),
    soft("toothpaste", {{0.38F, 0.70F, 0.66F}}, 0.5F, 0.25F, {{0.01F, 0.03F, 0.03F}}),
    soft("foam", {{0.84F, 0.86F, 0.88F}}, 0.1F, 0.35F, {{0.03F, 0.035F, 0.04F}}),
    soft("honey", {{0.50F, 0.19F, 0.01F}}, 1.0F, 0.55F, {{0.20F, 0.075F, 0.003F}}),
    soft("water", {{0.06F, 0.20F, 0.30F}}, 1.0F, 0.50F, {{0.01F, 0.05F, 0.07F}}),

    solid("rubber", {{0.10F, 0.095F, 0.09F}}, 0.25F),
    solid("mud", {{0.115F, 0.070F, 0.038F}}, 0.35F),
    solid("clay", {{0.34F, 0.29F, 0.225F}}, 0.1F),
    solid("plasticine", {{0.10F, 0.22F, 0.52F}}, 0.15F),
    // Normal reflectance of iron 0.56, 0.57, 0.58 and of copper 0.95, 0.64, 0.54 (Akenine-Moeller et al. 2018, table
    // 9.2), half of it as diffuse light, for worn metal.
    solid("steel", {{0.28F, 0.285F, 0.29F}}, 0.9F),
    solid("copper", {{0.475F, 0.23F, 0.13F}}, 0.8F),

    grains("sand", {{0.52F, 0.37F, 0.20F}}, 0.60F, 0.18F, 0.3F),
    grains("wet_sand", {{0.30F, 0.20F, 0.11F}}, 0.75F, 0.12F),
    grains("concrete", {{0.36F, 0.355F, 0.34F}}, 0.85F, 0.07F),
    // Crust, with the red of the melt shining through.
    {.name = "lava",
     .color = {{0.035F, 0.024F, 0.021F}},
     .wrap = 0.1F,
     .smooth = 0.85F,
     .jitter = 0.35F,
     .sparkle = 0,
     .gloss = 0.15F,
     .glow = {{0.16F, 0.015F, 0.001F}}},

    // Models without a preset: colours that tell them apart.
    soft("neo_hookean", {{0.06F, 0.36F, 0.12F}}, 0.7F, 0.5F, {{0.02F, 0.12F, 0.03F}}),
    soft("fixed_corotated", {{0.60F, 0.25F, 0.05F}}, 0.6F, 0.4F, {{0.08F, 0.03F, 0.01F}}),
    soft("hencky", {{0.08F, 0.16F, 0.46F}}, 0.6F, 0.4F, {{0.01F, 0.03F, 0.09F}}),
    soft("linear_corotated", {{0.36F, 0.10F, 0.42F}}, 0.6F, 0.4F, {{0.06F, 0.015F, 0.07F}}),
    soft("oldroyd_b", {{0.16F, 0.44F, 0.05F}}, 1.0F, 0.5F, {{0.05F, 0.14F, 0.01F}}),
    soft("newtonian_fluid", {{0.06F, 0.20F, 0.30F}}, 1.0F, 0.5F, {{0.01F, 0.05F, 0.07F}}),
    soft("herschel_bulkley", {{0.66F, 0.55F, 0.44F}}, 0.4F, 0.3F, {{0.03F, 0.02F, 0.02F}}),
    solid("von_mises", {{0.34F, 0.35F, 0.36F}}, 0.6F),
    grains("drucker_prager", {{0.46F, 0.34F, 0.22F}}, 0.60F, 0.18F),
    grains("cam_clay", {{0.24F, 0.15F, 0.09F}}, 0.80F, 0.10F),
    grains("rankine_damage", {{0.40F, 0.40F, 0.39F}}, 0.80F, 0.08F),
};

constexpr Look kNeutral = {.name = "", .color = {{0.6F, 0.6F, 0.58F}}, .wrap = 0.15F, .smooth = 0.5F, .jitter = 0.06F};

}  // namespace

const Look& find_look(const SnapshotMaterial& material) {
  for (const std::string& name : {material.preset, material.model}) {
    for (const Look& look : kLooks) {
      if (!name.empty() && look.name == name) return look;
    }
  }
  return kNeutral;
}

const Vec3f kGroundColor = {{0.24F, 0.255F, 0.275F}};
const Vec3f kColliderColor = {{0.36F, 0.21F, 0.115F}};

}  // namespace firn
