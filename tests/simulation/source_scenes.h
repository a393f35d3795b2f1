#pragma once

#include <firn/scene/load_scene.h>
#include <firn/simulation/simulation.h>

#include <memory>
#include <string>

/// Scenes of the tests of emitters, sinks, pins and tractions.
namespace firn {

inline std::unique_ptr<Simulation> make(const std::string& text) {
  return Simulation::create(parse_scene(text, "test.toml"));
}

/// A 2D scene with cells of 2 cm: particles of 1 cm^2, 0.1 kg of the liquid each.
inline std::string scene(const std::string& more, double end_time = 0.2, const std::string& root = "") {
  return root + "dimension = 2\nprecision = \"double\"\nframe_rate = 20\nresolution.cell_size = 0.02\nend_time = " +
         std::to_string(end_time) +
         "\n[material.liquid]\nmodel = \"newtonian_fluid\"\ndensity = 1000\nbulk_modulus = 2e4\nviscosity = 0.1\n"
         "tait_exponent = 1.01\n" +
         more;
}

/// A box of 10 cm by 20 cm at (0, 1).
inline std::string emitter(const std::string& more) {
  return "[[emitter]]\nname = \"tap\"\nshape = \"box\"\nsize = [0.1, 0.2]\nposition = [0, 1]\nmaterial = \"liquid\"\n" +
         more;
}

/// A square of 20 cm that stands on y = 0.
inline std::string body(const std::string& more = "") {
  return "[[body]]\nname = \"block\"\nshape = \"box\"\nsize = [0.2, 0.2]\nposition = [0, 0.1]\nmaterial = "
         "\"liquid\"\n" +
         more;
}

inline void run(Simulation& simulation) {
  while (simulation.frame() < simulation.frame_count()) simulation.advance_frame();
}

}  // namespace firn
