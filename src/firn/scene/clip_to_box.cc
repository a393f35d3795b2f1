#include <firn/core/error.h>
#include <firn/core/log.h>
#include <firn/scene/clip_to_box.h>
#include <firn/scene/value_text.h>
#include <fmt/format.h>

#include <vector>

namespace firn {
namespace {

template <int dim>
bool is_inside(const LimitSettings::Box& box, const Vec<double, dim>& x) {
  for (int d = 0; d < dim; ++d) {
    if (!(x[d] >= box.lower[d] && x[d] <= box.upper[d])) return false;
  }
  return true;
}

template <int dim>
std::string box_text(const LimitSettings::Box& box) {
  std::string text;
  for (int d = 0; d < dim; ++d) {
    text += fmt::format("{}{} in [{}, {}]", d > 0 ? ", " : "", "xyz"[d], number_text(box.lower[d]),
                        number_text(box.upper[d]));
  }
  return text + " m";
}

}  // namespace

template <int dim>
double clip_to_box(const Scene& scene, const BodySettings& body, Samples<dim>& samples) {
  if (!scene.limits.box) return 0;
  const LimitSettings::Box& box = *scene.limits.box;
  std::vector<Vec<double, dim>> inside;
  for (const Vec<double, dim>& x : samples.positions) {
    if (is_inside<dim>(box, x)) inside.push_back(x);
  }
  const std::size_t all = samples.positions.size(), lost = all - inside.size();
  if (lost == 0) return 0;
  const std::string where = fmt::format("limits.box, {}", box_text<dim>(box));
  if (inside.empty()) {
    throw Error(ErrorKind::usage, fmt::format("body {}: all of it lies outside {}; move it, or make the box larger",
                                              in_quotes(body.name), where));
  }
  const double share = static_cast<double>(lost) / static_cast<double>(all);
  const std::string message = fmt::format("body {}: {:.3g} % of it, {} of {} particles, lies outside {}",
                                          in_quotes(body.name), 100 * share, lost, all, where);
  if (!scene.limits.clip) {
    throw Error(ErrorKind::usage,
                message + "; move it, make the box larger, or leave that part out with limits.clip = true");
  }
  log_warning(message + ", and is left out");
  samples.positions = std::move(inside);
  return share;
}

template double clip_to_box<2>(const Scene&, const BodySettings&, Samples<2>&);
template double clip_to_box<3>(const Scene&, const BodySettings&, Samples<3>&);

}  // namespace firn
