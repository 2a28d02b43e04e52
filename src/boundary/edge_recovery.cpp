// A segment that the Delaunay tetrahedralization lacks is reconnected by flips where that works, since that adds
// nothing; otherwise it is split on its curve, in every triangulation at once. Kept segments survive all later
// insertions, so one pass over a queue is enough.
#include "boundary/edge_recovery.h"

#include <fmt/format.h>

#include <deque>

#include "boundary/fill_holes.h"
#include "spatial/flips.h"

namespace curvetet {

namespace {

class EdgeRecovery {
 public:
  EdgeRecovery(Conjoint& conjoint, const EdgeRecoveryOptions& options, Context& context)
      : conjoint_(conjoint), tets_(*conjoint.tets()), options_(options), context_(context) {}

  Result<EdgeRecoveryResult> run() {
    const auto segments = conjoint_.segments();
    std::deque<Conjoint::Segment> queue(segments.begin(), segments.end());
    keep_present(segments);
    while (!queue.empty()) {
      if (context_.should_stop()) return context_.stop_error("edge recovery");
      const Conjoint::Segment s = queue.front();
      queue.pop_front();
      if (conjoint_.segment_edge(s.a, s.b) != s.edge) continue;
      if (present(s) && !(options_.split_encroached && encroached(s))) continue;
      if (!present(s) && options_.flips && recover_edge_by_flips(tets_, s.a, s.b)) {
        tets_.keep_segment(s.a, s.b);
        ++result_.flipped;
        continue;
      }
      split(s, queue);
    }
    return result_;
  }

 private:
  void keep_present(const std::vector<Conjoint::Segment>& segments) {
    for (const Conjoint::Segment& s : segments) present(s);
  }

  bool present(const Conjoint::Segment& s) {
    if (tets_.is_kept(s.a, s.b)) return true;
    if (!tets_.find_edge(s.a, s.b)) return false;
    tets_.keep_segment(s.a, s.b);
    return true;
  }

  // A vertex of the tets around the segment, on no face of its curve, inside its diametral sphere.
  bool encroached(const Conjoint::Segment& s) {
    const auto edge = tets_.find_edge(s.a, s.b);
    if (!edge || (options_.may_split && !options_.may_split(s.edge))) return false;
    const Vec3 a = conjoint_.vertices().position(s.a), b = conjoint_.vertices().position(s.b);
    if (distance(a, b) < options_.floor) return false;
    tets_.ring(*edge, ring_);
    for (TetId t : ring_)
      for (VertexId v : tets_.complex().vertices(t)) {
        if (v == kInfinite || v == s.a || v == s.b) continue;
        const Vec3 p = conjoint_.vertices().position(v);
        if (dot(a - p, b - p) < 0 && !on_a_face_of(v, s.edge)) return true;
      }
    return false;
  }

  bool on_a_face_of(VertexId v, EdgeId edge) const {
    for (FaceId f : conjoint_.faces_of(v))
      for (FaceId g : conjoint_.model().edges[edge].faces)
        if (f == g) return true;
    return false;
  }

  void split(const Conjoint::Segment& s, std::deque<Conjoint::Segment>& queue) {
    SurfaceRefinement refinement;
    refinement.floor = options_.floor;
    refinement.origin = Origin::edge_recovery;
    refinement.before_split = options_.before_split;
    const bool was_present = present(s);
    const ConjointResult done = refine_segment(conjoint_, s.edge, s.a, s.b, refinement);
    if (!done.ok()) {
      if (!was_present) reconnect_or_fail(s, done.refusal);
      return;
    }
    ++result_.splits;
    queue.push_back({s.edge, s.a, done.vertex});
    queue.push_back({s.edge, done.vertex, s.b});
  }

  // A segment at the floor of spacing: flips and filling are what is left, also where splitting is the rule.
  void reconnect_or_fail(const Conjoint::Segment& s, ConjointRefusal refusal) {
    if (recover_edge_by_flips(tets_, s.a, s.b)) {
      ++result_.flipped;
    } else if (const FillResult filled = fill_around_segment(conjoint_, s); filled.recovered > 0) {
      ++result_.filled;
      result_.volume_points += filled.points;
    } else {
      fail(s, refusal);
      return;
    }
    tets_.keep_segment(s.a, s.b);
  }

  void fail(const Conjoint::Segment& s, ConjointRefusal refusal) {
    RecoveryFailure failure;
    failure.faces = conjoint_.model().edges[s.edge].faces;
    const Vec3 a = conjoint_.vertices().position(s.a), b = conjoint_.vertices().position(s.b);
    failure.where = 0.5 * (a + b);
    failure.size = 0.5 * distance(a, b);
    failure.what = fmt::format("a segment of edge {} is not recovered ({})",
                               conjoint_.model().edges[s.edge].label.cad_id, name(refusal));
    result_.failures.push_back(failure);
  }

  Conjoint& conjoint_;
  Tetrahedralization& tets_;
  const EdgeRecoveryOptions& options_;
  Context& context_;
  EdgeRecoveryResult result_;
  std::vector<TetId> ring_;
};

}  // namespace

Result<EdgeRecoveryResult> recover_edges(Conjoint& conjoint, const EdgeRecoveryOptions& options, Context& context) {
  return EdgeRecovery(conjoint, options, context).run();
}

}  // namespace curvetet
