// Long lists are cut: the report has them in full.
#include "summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

namespace curvetet::cli {

namespace {

constexpr std::size_t kMostLines = 8;
constexpr std::size_t kMostIds = 20;

std::string line(const std::string& what, const std::string& text) { return fmt::format("  {:<15} {}\n", what, text); }

std::string place(const Point& p) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", p[0], p[1], p[2]); }

nlohmann::json options_of(const Report& report) { return nlohmann::json::parse(report.options_json, nullptr, false); }

std::string size_line(const Report& report) {
  const auto options = options_of(report);
  if (!options.is_object() || !options.contains("size") || !options["size"].is_number()) return {};
  const bool by_default = options.value("size_is_default", false);
  return line("size", fmt::format("{:.4g} {}{}", options["size"].get<double>(), report.unit,
                                  by_default ? " (default: a tenth of the body's diagonal)" : ""));
}

std::string solid_lines(const Report& report) {
  std::string text;
  for (std::size_t i = 0; i < std::min(report.solids.size(), kMostLines); ++i) {
    const SolidReport& solid = report.solids[i];
    std::string volume = fmt::format("volume {:.6g} {}^3", solid.volume, report.unit);
    if (solid.cad_volume > 0) {
      const double percent = 100 * (solid.volume - solid.cad_volume) / solid.cad_volume;
      volume += fmt::format(" (CAD {:.6g}, {})", solid.cad_volume,
                            std::abs(percent) < 0.005 ? "equal to 0.01 %" : fmt::format("{:+.2f} %", percent));
    }
    text += line(solid.name, fmt::format("{}, {} tetrahedra", volume, solid.tets));
  }
  if (report.solids.size() > kMostLines)
    text += line("", fmt::format("and {} more solids", report.solids.size() - kMostLines));
  return text;
}

std::string ids(const char* one, const char* many, const std::vector<std::uint32_t>& ids) {
  return fmt::format("{} {}", ids.size() == 1 ? one : many, fmt::join(ids, ", "));
}

/// Which edges and faces were suppressed; nothing if there are none.
std::string suppressed_line(const Report& report) {
  if (report.suppressed.empty()) return {};
  std::string kinds;
  for (const auto& [kind, many] : {std::pair("edge", "edges"), std::pair("face", "faces")}) {
    std::vector<std::uint32_t> found;
    for (const SuppressedReport& detail : report.suppressed)
      if (detail.kind == kind) found.push_back(detail.cad_id);
    const std::size_t more = found.size() - std::min(found.size(), kMostIds);
    found.resize(found.size() - more);
    if (!found.empty()) kinds += (kinds.empty() ? "" : "; ") + ids(kind, many, found);
    if (more > 0) kinds += fmt::format(" and {} more", more);
  }
  return line("suppressed", fmt::format("{} detail{} below {:.4g} {}: {}", report.suppressed.size(),
                                        report.suppressed.size() == 1 ? "" : "s",
                                        options_of(report).value("min_feature", 0.0), report.unit, kinds));
}

/// Small angles that are the body's own; nothing if there are none.
std::string forced_lines(const Report& report) {
  std::string text;
  for (std::size_t i = 0; i < std::min(report.forced_angles.size(), kMostLines); ++i) {
    const ForcedAngleReport& f = report.forced_angles[i];
    const std::string where = f.vertex != 0 ? fmt::format("at vertex {} of {}", f.vertex, ids("face", "faces", f.faces))
                                            : "along " + ids("edge", "edges", f.edges);
    text += line(
        i == 0 ? "forced" : "",
        fmt::format("{} of them by the body: {} meet at {:.2f} degrees {}", f.tets,
                    f.vertex != 0 ? ids("edge", "edges", f.edges) : ids("face", "faces", f.faces), f.angle, where));
  }
  if (report.forced_angles.size() > kMostLines)
    text += line("", fmt::format("and {} more; see the report", report.forced_angles.size() - kMostLines));
  return text;
}

std::string reduction_lines(const Report& report) {
  if (report.reductions.empty()) return line("reductions", "none: the size is as asked everywhere");
  std::string text;
  for (std::size_t i = 0; i < std::min(report.reductions.size(), kMostLines); ++i) {
    const ReductionReport& r = report.reductions[i];
    std::string words = fmt::format("face {}", r.face);
    if (r.other != 0) words += fmt::format(" to face {}", r.other);
    words += fmt::format(": {}, size {:.4g}", r.reason, r.size);
    if (r.gap > 0) words += fmt::format(", gap {:.4g}", r.gap);
    text += line(i == 0 ? "reductions" : "", words + " at " + place(r.where));
  }
  if (report.reductions.size() > kMostLines) {
    text += line("", fmt::format("and {} more; see the report", report.reductions.size() - kMostLines));
  }
  return text;
}

std::string time_line(const Report& report) {
  std::vector<StageTime> stages = report.stages;
  std::stable_sort(stages.begin(), stages.end(), [](const auto& a, const auto& b) { return a.seconds > b.seconds; });
  double total = 0;
  for (const StageTime& stage : stages) total += stage.seconds;
  std::string text = fmt::format("{:.2f} s", total);
  for (std::size_t i = 0; i < std::min<std::size_t>(stages.size(), 4); ++i) {
    text += fmt::format("{}{} {:.2f}", i == 0 ? ": " : ", ", stages[i].stage, stages[i].seconds);
  }
  if (report.peak_bytes > 0)
    text += fmt::format("; {:.0f} MB of memory at most", static_cast<double>(report.peak_bytes) / 1e6);
  return line("time", text);
}

}  // namespace

std::string summary(const Report& report) {
  const bool converted = !report.file_unit.empty() && report.file_unit != report.unit;
  std::string text =
      fmt::format("{} ({}{})\n", report.input, report.unit, converted ? ", in the file " + report.file_unit : "");
  text += size_line(report);
  text += suppressed_line(report);
  text += line("counts", fmt::format("{} points, {} tetrahedra, {} boundary triangles", report.points, report.tets,
                                     report.triangles));
  text += solid_lines(report);
  text +=
      line("worst dihedral", fmt::format("{:.2f} degrees at {}; {} tetrahedra below 5 degrees", report.worst_dihedral,
                                         place(report.worst_place), report.tets_below_five_degrees));
  text += forced_lines(report);
  text += reduction_lines(report);
  text += line("rounds", report.rounds == 0 ? "0: no restart with smaller sizes was needed"
                                            : fmt::format("{} restart{} with smaller sizes", report.rounds,
                                                          report.rounds == 1 ? "" : "s"));
  text += time_line(report);
  for (std::size_t i = 0; i < std::min(report.warnings.size(), kMostLines); ++i)
    text += line("warning", report.warnings[i]);
  text += line("verdict", report.valid ? "valid" : "NOT VALID");
  return text;
}

}  // namespace curvetet::cli
