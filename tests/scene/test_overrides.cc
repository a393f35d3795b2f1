#include "scene/scene_text.h"

namespace firn::test {
namespace {

TEST(Overrides, WinOverTheFile) {
  const Scene scene = parse(kMinimal, {"material.snow.youngs_modulus=2e5", "end_time = 3", "body.0.velocity=[0, -1, 2]",
                                       "limits.speed=50", "method={transfer=\"flip\", kernel=\"cubic\"}"});
  EXPECT_EQ(scene.materials[0].parameters.at("youngs_modulus"), 2e5);
  EXPECT_EQ(scene.end_time, 3);
  EXPECT_EQ(scene.bodies[0].velocity[2].number, 2);
  EXPECT_EQ(scene.limits.speed, 50);
  EXPECT_EQ(scene.method.transfer, MethodSettings::Transfer::flip);
  EXPECT_EQ(scene.method.kernel, MethodSettings::Kernel::cubic);
}

TEST(Overrides, FindBodiesByNameOrNumber) {
  const std::string text =
      kMinimal + "[[body]]\nname = \"ball\"\nshape = \"sphere\"\nradius = 1\nmaterial = \"snow\"\n";
  const Scene scene = parse(text, {"body.ball.position=[0,2,0]", "body.1.radius=3", "body.0.name=first"});
  EXPECT_EQ(scene.bodies[0].name, "first");
  EXPECT_EQ(scene.bodies[1].position[1], 2);
  EXPECT_EQ(scene.bodies[1].radius, 3);
}

TEST(Overrides, TheLastOneWins) { EXPECT_EQ(parse(kMinimal, {"seed=2", "seed=3"}).seed, 3u); }

TEST(Overrides, LettersOfAnyLanguageNeedNoQuotes) { EXPECT_EQ(parse(kMinimal, {"title=Größe Й"}).title, "Größe Й"); }

TEST(Overrides, TextNeedsNoQuotes) {
  const Scene scene = parse(kMinimal, {"method.transfer=pic", "output.folder=out/a b", "title=\"quoted\""});
  EXPECT_EQ(scene.method.transfer, MethodSettings::Transfer::pic);
  EXPECT_EQ(scene.output.folder, "out/a b");
  EXPECT_EQ(scene.title, "quoted");
}

TEST(Overrides, TakeThePlaceOfAlternatives) {
  const Scene scene = parse(kMinimal, {"resolution.particles=1e3"});
  EXPECT_FALSE(scene.resolution.cell_size.has_value());
  EXPECT_EQ(scene.resolution.particles, 1000);
}

TEST(Overrides, MayAddMaterials) {
  const Scene scene = parse(kMinimal, {"material.goo.preset=jelly", "body.0.material=goo"});
  ASSERT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.find_material("goo")->model, "fixed_corotated");
}

TEST(Overrides, ErrorsNameTheText) {
  const auto error = [](const std::string& text) { return error_of(kMinimal, {text}); };
  EXPECT_EQ(error("limits.sped=3"), "--set limits.sped=3: unknown key \"sped\"; did you mean \"speed\"?");
  EXPECT_EQ(error("limits.speed=-3"), "--set limits.speed=-3: limits: speed must be > 0 m/s, got -3");
  EXPECT_TRUE(matches(error("limits.speed=1,5"),
                      "--set limits.speed=1,5: .*the text \"1,5\"; a decimal number is written with a point.*"));
  EXPECT_TRUE(matches(error("speed"), "--set speed: expected key=value, .*"));
  EXPECT_TRUE(matches(error("=3"), "--set =3: expected key=value, .*"));
  EXPECT_TRUE(matches(error("a b=3"), "--set a b=3: not a key before the =.*"));
  EXPECT_EQ(error("body.cube.radius=3"), "--set body.cube.radius=3: no body \"cube\"; known: \"0\"");
  EXPECT_EQ(error("body.7.radius=3"), "--set body.7.radius=3: no body \"7\"; did you mean \"0\"?");
  EXPECT_TRUE(matches(error("body=3"), "--set body=3: body must be written as .*"));
  EXPECT_TRUE(matches(error("material.snow=3"), "--set material.snow=3: .*must be a section .*"));
}

}  // namespace
}  // namespace firn::test
