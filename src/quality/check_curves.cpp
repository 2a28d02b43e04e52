// Each CAD edge must be there as a chain of labelled segments: from one end to the other (once round if closed), every
// node on the curve, ever onwards in the parameter, each link a fair chord, and each link shared by as many triangles
// of each face as the face uses the edge. Seams are no constraints of the mesh: their segments, if any, only have to
// lie on the curve.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "quality/model_checks.h"

namespace curvetet::checks {
namespace {

/// Arc over chord at most this: half a circle passes, nothing longer.
constexpr double kFairChord = 1.6;
constexpr int kArcSamples = 16;
constexpr int kLengthSamples = 64;
constexpr int kManySamples = 4096;

using Segment = std::array<std::uint32_t, 2>;

Segment ordered(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

/// {edge, face entity} of every side of every boundary triangle, sorted.
std::vector<std::pair<Segment, std::uint32_t>> triangle_sides(const MeshOnModel& m) {
  std::vector<std::pair<Segment, std::uint32_t>> sides;
  sides.reserve(m.mesh.triangles.size() * 3);
  for (std::size_t t = 0; t < m.mesh.triangles.size(); ++t) {
    const auto& v = m.mesh.triangles[t];
    const std::uint32_t face = m.faces[m.mesh.triangle_face[t]].value();
    sides.emplace_back(ordered(v[0], v[1]), face);
    sides.emplace_back(ordered(v[1], v[2]), face);
    sides.emplace_back(ordered(v[2], v[0]), face);
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

/// How often a face uses an edge, counting an embedded edge twice, for it has triangles of the face on both sides.
int uses_of_edge(const ModelFace& face, EdgeId edge) {
  int uses = 0;
  for (const Loop& loop : face.loops) {
    for (const EdgeUse& use : loop.uses) uses += use.edge == edge ? 1 : 0;
  }
  for (const EdgeUse& use : face.internal_edges) uses += use.edge == edge ? 2 : 0;
  return uses;
}

bool is_seam(const Model& model, EdgeId id) {
  for (const FaceId f : model.edges[id].faces) {
    for (const Loop& loop : model.faces[f].loops) {
      for (const EdgeUse& use : loop.uses) {
        if (use.edge == id && use.seam) return true;
      }
    }
  }
  return false;
}

double arc_length(const Curve& curve, double from, double to, int samples) {
  double length = 0;
  Vec3 last = curve.value(from);
  for (int i = 1; i <= samples; ++i) {
    const Vec3 next = curve.value(from + (to - from) * i / samples);
    length += distance(last, next);
    last = next;
  }
  return length;
}

/// Parameter of the curve's sample closest to a point, refined. Closely wound curves need many samples.
double closest_parameter(const Curve& curve, const ModelEdge& edge, Vec3 p, int samples) {
  double best = edge.low, best2 = norm2(curve.value(edge.low) - p);
  for (int i = 1; i <= samples; ++i) {
    const double t = edge.low + (edge.high - edge.low) * i / samples;
    const double d2 = norm2(curve.value(t) - p);
    if (d2 < best2) {
      best2 = d2;
      best = t;
    }
  }
  return curve.project(p, best, edge.low, edge.high);
}

struct Fault {
  const char* check;
  std::string what;
};

/// One CAD edge's task.
class EdgeTask {
 public:
  EdgeTask(const MeshOnModel& m, EdgeId id, std::vector<Segment> segments,
           const std::vector<std::pair<Segment, std::uint32_t>>& sides)
      : m_(m),
        id_(id),
        edge_(m.model.edges[id]),
        curve_(edge_.curve->clone()),
        segments_(std::move(segments)),
        sides_(sides) {}

  std::vector<Fault> run() {
    check_nodes();
    if (is_seam(m_.model, id_)) return std::move(faults_);
    if (segments_.empty()) {
      const double length = arc_length(*curve_, edge_.low, edge_.high, kLengthSamples);
      if (length > 4 * std::max(m_.least_limit, 10 * edge_.tolerance)) fault("edge_without_segments", "no segments");
      return std::move(faults_);
    }
    for (const Segment& s : segments_) check_sides(s);
    if (order_chain()) check_chain();
    return std::move(faults_);
  }

 private:
  void fault(const char* check, const std::string& what) {
    faults_.push_back({check, fmt::format("edge {}: {}", edge_.label.cad_id, what)});
  }
  std::string node_place(std::uint32_t node) const { return place(vec(m_.mesh.points[node])); }

  void check_nodes() {
    for (const Segment& s : segments_) {
      for (const std::uint32_t node : s) nodes_.push_back(node);
    }
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    for (const std::uint32_t node : nodes_) {
      const double limit = m_.limit(edge_.tolerance, node);
      const auto off = [&](double t) { return distance(curve_->value(t), m_.points[node]); };
      double t = first_parameter(node);
      if (!(off(t) <= limit)) t = closest_parameter(*curve_, edge_, m_.points[node], kLengthSamples);
      if (!(off(t) <= limit)) t = closest_parameter(*curve_, edge_, m_.points[node], kManySamples);
      parameters_.push_back(t);
      if (off(t) <= limit) continue;
      fault("vertex_off_edge",
            fmt::format("node {} is {:.3g} off at {}", node, m_.to_mesh_length(off(t)), node_place(node)));
    }
  }

  /// From the parameter stored with the node, if it says to lie on this edge.
  double first_parameter(std::uint32_t node) const {
    if (node < m_.mesh.nodes.size()) {
      const NodeOnCad& owner = m_.mesh.nodes[node];
      if (owner.dimension == 1 && owner.entity < m_.edges.size() && m_.edges[owner.entity] == id_) {
        const double guess = std::clamp(edge_.from_own_parameter(owner.parameter[0]), edge_.low, edge_.high);
        return curve_->project(m_.points[node], guess, edge_.low, edge_.high);
      }
    }
    return closest_parameter(*curve_, edge_, m_.points[node], kLengthSamples);
  }

  /// Number of triangles at a segment, face by face.
  void check_sides(const Segment& s) {
    const Segment key = ordered(s[0], s[1]);
    for (const FaceId f : edge_.faces) {
      const ModelFace& face = m_.model.faces[f];
      if (!face.front.valid() && !face.back.valid()) continue;
      const auto range = std::equal_range(sides_.begin(), sides_.end(), std::pair{key, f.value()});
      const auto triangles = range.second - range.first;
      const int uses = uses_of_edge(face, id_);
      if (triangles == uses) continue;
      fault("segment_triangles", fmt::format("segment {} {} has {} triangles of face {} instead of {}, at {}", s[0],
                                             s[1], triangles, face.label.cad_id, uses, node_place(s[0])));
    }
  }

  std::size_t index_of(std::uint32_t node) const {
    return static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
  }

  /// Sorts the segments into one chain by their nodes.
  bool order_chain() {
    std::vector<std::vector<std::uint32_t>> next(nodes_.size());
    for (const Segment& s : segments_) {
      next[index_of(s[0])].push_back(s[1]);
      next[index_of(s[1])].push_back(s[0]);
    }
    const bool closed = edge_.start == edge_.end;
    const Vec3 start = m_.model.vertices[edge_.start].point;
    std::uint32_t first = kOutside;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      if (next[i].size() > 2) return broken(nodes_[i]);
      if (!closed && next[i].size() != 1) continue;
      if (first == kOutside || norm2(m_.points[nodes_[i]] - start) < norm2(m_.points[first] - start)) first = nodes_[i];
    }
    if (first == kOutside) return broken(nodes_[0]);
    chain_ = {first};
    std::uint32_t previous = kOutside, here = first;
    while (chain_.size() <= segments_.size()) {
      const auto& ways = next[index_of(here)];
      if (ways.size() == 1 && ways[0] == previous) break;
      const std::uint32_t there = ways[0] == previous ? ways[1] : ways[0];
      chain_.push_back(there);
      previous = here;
      here = there;
    }
    if (chain_.size() != segments_.size() + 1 || (closed && chain_.back() != first)) return broken(here);
    return true;
  }

  bool broken(std::uint32_t node) {
    fault("edge_not_a_chain", fmt::format("broken at node {} at {}", node, node_place(node)));
    return false;
  }

  /// Is the chord not much shorter than its arc, or the arc nowhere farther from it than the edge's tolerance? Within
  /// that real curves double back.
  bool is_fair(double from, double to) const {
    const Vec3 a = curve_->value(from), along = curve_->value(to) - a;
    if (arc_length(*curve_, from, to, kArcSamples) <= kFairChord * norm(along)) return true;
    for (int k = 1; k < kArcSamples; ++k) {
      const Vec3 p = curve_->value(from + (to - from) * k / kArcSamples) - a;
      const double share = norm2(along) > 0 ? std::clamp(dot(p, along) / norm2(along), 0.0, 1.0) : 0;
      if (norm(p - share * along) > edge_.tolerance) return false;
    }
    return true;
  }

  void check_chain() {
    const auto check_end = [&](std::uint32_t node, CadVertexId v) {
      const ModelVertex& vertex = m_.model.vertices[v];
      if (distance(m_.points[node], vertex.point) <= m_.limit(vertex.tolerance, node)) return;
      fault("edge_not_a_chain",
            fmt::format("ends at node {}, not at vertex {}, at {}", node, vertex.label.cad_id, node_place(node)));
    };
    check_end(chain_.front(), edge_.start);
    check_end(chain_.back(), edge_.end);
    std::vector<double> t;
    for (const std::uint32_t node : chain_) t.push_back(parameters_[index_of(node)]);
    t.front() = edge_.low;
    t.back() = edge_.high;
    if (edge_.start == edge_.end && t.size() > 2 && t[1] > t[t.size() - 2]) std::reverse(t.begin() + 1, t.end() - 1);
    for (std::size_t i = 0; i + 1 < t.size(); ++i) {
      const std::uint32_t node = chain_[i];
      if (!(t[i] < t[i + 1])) {
        fault("edge_not_a_chain", fmt::format("runs backwards at node {} at {}", node, node_place(node)));
        return;
      }
      if (is_fair(t[i], t[i + 1])) continue;
      fault("unfair_chord",
            fmt::format("the arc after node {} is too long for its chord, at {}", node, node_place(node)));
    }
  }

  const MeshOnModel& m_;
  EdgeId id_;
  const ModelEdge& edge_;
  std::unique_ptr<Curve> curve_;
  std::vector<Segment> segments_;
  const std::vector<std::pair<Segment, std::uint32_t>>& sides_;
  std::vector<std::uint32_t> nodes_;
  std::vector<double> parameters_;  ///< by nodes_
  std::vector<std::uint32_t> chain_;
  std::vector<Fault> faults_;
};

bool bounds_a_solid(const Model& model, const ModelEdge& edge) {
  return std::any_of(edge.faces.begin(), edge.faces.end(),
                     [&](FaceId f) { return model.faces[f].front.valid() || model.faces[f].back.valid(); });
}

}  // namespace

void check_curves(const MeshOnModel& m, Context& context, Findings& findings) {
  IndexedVector<EdgeId, std::vector<Segment>> segments(m.model.edges.size());
  for (std::size_t i = 0; i < m.mesh.segments.size(); ++i) {
    const EdgeId e = m.edges[m.mesh.segment_edge[i]];
    if (e.valid()) segments[e].push_back(m.mesh.segments[i]);
  }
  const auto sides = triangle_sides(m);
  IndexedVector<EdgeId, std::vector<Fault>> faults(m.model.edges.size());
  parallel_for(context, m.model.edges.size(), [&](std::size_t i) {
    const ModelEdge& edge = m.model.edges[EdgeId(i)];
    if (edge.degenerate || !edge.curve || !bounds_a_solid(m.model, edge) || context.should_stop()) return;
    faults[EdgeId(i)] = EdgeTask(m, EdgeId(i), std::move(segments[EdgeId(i)]), sides).run();
  });
  for (const auto& of_edge : faults) {
    for (const Fault& fault : of_edge) findings.add(fault.check, Severity::error, [&] { return fault.what; });
  }
}

}  // namespace curvetet::checks
