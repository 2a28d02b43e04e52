#include "quality/validate_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "geometry/parts.h"
#include "quality/checks.h"

namespace curvetet {
namespace checks {
namespace {

/// Nodes that elements join, by the smallest node of each group.
class NodeGroups {
 public:
  explicit NodeGroups(const Mesh& mesh) : leader_(mesh.points.size()) {
    std::iota(leader_.begin(), leader_.end(), 0U);
    join(mesh.tets);
    join(mesh.triangles);
    join(mesh.segments);
  }
  std::uint32_t of(std::uint32_t node) {
    while (leader_[node] != node) node = leader_[node] = leader_[leader_[node]];
    return node;
  }

 private:
  template <class Elements>
  void join(const Elements& elements) {
    for (const auto& element : elements) {
      for (const std::uint32_t node : element) {
        const auto [low, high] = std::minmax({of(element[0]), of(node)});
        leader_[high] = low;
      }
    }
  }
  std::vector<std::uint32_t> leader_;
};

/// Entities that a part uses, numbered anew.
class Kept {
 public:
  explicit Kept(const std::vector<Entity>& all) : all_(all), own_(all.size(), kOutside) {}
  std::uint32_t own(std::uint32_t entity) {
    if (own_[entity] == kOutside) {
      own_[entity] = static_cast<std::uint32_t>(kept_.size());
      kept_.push_back(all_[entity]);
      of_all_.push_back(entity);
    }
    return own_[entity];
  }
  std::vector<Entity> take() { return std::move(kept_); }
  const std::vector<std::uint32_t>& of_all() const { return of_all_; }

 private:
  const std::vector<Entity>& all_;
  std::vector<std::uint32_t> own_, of_all_;
  std::vector<Entity> kept_;
};

struct MeshPart {
  Mesh mesh;
  std::vector<std::uint32_t> solids, faces, edges, vertices;  ///< of the whole, by the part's entities
};

/// Elements of each part by their numbers in the whole.
struct Elements {
  std::vector<std::uint32_t> points, tets, triangles, segments;
};

class MeshParts {
 public:
  explicit MeshParts(const Mesh& mesh) : mesh_(mesh), own_(mesh.points.size(), 0) {
    NodeGroups groups(mesh);
    std::map<std::uint32_t, std::size_t> part_of;
    const auto part = [&](std::uint32_t node) -> Elements& {
      const auto at = part_of.emplace(groups.of(node), parts_.size()).first->second;
      if (at == parts_.size()) parts_.emplace_back();
      return parts_[at];
    };
    for (std::uint32_t i = 0; i < mesh.tets.size(); ++i) part(mesh.tets[i][0]).tets.push_back(i);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) part(mesh.triangles[i][0]).triangles.push_back(i);
    for (std::uint32_t i = 0; i < mesh.segments.size(); ++i) part(mesh.segments[i][0]).segments.push_back(i);
    if (parts_.empty()) parts_.emplace_back();
    for (std::uint32_t i = 0; i < mesh.points.size(); ++i) {
      const auto found = part_of.find(groups.of(i));
      parts_[found == part_of.end() ? 0 : found->second].points.push_back(i);
    }
  }

  std::size_t size() const { return parts_.size(); }

  MeshPart make(std::size_t at) {
    const Elements& elements = parts_[at];
    MeshPart part;
    Kept solids(mesh_.solids), faces(mesh_.faces), edges(mesh_.edges), vertices(mesh_.vertices);
    part.mesh.unit = mesh_.unit;
    for (const std::uint32_t p : elements.points) {
      own_[p] = static_cast<std::uint32_t>(part.mesh.points.size());
      part.mesh.points.push_back(mesh_.points[p]);
    }
    take(elements.tets, mesh_.tets, mesh_.tet_solid, solids, part.mesh.tets, part.mesh.tet_solid);
    take(elements.triangles, mesh_.triangles, mesh_.triangle_face, faces, part.mesh.triangles, part.mesh.triangle_face);
    take(elements.segments, mesh_.segments, mesh_.segment_edge, edges, part.mesh.segments, part.mesh.segment_edge);
    for (const std::uint32_t p : elements.points) {
      if (p >= mesh_.nodes.size()) break;
      NodeOnCad node = mesh_.nodes[p];
      if (node.dimension == 3) {
        node.entity = 0;  // inside one of the part's solids; checks do not ask which
      } else {
        node.entity = (node.dimension == 0 ? vertices : node.dimension == 1 ? edges : faces).own(node.entity);
      }
      if (node.dimension == 0) {
        part.mesh.corner_nodes.resize(vertices.of_all().size());
        part.mesh.corner_nodes[node.entity] = own_[p];
      }
      part.mesh.nodes.push_back(node);
    }
    part.solids = solids.of_all(), part.faces = faces.of_all(), part.edges = edges.of_all();
    part.vertices = vertices.of_all();
    part.mesh.solids = solids.take(), part.mesh.faces = faces.take(), part.mesh.edges = edges.take();
    part.mesh.vertices = vertices.take();
    return part;
  }

 private:
  template <std::size_t N>
  void take(const std::vector<std::uint32_t>& which, const std::vector<std::array<std::uint32_t, N>>& all,
            const std::vector<std::uint32_t>& entity_of, Kept& kept, std::vector<std::array<std::uint32_t, N>>& into,
            std::vector<std::uint32_t>& entities) {
    for (const std::uint32_t i : which) {
      into.push_back(all[i]);
      for (std::uint32_t& node : into.back()) node = own_[node];
      entities.push_back(kept.own(entity_of[i]));
    }
  }

