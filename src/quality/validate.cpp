// The checks in the order in which each may rely on those before it: sound arrays, tets, facets, boundary, space, CAD.
// A check that fails does not stop the ones after it unless they could not be run at all, because a user wants all
// causes at once.
//
// A mesh whose tets are positive, whose facets pair up on opposite sides, and whose boundary facets neither meet nor
// lie within other tets is embedded: so pairwise tests of tets against tets are not needed.
#include "quality/validate.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "base/gather.h"
#include "quality/checks.h"
#include "quality/measures.h"

namespace curvetet {
namespace checks {
namespace {

constexpr std::size_t kRatioBins = 20, kAngleBins = 18;

/// The part of a quality summary that one block of tets contributes.
struct BlockSummary {
  std::vector<std::size_t> ratio_bins = std::vector<std::size_t>(kRatioBins),
                           angle_bins = std::vector<std::size_t>(kAngleBins);
  double ratio_sum = 0, ratio_low = 2, ratio_high = -1;
  double angle_sum = 0, angle_low = 361, angle_high = -1;
  std::size_t below_half = 0, below_five = 0, worst = 0;
};

std::size_t bin(double value, double range, std::size_t bins) {
  return std::min(bins - 1, static_cast<std::size_t>(value / range * static_cast<double>(bins)));
}

void count_tet(BlockSummary& block, std::size_t t, double ratio, double angle) {
  ++block.ratio_bins[bin(ratio, 1, kRatioBins)];
  ++block.angle_bins[bin(angle, 180, kAngleBins)];
  block.ratio_sum += ratio;
  block.angle_sum += angle;
  block.ratio_low = std::min(block.ratio_low, ratio);
  block.ratio_high = std::max(block.ratio_high, ratio);
  block.angle_high = std::max(block.angle_high, angle);
  if (angle < block.angle_low) {
    block.angle_low = angle;
    block.worst = t;
  }
  block.below_half += angle < 0.5 ? 1 : 0;
  block.below_five += angle < 5 ? 1 : 0;
}

std::array<Vec3, 4> corners(const Mesh& mesh, std::size_t t) {
  const auto& tet = mesh.tets[t];
  return {vec(mesh.points[tet[0]]), vec(mesh.points[tet[1]]), vec(mesh.points[tet[2]]), vec(mesh.points[tet[3]])};
}

}  // namespace

std::string place(Vec3 p) { return fmt::format("({:.10g}, {:.10g}, {:.10g})", p.x, p.y, p.z); }

void Findings::add(const char* check, Severity severity, const std::function<std::string()>& example) {
  auto found = std::find_if(findings_.begin(), findings_.end(), [&](const Finding& f) { return f.check == check; });
  if (found == findings_.end()) found = findings_.insert(found, Finding{check, severity, 0, {}});
  ++found->count;
  if (found->examples.size() < kExamples) found->examples.push_back(example());
}

bool Findings::any(const char* check) const {
  return std::any_of(findings_.begin(), findings_.end(), [&](const Finding& f) { return f.check == check; });
}

bool Findings::any_error() const {
  return std::any_of(findings_.begin(), findings_.end(),
                     [](const Finding& f) { return f.severity == Severity::error; });
}

std::vector<double> solid_volumes(const Mesh& mesh) {
  std::vector<double> volumes(mesh.solids.size(), 0.0);
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const std::array<Vec3, 4> p = corners(mesh, t);
    volumes[mesh.tet_solid[t]] += tet_volume(p[0], p[1], p[2], p[3]);
  }
  return volumes;
}

QualitySummary summarize_quality(const Mesh& mesh, Context& context) {
  std::vector<BlockSummary> blocks((mesh.tets.size() + kLargeBlock - 1) / kLargeBlock);
  in_blocks(context, mesh.tets.size(), kLargeBlock, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const std::array<Vec3, 4> p = corners(mesh, t);
      count_tet(blocks[begin / kLargeBlock], t, radius_ratio(p[0], p[1], p[2], p[3]),
                smallest_dihedral(p[0], p[1], p[2], p[3]));
    }
  });
  BlockSummary total;
  for (const BlockSummary& block : blocks) {
    for (std::size_t i = 0; i < kRatioBins; ++i) total.ratio_bins[i] += block.ratio_bins[i];
    for (std::size_t i = 0; i < kAngleBins; ++i) total.angle_bins[i] += block.angle_bins[i];
    total.ratio_sum += block.ratio_sum;
    total.angle_sum += block.angle_sum;
    total.ratio_low = std::min(total.ratio_low, block.ratio_low);
    total.ratio_high = std::max(total.ratio_high, block.ratio_high);
    total.angle_high = std::max(total.angle_high, block.angle_high);
    if (block.angle_low < total.angle_low) {
      total.angle_low = block.angle_low;
      total.worst = block.worst;
    }
    total.below_half += block.below_half;
    total.below_five += block.below_five;
  }
  QualitySummary summary;
  if (mesh.tets.empty()) return summary;
  const auto n = static_cast<double>(mesh.tets.size());
  summary.radius_ratio = {total.ratio_low, total.ratio_high, total.ratio_sum / n, std::move(total.ratio_bins)};
  summary.dihedral = {total.angle_low, total.angle_high, total.angle_sum / n, std::move(total.angle_bins)};
  summary.below_half_degree = total.below_half;
  summary.below_five_degrees = total.below_five;
  const std::array<Vec3, 4> p = corners(mesh, total.worst);
  const Vec3 centre = 0.25 * (p[0] + p[1] + p[2] + p[3]);
  summary.worst_place = {centre.x, centre.y, centre.z};
  summary.worst_dihedral = total.angle_low;
  return summary;
}

}  // namespace checks

bool ValidationReport::valid() const {
  return std::none_of(findings.begin(), findings.end(), [](const Finding& f) { return f.severity == Severity::error; });
}

ValidationReport validate(const Mesh& mesh, const Model* model, double unit_scale, Context& context) {
  using namespace checks;
  ValidationReport report;
  Findings findings;
  const auto stopped = [&] {
    if (!context.should_stop()) return false;
    findings.add("not_finished", Severity::error, [] { return std::string("stopped before all checks were made"); });
    report.findings = findings.take();
    return true;
  };
  if (check_arrays(mesh, findings)) {
    if (stopped()) return report;
    Topology topology = check_tets(mesh, context, findings);
    check_nodes(mesh, topology, findings);
    check_triangles(mesh, topology, findings);
    check_closedness(mesh, model, topology, findings);
    if (stopped()) return report;
    const BoxTree boundary = tree_of_boundary(mesh, topology);
    check_self_intersection(mesh, topology, boundary, context, findings);
    check_overlap(mesh, topology, boundary, context, findings);
    if (stopped()) return report;
    report.solid_volumes = solid_volumes(mesh);
    report.quality = summarize_quality(mesh, context);
    if (report.quality.below_five_degrees > 0) find_forced_angles(mesh, model, unit_scale, report.quality);
    if (model != nullptr) {
      check_against_model(mesh, *model, unit_scale, topology, report.solid_volumes, context, findings);
    }
    if (stopped()) return report;
  }
  report.findings = findings.take();
  return report;
}

}  // namespace curvetet
