#pragma once

#include <firn/scene/schema.h>

#include <vector>

namespace firn {

/// The table itself, built once by schema().
std::vector<Section> make_schema();

/// The part of it that follows from the materials' own declarations.
Section make_material_section();

Section make_body_section();
Section make_part_section();
Section make_collider_section();
Section make_emitter_section();
Section make_sink_section();
Section make_field_section();
Section make_pin_section();
Section make_traction_section();
Section make_probe_section();

}  // namespace firn
