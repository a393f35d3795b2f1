#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace firn {

/// A quantity that every particle carries. Declared once, in kFields; storage, moves between blocks and the hash
/// are derived from it.
enum class Field : int {
  offset,    ///< position inside the cell, in cells: x = dx (cell + kernel offset + offset), offset in [0, 1]
  strain,    ///< F_p (elastic part, for plastic models), row-major
  velocity,  ///< v_p, m/s
  affine,    ///< C_p, 1/s, row-major: row is the velocity's component
  stress,    ///< Kirchhoff, Pa: xx yy zz xy xz yz in 3D, xx yy zz xy in 2D
  grad_v,    ///< sum v_i grad w_ip^T, 1/s; only where it differs from C_p (the gradient form with quadratic or cubic
             ///< kernels)
  acceleration,  ///< of the body_force callback, m/s^2; only with one
  id,            ///< stable over the whole run
  origin,        ///< what it was seeded as, see ParticleOrigins
  cell,          ///< place of the particle's cell in its block, see cell_code
};
inline constexpr int kFieldCount = 10;

struct FieldSpec {
  enum class Element { real, number32, number16, number8 };
  enum class Shape { scalar, vector, matrix, stress };
  const char *name, *unit, *help;
  Element element;
  Shape shape;
};

/// In the order of Field.
extern const std::array<FieldSpec, kFieldCount> kFields;

/// A number that a material model remembers per particle.
struct HistorySpec {
  std::string name, unit, help;
  double initial_value = 0;
};

/// Where each number of a particle lies. Field f begins `field[f]` bytes into the particle, its components follow each
/// other. In a chunk of n particles, all of these distances are n times as long, and particle p lies p elements on:
/// structure of arrays; a particle on its own is a chunk of one.
struct ParticleLayout {
  struct Options {
    bool keeps_velocity = false;  ///< v_p is needed by the next step (FLIP); see kept_bytes
    bool grad_v = false;
    bool acceleration = false;
    int history = 0;
  };

  std::array<int, kFieldCount> field;       ///< bytes; -1 for a field that is absent
  std::array<int, kFieldCount> components;  ///< numbers in the field
  int history = 0;                          ///< bytes: where the model's history begins
  int real_bytes = 4;
  /// Reals come first, those that survive a fused step before all others: the rest (v, C, stress) passes from G2P to
  /// the next P2G without being stored.
  int kept_reals = 0, reals = 0;
  int bytes = 0;  ///< of one particle

  static ParticleLayout of(int dim, int real_bytes, const Options& options);
};

}  // namespace firn