  const Mesh& mesh_;
  std::vector<Elements> parts_;
  std::vector<std::uint32_t> own_;  ///< number of a node in its part
};

void add(Histogram& sum, const Histogram& more, double share_before, double share_more) {
  if (more.bins.empty()) return;
  if (sum.bins.empty()) {
    sum = more;
    return;
  }
  for (std::size_t i = 0; i < sum.bins.size(); ++i) sum.bins[i] += more.bins[i];
  sum.mean = (share_before * sum.mean + share_more * more.mean) / (share_before + share_more);
  sum.smallest = std::min(sum.smallest, more.smallest);
  sum.largest = std::max(sum.largest, more.largest);
}

class PartsValidation {
 public:
  PartsValidation(const Mesh& mesh, const Model* model, double unit_scale, Context& context)
      : mesh_(mesh), model_(model), unit_scale_(unit_scale), context_(context) {
    sum_.solid_volumes.assign(mesh.solids.size(), 0);
    if (model_ == nullptr) return;
    for (std::size_t s = 0; s < model_->solids.size(); ++s)
      solid_of_.emplace(model_->solids[SolidId(s)].label.cad_id, SolidId(s));
  }

  ValidationReport run() {
    MeshParts parts(mesh_);
    for (std::size_t i = 0; i < parts.size(); ++i) {  // once stopped, each tells that it was not finished
      const MeshPart part = parts.make(i);
      const std::vector<SolidId> solids = solids_of(part);
      if (solids.empty()) {
        add(part, validate(part.mesh, nullptr, unit_scale_, context_));
      } else {
        const Part of_model = make_part(*model_, solids);
        add(part, validate(part.mesh, &of_model.model, unit_scale_, context_));
      }
    }
    add_missing_solids();
    return std::move(sum_);
  }

 private:
  std::vector<SolidId> solids_of(const MeshPart& part) {
    std::vector<SolidId> solids;
    for (const std::uint32_t s : part.solids) {
      const auto found = solid_of_.find(mesh_.solids[s].cad_id);
      if (found == solid_of_.end()) continue;
      solids.push_back(found->second);
      met_.push_back(found->second);
    }
    std::sort(solids.begin(), solids.end());
    return solids;
  }

  void add(const MeshPart& part, const ValidationReport& report) {
    for (const Finding& finding : report.findings) add(part, finding);
    for (std::size_t s = 0; s < report.solid_volumes.size(); ++s)
      sum_.solid_volumes[part.solids[s]] += report.solid_volumes[s];
    add_quality(part, report.quality);
    tets_ += part.mesh.tets.size();
  }

  void add(const MeshPart& part, const Finding& finding) {
    auto found = std::find_if(sum_.findings.begin(), sum_.findings.end(), [&](const Finding& f) {
      return f.check == finding.check && f.severity == finding.severity;
    });
    if (found == sum_.findings.end())
      found = sum_.findings.insert(found, Finding{finding.check, finding.severity, 0, {}});
    found->count += finding.count;
    const std::string who =
        part.solids.empty() ? "" : fmt::format("solid {} alone: ", mesh_.solids[part.solids.front()].cad_id);
    for (const std::string& example : finding.examples)
      if (found->examples.size() < kExamples) found->examples.push_back(who + example);
  }

  void add_quality(const MeshPart& part, const QualitySummary& more) {
    QualitySummary& sum = sum_.quality;
    if (part.mesh.tets.empty()) return;
    const auto before = static_cast<double>(tets_), here = static_cast<double>(part.mesh.tets.size());
    if (tets_ == 0 || more.worst_dihedral < sum.worst_dihedral) {
      sum.worst_dihedral = more.worst_dihedral;
      sum.worst_place = more.worst_place;
    }
    checks::add(sum.radius_ratio, more.radius_ratio, before, here);
    checks::add(sum.dihedral, more.dihedral, before, here);
    sum.below_half_degree += more.below_half_degree;
    sum.below_five_degrees += more.below_five_degrees;
    sum.forced_below_half += more.forced_below_half;
    sum.forced_below_five += more.forced_below_five;
    for (ForcedAngle forced : more.forced) {
      for (std::uint32_t& f : forced.faces) f = part.faces[f];
      for (std::uint32_t& e : forced.edges) e = part.edges[e];
      if (forced.vertex) forced.vertex = part.vertices[*forced.vertex];
      sum.forced.push_back(std::move(forced));
    }
  }

  void add_missing_solids() {
    if (model_ == nullptr) return;
    std::sort(met_.begin(), met_.end());
    Findings missing;
    for (std::size_t s = 0; s < model_->solids.size(); ++s) {
      if (std::binary_search(met_.begin(), met_.end(), SolidId(s))) continue;
      missing.add("empty_solid", Severity::error,
                  [&] { return fmt::format("solid {}", model_->solids[SolidId(s)].label.cad_id); });
    }
    for (const Finding& finding : missing.take()) sum_.findings.push_back(finding);
  }

  const Mesh& mesh_;
  const Model* model_;
  double unit_scale_;
  Context& context_;
  std::map<std::uint32_t, SolidId> solid_of_;  ///< by cad id
  std::vector<SolidId> met_;
  std::size_t tets_ = 0;
  ValidationReport sum_;
};

}  // namespace
}  // namespace checks

ValidationReport validate_parts(const Mesh& mesh, const Model* model, double unit_scale, Context& context) {
  checks::Findings unsound;
  if (!checks::check_arrays(mesh, unsound)) {
    ValidationReport report;
    report.findings = unsound.take();
    return report;
  }
  return checks::PartsValidation(mesh, model, unit_scale, context).run();
}

}  // namespace curvetet
