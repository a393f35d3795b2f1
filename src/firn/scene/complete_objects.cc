#include <firn/scene/complete_objects.h>
#include <firn/scene/nearest.h>
#include <firn/scene/value_text.h>

namespace firn {

void check_place(const SceneDraft& draft, std::string_view section, std::size_t i, const std::string& mesh,
                 const std::string& polygon, const std::optional<BodySettings::Shape>& shape) {
  const bool flat = draft.scene.dimension == 2;
  if (flat && !mesh.empty()) draft.fail(section, i, "mesh", "a mesh needs a 3D scene; in 2D give polygon or shape");
  if (!flat && !polygon.empty()) draft.fail(section, i, "polygon", "a polygon needs dimension = 2; in 3D give mesh");
  if (flat && shape == BodySettings::Shape::sphere) {
    draft.fail(section, i, "shape", "shape \"sphere\" needs a 3D scene; in 2D use \"disk\"");
  }
  if (!flat && shape == BodySettings::Shape::disk) {
    draft.fail(section, i, "shape", "shape \"disk\" needs dimension = 2; in 3D use \"sphere\"");
  }
  if (!mesh.empty()) check_file(draft, section, i, "mesh", mesh);
  if (!polygon.empty()) check_file(draft, section, i, "polygon", polygon);
}

void check_material(const SceneDraft& draft, std::string_view section, std::size_t i, const std::string& material) {
  if (draft.scene.find_material(material)) return;
  std::vector<std::string> names;
  for (const MaterialSettings& known : draft.scene.materials) names.push_back(known.name);
  draft.fail(section, i, "material",
             fmt::format("no [material.{}]{}", key_text(material), suggestion(material, names)));
}

}  // namespace firn
