// Faces one by one, in the order of the body; a face is locked when its march is complete and never touched again. A
// curve whose other face is locked already is not split any more. Where several iterations are no better than the
// best one before, the face falls back to recovery facet by facet (section 3.5, rule 2).
#include "boundary/paper_recovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "boundary/boundary_mesh.h"
#include "boundary/edge_recovery.h"
#include "boundary/facet_fallback.h"
#include "boundary/simplicial.h"

namespace curvetet {

namespace {

/// Iterations without a better march before the fallback.
constexpr int kPatience = 12;

class PaperRecovery {
 public:
  PaperRecovery(Conjoint& conjoint, const FaceRecoveryOptions& options, Context& context)
      : conjoint_(conjoint),
        tets_(*conjoint.tets()),
        options_(options),
        context_(context),
        locked_(conjoint.model().faces.size(), false) {
    out_.recovery.faces.resize(locked_.size());
  }

  Result<PaperRecoveryResult> run() {
    const Status edges = drain_edges();
    if (!edges.ok()) return edges.error();
    const Status first = paper_stage_one(conjoint_, options_.floor, out_.counts, context_);
    if (!first.ok()) return first.error();
    refine_edges_used_too_often();
    for (std::size_t f = 0; f < locked_.size() && out_.recovery.failures.empty(); ++f) {
      const Status done = recover(FaceId(f));
      if (!done.ok()) return done.error();
    }
    return std::move(out_);
  }

 private:
  Status drain_edges() {
    EdgeRecoveryOptions options;
    options.floor = options_.floor;
    options.flips = false;
    options.split_encroached = true;
    options.may_split = [this](EdgeId e) { return !touches_locked(e); };
    auto edges = recover_edges(conjoint_, options, context_);
    if (!edges.ok()) return edges.error();
    out_.recovery.edge_splits += edges.value().splits;
    out_.recovery.edges_filled += edges.value().filled;
    out_.recovery.volume_points += edges.value().volume_points;
    for (RecoveryFailure& f : edges.value().failures) out_.recovery.failures.push_back(std::move(f));
    return Done{};
  }

  struct Fewest {
    std::size_t stuck = std::numeric_limits<std::size_t>::max(), missing = stuck;
  };

  /// Fewer edges without a neighbour, or fewer triangles missing, than ever before. The number of triangles that are
  /// there says nothing: points make more of them wherever they fall, up to the floor of spacing.
  static bool is_better(const MarchResult& m, Fewest& fewest) {
    const bool better = m.missing.size() < fewest.missing || (m.seeds > 0 && m.stuck.size() < fewest.stuck);
    fewest.missing = std::min(fewest.missing, m.missing.size());
    if (m.seeds > 0) fewest.stuck = std::min(fewest.stuck, m.stuck.size());
    return better;
  }

  Status recover(FaceId face) {
    FaceMesh& mesh = conjoint_.boundary().faces[face];
    const std::size_t first_nodes = mesh.node_count();
    Fewest fewest;
    std::size_t parametric = 0;
    int waited = 0;
    std::size_t refined = 0;  // facets that were missing before the last points
    for (;;) {
      if (context_.should_stop()) return context_.stop_error("second stage of face recovery");
      const Status edges = drain_edges();
      if (!edges.ok()) return edges.error();
      if (!out_.recovery.failures.empty()) return Done{};
      if (options_.force_fallback && options_.force_fallback(face)) {
        finish_by_facets(face);
        return Done{};
      }
      const MarchResult m = march_face(conjoint_, face);
      context_.log(LogLevel::debug, fmt::format("face {}: {} triangles, {} missing, {} edges stuck", face.value(),
                                                m.total, m.missing.size(), m.stuck.size()));
      parametric = surface_triangles(mesh, face).size();
      const std::size_t left = m.complete ? 0 : m.missing.size();
      RungCounts& rung = out_.recovery.faces[face].ladder.refine;
      rung.recovered += refined - std::min(left, refined);
      if (m.complete && (m.missing.empty() || take_over(mesh, face, m, out_.recovery.faces[face]))) break;
      waited = is_better(m, fewest) ? 0 : waited + 1;
      const bool doubled = m.seeds == 0 && mesh.node_count() > 2 * first_nodes + 8;
      if (doubled || waited > kPatience || !remesh(face, m)) {
        finish_by_facets(face);
        return Done{};
      }
      rung.tried += m.missing.size();
      refined = m.missing.size();
      ++out_.recovery.rounds;
    }
    lock(face, parametric);
    return Done{};
  }

