#pragma once

#include <firn/scene/key_builder.h>

/// The words of the scene file for the enums of settings.h, in the enums' order.
namespace firn {

template <>
struct ChoiceNames<Scene::Precision> {
  static constexpr std::string_view list[] = {"single", "double"};
};
template <>
struct ChoiceNames<Scene::Up> {
  static constexpr std::string_view list[] = {"y", "z"};
};
template <>
struct ChoiceNames<Scene::Rollback> {
  static constexpr std::string_view list[] = {"memory", "off"};
};
template <>
struct ChoiceNames<MethodSettings::Transfer> {
  static constexpr std::string_view list[] = {"pic", "flip", "pic_flip", "apic"};
};
template <>
struct ChoiceNames<MethodSettings::Kernel> {
  static constexpr std::string_view list[] = {"linear", "quadratic", "cubic"};
};
template <>
struct ChoiceNames<MethodSettings::Form> {
  static constexpr std::string_view list[] = {"mls", "gradient"};
};
template <>
struct ChoiceNames<BodySettings::Shape> {
  static constexpr std::string_view list[] = {"box", "sphere", "disk"};
};
template <>
struct ChoiceNames<BodySettings::Fill> {
  static constexpr std::string_view list[] = {"poisson", "lattice"};
};
template <>
struct ChoiceNames<BodySettings::Units> {
  static constexpr std::string_view list[] = {"m", "cm", "mm"};
};
template <>
struct ChoiceNames<ShapeSettings::Shape> {
  static constexpr std::string_view list[] = {
      "half_space",   "box",       "rounded_box",  "sphere", "capsule",       "cylinder",           "cone",
      "torus",        "polygon",   "height_field", "mesh",   "mesh_sequence", "level_set_sequence", "union",
      "intersection", "difference"};
};
template <>
struct ChoiceNames<ColliderSettings::Look> {
  static constexpr std::string_view list[] = {"solid", "glass", "hidden"};
};
template <>
struct ChoiceNames<ColliderSettings::Interpolation> {
  static constexpr std::string_view list[] = {"linear", "smooth"};
};
template <>
struct ChoiceNames<ColliderSettings::AtEnd> {
  static constexpr std::string_view list[] = {"hold", "cycle"};
};
template <>
struct ChoiceNames<ColliderSettings::Contact> {
  static constexpr std::string_view list[] = {"sticky", "slip", "separate"};
};

template <>
struct ChoiceNames<FieldSettings::Type> {
  static constexpr std::string_view list[] = {"acceleration", "attractor", "vortex", "wind"};
};
template <>
struct ChoiceNames<ProbeSettings::Shape> {
  static constexpr std::string_view list[] = {"point", "line", "plane"};
};

}  // namespace firn
