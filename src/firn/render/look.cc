#include <firn/render/look.h>

namespace firn {

namespace {

constexpr Look kLooks[] = {
    // Fresh snow reflects 0.85 to 0.95 of visible light, blue a little more than red (Warren 1982, fig. 10).
    {.name = "snow",
     .color = {{0.90F, 0.925F, 0.95F}},
     .wrap = 0.22F,
     .smooth = 0.80F,
     .jitter = 0.05F,
     .sparkle = 1.2F,
     .gloss = 0,
     .glow = {{0.02F, 0.03F, 0.05F}}},
    {.name = "jelly",
     .color = {{0.55F, 0.035F, 0.05F}},
     .wrap = 0.55F,
     .smooth = 0.97F,
     .jitter = 0,
     .sparkle = 0,
     .gloss = 0.9F,
     .glow = {{0.20F, 0.015F, 0.02F}}},
    {.name = "neo_hookean",
     .color = {{0.06F, 0.36F, 0.12F}},
     .wrap = 0.5F,
     .smooth = 0.95F,
     .jitter = 0,
     .sparkle = 0,
     .gloss = 0.7F,
     .glow = {{0.02F, 0.12F, 0.03F}}},
    {.name = "fixed_corotated",
     .color = {{0.60F, 0.25F, 0.05F}},
     .wrap = 0.4F,
     .smooth = 0.95F,
     .jitter = 0,
     .sparkle = 0,
     .gloss = 0.6F,
     .glow = {{0.08F, 0.03F, 0.01F}}},
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
