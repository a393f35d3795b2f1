#pragma once

#include <firn/state/field.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

namespace firn {

/// One field of consecutive particles: component c is the array at [c]. Empty where the field is absent.
template <class T>
struct Components {
  T* first = nullptr;
  std::size_t stride = 0;

  T* operator[](int c) const { return first + static_cast<std::size_t>(c) * stride; }
  explicit operator bool() const { return first != nullptr; }
};

/// Consecutive particles of one block as plain arrays, for the loops of a step; read only if Real is const. A whole
/// SIMD vector may be read from the last particle on.
template <class Real, int dim>
struct ParticleColumns {
  template <class T>
  using Number = std::conditional_t<std::is_const_v<Real>, const T, T>;

  Components<Real> offset, strain, velocity, affine, stress, grad_v, acceleration, history;
  Number<std::uint32_t>* id;
  Number<std::uint16_t>* origin;
  Number<std::uint8_t>* cell;
  std::remove_const_t<Real> density = 0;  ///< rho_0, kg/m^3 (kg/m^2 in 2D)
  std::span<const std::remove_const_t<Real>> volume_of_origin = {};

  /// V_p^0, m^3 (m^2 in 2D)
  std::remove_const_t<Real> rest_volume(std::uint32_t p) const { return volume_of_origin[origin[p]]; }
  /// m_p, kg (kg/m in 2D)
  std::remove_const_t<Real> mass(std::uint32_t p) const { return density * rest_volume(p); }
  /// F's rate of change comes from grad v, or from C where both are the same.
  const Components<Real>& velocity_gradient() const { return grad_v ? grad_v : affine; }
};

/// Memory of a number of particles: a chunk, what a chunk needs on its way through the step, or a single particle.
struct ParticleStorage {
  std::byte* memory = nullptr;
  std::size_t capacity = 0;

  /// Element p of the component that lies `place` bytes into a particle.
  template <class T>
  T* at(int place, std::size_t p = 0) const {
    return reinterpret_cast<T*>(memory + static_cast<std::size_t>(place) * capacity) + p;
  }
};

/// @param kept where the fields that survive a fused step lie, from its particle `first` on
/// @param passing where the others lie, from particle `passing_first` on; the same storage outside of fused steps
template <class Real, int dim>
ParticleColumns<Real, dim> columns_of(const ParticleLayout& layout, ParticleStorage kept, std::size_t first,
                                      ParticleStorage passing, std::size_t passing_first) {
  const auto place = [&](Field field) { return layout.field[static_cast<std::size_t>(field)]; };
  const auto components = [&](int bytes) -> Components<Real> {
    if (bytes < 0) return {};
    const bool is_kept = bytes < layout.kept_reals * layout.real_bytes;
    const ParticleStorage& storage = is_kept ? kept : passing;
    return {storage.template at<Real>(bytes, is_kept ? first : passing_first), storage.capacity};
  };
  ParticleColumns<Real, dim> columns;
  columns.offset = components(place(Field::offset));
  columns.strain = components(place(Field::strain));
  columns.history = components(layout.history);
  columns.velocity = components(place(Field::velocity));
  columns.affine = components(place(Field::affine));
  columns.stress = components(place(Field::stress));
  columns.grad_v = components(place(Field::grad_v));
  columns.acceleration = components(place(Field::acceleration));
  columns.id = kept.at<std::uint32_t>(place(Field::id), first);
  columns.origin = kept.at<std::uint16_t>(place(Field::origin), first);
  columns.cell = kept.at<std::uint8_t>(place(Field::cell), first);
  return columns;
}

}  // namespace firn
