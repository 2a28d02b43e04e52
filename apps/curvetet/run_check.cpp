// `curvetet check`: the independent check of a mesh file, alone or against its CAD.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/units.h"
#include "cad/load.h"
#include "commands.h"
#include "own_program.h"
#include "quality/validate.h"
#include "quality/validate_parts.h"
#include "terminal.h"

namespace curvetet::cli {

namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

std::string as_json(const Mesh& mesh, const ValidationReport& report) {
  Json findings = Json::array();
  for (const Finding& finding : report.findings) {
    findings.push_back({{"check", finding.check},
                        {"severity", finding.severity == Severity::error ? "error" : "warning"},
                        {"count", finding.count},
                        {"examples", finding.examples}});
  }
  Json solids = Json::array();
  for (std::size_t i = 0; i < report.solid_volumes.size() && i < mesh.solids.size(); ++i) {
    solids.push_back(
        {{"solid", mesh.solids[i].cad_id}, {"name", mesh.solids[i].name}, {"volume", number(report.solid_volumes[i])}});
  }
  const QualitySummary& quality = report.quality;
  const Json json = {
      {"schema", 1},
      {"valid", report.valid()},
      {"unit", mesh.unit},
      {"counts",
       {{"points", mesh.points.size()},
        {"tets", mesh.tets.size()},
        {"triangles", mesh.triangles.size()},
        {"segments", mesh.segments.size()}}},
      {"findings", findings},
      {"quality",
       {{"worst_dihedral", number(quality.worst_dihedral)},
        {"worst_place",
         {number(quality.worst_place[0]), number(quality.worst_place[1]), number(quality.worst_place[2])}},
        {"tets_below_half_degree", quality.below_half_degree},
        {"tets_below_five_degrees", quality.below_five_degrees},
        {"forced_below_half_degree", quality.forced_below_half},
        {"forced_below_five_degrees", quality.forced_below_five},
        {"mean_radius_ratio", number(quality.radius_ratio.mean)},
        {"radius_ratio_histogram", quality.radius_ratio.bins},
        {"dihedral_histogram", quality.dihedral.bins}}},
      {"solids", solids}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string as_words(const Mesh& mesh, const ValidationReport& report) {
  std::string text =
      fmt::format("{} points, {} tetrahedra, {} boundary triangles{}{}\n", mesh.points.size(), mesh.tets.size(),
                  mesh.triangles.size(), mesh.unit.empty() ? "" : ", unit ", mesh.unit);
  for (const Finding& finding : report.findings) {
    text += fmt::format("{}: {} x {}\n", finding.severity == Severity::error ? "error" : "warning", finding.count,
                        finding.check);
    for (const std::string& example : finding.examples) text += fmt::format("    {}\n", example);
  }
  for (std::size_t i = 0; i < report.solid_volumes.size() && i < mesh.solids.size(); ++i) {
    text += fmt::format("{}: volume {:.9g}\n", mesh.solids[i].name, report.solid_volumes[i]);
  }
  const Point& worst = report.quality.worst_place;
  if (!mesh.tets.empty()) {
    text += fmt::format(
        "worst dihedral angle {:.3f} degrees at ({:.6g}, {:.6g}, {:.6g}); {} tetrahedra below 5 degrees, {} of "
        "them by the body's own angles\n",
        report.quality.worst_dihedral, worst[0], worst[1], worst[2], report.quality.below_five_degrees,
        report.quality.forced_below_five);
  }
  return text + (report.valid() ? "valid\n" : "NOT VALID\n");
}

/// Length in the mesh of a unit of the CAD; 1 if one of the two does not say its unit.
double scale_of(const CheckCommand& command, const Mesh& mesh, const Model& model) {
  if (command.unit_scale) return *command.unit_scale;
  const std::optional<double> cad = millimetres(model.unit), own = millimetres(mesh.unit);
  return cad && own ? *cad / *own : 1;
}

/// It is in the unit of the mesh.
Length min_feature_of(const CheckCommand& command, const Mesh& mesh) {
  if (command.unit_scale) return {command.min_feature / *command.unit_scale};
  return {command.min_feature, millimetres(mesh.unit) ? mesh.unit : ""};
}

}  // namespace

int run_check(const CheckCommand& command) {
  if (command.unit_scale && !(std::isfinite(*command.unit_scale) && *command.unit_scale > 0)) {
    return show_error({ErrorCode::bad_option, fmt::format("unit-scale must be positive, not {}", *command.unit_scale)});
  }
  Context context;
  Terminal terminal(Volume::quiet);
  terminal.attach(context);
  const CancelOnSignal signals(context);
  context.threads = command.threads;
  const Result<Mesh> mesh = read_mesh(command.mesh);
  if (!mesh) return show_error(mesh.error());
  std::optional<Model> model;
  if (!command.cad.empty()) {
    LoadOptions options;
    options.input_unit = command.input_unit;
    options.isolate = command.isolate;
    options.helper = own_program();
    options.joining = command.joining;
    options.min_feature = min_feature_of(command, mesh.value());
    Result<Model> loaded = load_model(command.cad, options, context);
    if (!loaded) return show_error(loaded.error());
    model = std::move(loaded.value());
  }
  const double scale = model ? scale_of(command, mesh.value(), *model) : 1;
  const bool apart = command.joining.conformal == Conformal::off;
  const ValidationReport report =
      (apart ? validate_parts : validate)(mesh.value(), model ? &*model : nullptr, scale, context);
  if (context.should_stop()) return show_error(context.stop_error("the check"));
  fmt::print("{}", command.json ? as_json(mesh.value(), report) : as_words(mesh.value(), report));
  return report.valid() ? 0 : exit_code(ErrorCode::invalid_mesh);
}

}  // namespace curvetet::cli