  // Case 2 of section 3.4: an edge that t_3d uses four times (Fig. 12). There is none in the first surface mesh, but
  // the points of the first stage may have made one.
  void refine_edges_used_too_often() {
    const std::size_t before = conjoint_.vertices().size();
    for (const Offence& o : make_simplicial(conjoint_, context_)) {
      RecoveryFailure failure;
      failure.faces = {o.face};
      failure.where = conjoint_.vertices().position(o.a);
      failure.size = 0.5 * distance(failure.where, conjoint_.vertices().position(o.b));
      failure.what = describe(o, conjoint_.model());
      out_.recovery.failures.push_back(std::move(failure));
    }
    // The store keeps refused vertices, too.
    for (std::size_t v = before; v < conjoint_.vertices().size(); ++v)
      out_.counts.case2 += tets_.contains(VertexId(v)) ? 1U : 0U;
  }

  // Remeshing cases 1, 3a, 3b and 4 of section 3.4.
  bool remesh(FaceId face, const MarchResult& m) {
    std::size_t inserted = 0;
    if (m.seeds == 0) {
      for (std::size_t i = 0; i < m.missing.size() && inserted < 3; ++i)
        inserted += refine(face, m.missing[i]) ? 1U : 0U;
      out_.counts.case1 += inserted;
      return inserted > 0;
    }
    for (const StuckEdge& e : m.stuck) inserted += refine_stuck(face, e) ? 1U : 0U;
    if (inserted == 0)  // case 4: vertices that no marked triangle uses have missing triangles around them
      for (TriangleId t : m.missing)
        if (refine(face, t)) {
          ++out_.counts.case4;
          ++inserted;
        }
    return inserted > 0;
  }

  bool refine(FaceId face, TriangleId t) {
    const FaceMesh& mesh = conjoint_.boundary().faces[face];
    if (!mesh.triangle(t).alive()) return false;
    SurfaceRefinement refinement;
    refinement.floor = options_.floor;
    refinement.origin = Origin::stage_two;
    refinement.may_split = [this](EdgeId e) { return !touches_locked(e); };
    const bool ok = refine_triangle(conjoint_, face, t, refinement).ok();
    if (ok) ++out_.recovery.points;
    return ok;
  }

  // A curve with a locked face on it must not be split: its facets would go.
  bool touches_locked(EdgeId edge) const {
    const std::vector<FaceId>& faces = conjoint_.model().edges[edge].faces;
    return std::any_of(faces.begin(), faces.end(), [this](FaceId f) { return locked_[f]; });
  }

  bool refine_stuck(FaceId face, const StuckEdge& e) {
    const FaceMesh& mesh = conjoint_.boundary().faces[face];
    if (const auto edge = mesh.find_edge(e.a, e.b)) {
      const FaceTriangle& t = mesh.triangle(edge->triangle);
      const bool is_marked = std::find(t.node.begin(), t.node.end(), e.apex) != t.node.end();
      const TriangleId other = is_marked ? t.neighbour[static_cast<std::size_t>(edge->local)] : edge->triangle;
      if (!other.valid() || !refine(face, other)) return false;
      ++out_.counts.case3a;
      return true;
    }
    const Vec2 middle = 0.5 * (mesh.node(e.a).q + mesh.node(e.b).q);
    const Vec3 p = 0.5 * (conjoint_.vertices().position(mesh.node(e.a).vertex) +
                          conjoint_.vertices().position(mesh.node(e.b).vertex));
    const auto uv = conjoint_.model().faces[face].surface->project(p, mesh.chart.to_uv(middle));
    const auto at = mesh.locate(uv ? mesh.chart.to_chart(*uv) : middle, mesh.triangle_at(e.a));
    if (!at || !refine(face, *at)) return false;
    ++out_.counts.case3b;
    return true;
  }

  void lock(FaceId face, std::size_t parametric) {
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary().faces[face], face)) {
      const auto f = tets_.find_facet(t.vertices[0], t.vertices[1], t.vertices[2]);
      CURVETET_CHECK(f.has_value());
      tets_.lock(*f, face);
    }
    FaceCertificate& certificate = out_.recovery.faces[face];
    certificate.locked = facets_of(conjoint_.boundary().faces[face], face);
    certificate.parametric = parametric;
    locked_[face] = true;
  }

  void finish_by_facets(FaceId face) {
    if (fall_back(conjoint_, face, out_.recovery, context_))
      lock(face, surface_triangles(conjoint_.boundary().faces[face], face).size());
  }

  Conjoint& conjoint_;
  Tetrahedralization& tets_;
  const FaceRecoveryOptions& options_;
  Context& context_;
  IndexedVector<FaceId, char> locked_;
  PaperRecoveryResult out_;
};

}  // namespace

Result<PaperRecoveryResult> recover_faces_as_paper(Conjoint& conjoint, const FaceRecoveryOptions& options,
                                                   Context& context) {
  return PaperRecovery(conjoint, options, context).run();
}

}  // namespace curvetet
