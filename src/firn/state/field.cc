#include <firn/state/field.h>

namespace firn {

namespace {

using Element = FieldSpec::Element;
using Shape = FieldSpec::Shape;

int component_count(Shape shape, int dim) {
  switch (shape) {
    case Shape::scalar:
      return 1;
    case Shape::vector:
      return dim;
    case Shape::matrix:
      return dim * dim;
    case Shape::stress:
      return dim == 3 ? 6 : 4;
  }
  return 0;
}

int element_bytes(Element element, int real_bytes) {
  switch (element) {
    case Element::real:
      return real_bytes;
    case Element::number32:
      return 4;
    case Element::number16:
      return 2;
    case Element::number8:
      return 1;
  }
  return 0;
}

}  // namespace

const std::array<FieldSpec, kFieldCount> kFields = {{
    {"offset", "", "Position inside the cell, in cells.", Element::real, Shape::vector},
    {"strain", "", "Deformation gradient; its elastic part for plastic models.", Element::real, Shape::matrix},
    {"velocity", "m/s", "Velocity.", Element::real, Shape::vector},
    {"affine", "1/s", "Affine velocity matrix C of APIC.", Element::real, Shape::matrix},
    {"stress", "Pa", "Kirchhoff stress.", Element::real, Shape::stress},
    {"grad_v", "1/s", "Velocity gradient.", Element::real, Shape::matrix},
    {"acceleration", "m/s^2", "Acceleration by the body force.", Element::real, Shape::vector},
    {"id", "", "Number of the particle, stable over the whole run.", Element::number32, Shape::scalar},
    {"origin", "", "Body and undeformed volume that the particle was seeded with.", Element::number16, Shape::scalar},
    {"cell", "", "Place of the particle's cell in its block.", Element::number8, Shape::scalar},
}};

ParticleLayout ParticleLayout::of(int dim, int real_bytes, const Options& options) {
  ParticleLayout layout;
  layout.real_bytes = real_bytes;
  const auto place = [&](Field field) {
    const auto f = static_cast<std::size_t>(field);
    const bool wanted = field == Field::grad_v         ? options.grad_v
                        : field == Field::acceleration ? options.acceleration
                                                       : true;
    layout.components[f] = wanted ? component_count(kFields[f].shape, dim) : 0;
    layout.field[f] = wanted ? layout.bytes : -1;
    layout.bytes += layout.components[f] * element_bytes(kFields[f].element, real_bytes);
  };
  for (const Field field : {Field::offset, Field::strain}) place(field);
  layout.history = layout.bytes;
  layout.bytes += options.history * real_bytes;
  if (!options.keeps_velocity) layout.kept_reals = layout.bytes / real_bytes;
  place(Field::velocity);
  if (options.keeps_velocity) layout.kept_reals = layout.bytes / real_bytes;
  for (const Field field : {Field::affine, Field::stress, Field::grad_v, Field::acceleration}) place(field);
  layout.reals = layout.bytes / real_bytes;
  for (const Field field : {Field::id, Field::origin, Field::cell}) place(field);
  return layout;
}

}  // namespace firn
