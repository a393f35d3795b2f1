#include <firn/apps/commands.h>
#include <firn/apps/curve_plot.h>
#include <firn/apps/named_material.h>
#include <firn/core/error.h>
#include <firn/io/atomic_file.h>
#include <firn/materials/point_driver.h>
#include <firn/scene/nearest.h>
#include <fmt/format.h>

#include <memory>

namespace firn {
namespace {

struct PointOptions {
  std::string material, path = "shear", output;
  std::vector<std::string> settings;
  double cell_size = 0.01;  ///< m
  PointRequest request;
};

std::string csv_text(const std::vector<PointState>& states, const ModelInfo& model) {
  std::string text =
      "time [s],strain,stress_xx [Pa],stress_yy [Pa],stress_zz [Pa],stress_xy [Pa],stress_xz [Pa],stress_yz [Pa],"
      "pressure [Pa],von_mises [Pa],volume_ratio,energy [J/m^3],work [J/m^3],wave_speed [m/s]";
  const auto history = history_columns(model, 3);
  for (const HistoryColumn& column : history) {
    text += fmt::format(",{}{}", column.name, column.unit.empty() ? "" : fmt::format(" [{}]", column.unit));
  }
  text += '\n';
  for (const PointState& s : states) {
    text += fmt::format("{:.9g},{:.9g}", s.time, s.strain);
    for (const double stress : s.stress) text += fmt::format(",{:.9g}", stress);
    for (const double value : {s.pressure, s.von_mises, s.volume_ratio, s.energy, s.work, s.wave_speed}) {
      text += fmt::format(",{:.9g}", value);
    }
    for (std::size_t h = 0; h < history.size(); ++h) text += fmt::format(",{:.9g}", s.history[h]);
    text += '\n';
  }
  return text;
}

CurvePlot plot_of(const PointOptions& options, const std::vector<PointState>& states) {
  const bool sheared = options.path == "shear" || options.path == "cyclic";
  CurvePlot plot;
  plot.title = fmt::format("{}, {}, {:g} 1/s", options.material, options.path, options.request.rate);
  plot.x_label = sheared ? "shear strain" : "logarithmic axial strain";
  plot.y_label = "Cauchy stress, Pa";
  plot.curves = {{sheared ? "shear stress" : "axial stress", {}}, {"von Mises stress", {}}, {"pressure", {}}};
  for (const PointState& s : states) {
    plot.x.push_back(s.strain);
    plot.curves[0].y.push_back(sheared ? s.stress[3] : s.stress[0]);
    plot.curves[1].y.push_back(s.von_mises);
    plot.curves[2].y.push_back(s.pressure);
  }
  return plot;
}

void run_point(const PointOptions& options) {
  const auto path = find_point_path(options.path);
  if (!path) {
    const std::vector<std::string> names(kPointPathNames.begin(), kPointPathNames.end());
    throw Error(ErrorKind::usage, fmt::format("no path \"{}\"{}", options.path, suggestion(options.path, names)));
  }
  NamedMaterial material = find_material(options.material);
  apply_settings(options.settings, &material);
  PointRequest request = options.request;
  request.path = *path;
  request.model = model_number(material.model->name);
  request.parameters = material.parameters;
  request.parameters.cell_size = options.cell_size;
  const std::string refusal = material.model->refusal == nullptr ? "" : material.model->refusal(request.parameters);
  if (!refusal.empty()) throw Error(ErrorKind::usage, fmt::format("{}: {}", options.material, refusal));
  const std::vector<PointState> states = drive_point(request);
  const std::string stem =
      options.output.empty() ? fmt::format("{}_{}", options.material, options.path) : options.output;
  write_file_atomically(stem + ".csv", csv_text(states, *material.model));
  write_file_atomically(stem + ".svg", svg_text(plot_of(options, states)));
  const PointState& end = states.back();
  fmt::print("{} {} to a strain of {:.4g}: pressure {:.4g} Pa, von Mises stress {:.4g} Pa, volume {:.4g}\n",
             options.material, options.path, end.strain, end.pressure, end.von_mises, end.volume_ratio);
  fmt::print("{0}.csv {0}.svg\n", stem);
}

}  // namespace

void add_point(CLI::App& program) {
  CLI::App* command = program.add_subcommand("point", "Drive one point of a material and plot its stress");
  const auto options = std::make_shared<PointOptions>();
  PointRequest& request = options->request;
  command->add_option("material", options->material, "Preset or model")->required();
  command->add_option("--path", options->path, "shear, uniaxial, triaxial or cyclic")->capture_default_str();
  command->add_option("--strain", request.strain, "Shear, or logarithm of the axial stretch, to go to")
      ->capture_default_str();
  command->add_option("--rate", request.rate, "Rate of strain, 1/s")->capture_default_str();
  command->add_option("--pressure", request.pressure, "Pressure all round before the path begins, Pa")
      ->capture_default_str();
  command->add_option("--cell-size", options->cell_size, "Of the grid that the point stands for, m")
      ->capture_default_str();
  command->add_option("--steps", request.steps, "Steps of the whole path")->capture_default_str();
  command->add_option("--cycles", request.cycles, "Cycles of the cyclic path")->capture_default_str();
  command->add_option("--set", options->settings, "parameter=value, any number of times")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("-o,--output", options->output, "Path of the files, without .csv and .svg");
  command->callback([options] { run_point(*options); });
}

}  // namespace firn
