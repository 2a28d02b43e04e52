// A round: segments, then a march over every face that is not locked, then reconnection by flips and filling for the
// faces the march left, then filling with points in the volume; where that recovers nothing, one vertex for each
// triangle that is still missing. A face is locked as soon as it is complete, so that what is recovered stays
// recovered; a curve that must be split unlocks the faces on it, which is counted.
// Rejected: refining before reconnecting. It converges too, but to a mesh much finer than asked wherever faces meet at
// small angles.
#include "boundary/face_recovery.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/fnv.h"
#include "boundary/edge_recovery.h"
#include "boundary/facet_fallback.h"
#include "boundary/fill_holes.h"
#include "boundary/reconnect.h"

namespace curvetet {

namespace {

class FaceRecovery {
 public:
  FaceRecovery(Conjoint& conjoint, const FaceRecoveryOptions& options, Context& context)
      : conjoint_(conjoint),
        tets_(*conjoint.tets()),
        options_(options),
        context_(context),
        recovered_(conjoint.model().faces.size(), false),
        refined_(conjoint.model().faces.size(), 0) {
    result_.faces.resize(conjoint.model().faces.size());
  }

  Result<FaceRecoveryResult> run() {
    for (result_.rounds = 0;; ++result_.rounds) {
      const Status edges = drain_edges();
      if (!edges.ok()) return edges.error();
      if (!result_.failures.empty()) return std::move(result_);
      const Status pass = march_all();
      if (!pass.ok()) return pass.error();
      reconnect_all();
      if (none_open() || result_.rounds >= options_.rounds || !refine_missing()) break;
    }
    const Status rest = end();
    if (!rest.ok()) return rest.error();
    return std::move(result_);
  }

 private:
  bool is_forced(FaceId face) const { return options_.force_fallback && options_.force_fallback(face); }
  /// Whether the rounds have something to do on it.
  bool is_open(FaceId face) const { return !recovered_[face] && !is_forced(face); }

  bool none_open() const {
    for (std::size_t f = 0; f < recovered_.size(); ++f)
      if (is_open(FaceId(f))) return false;
    return true;
  }

  Status drain_edges() {
    EdgeRecoveryOptions options;
    options.floor = options_.floor;
    options.before_split = [this](EdgeId e) { unlock_on(e); };
    auto edges = recover_edges(conjoint_, options, context_);
    if (!edges.ok()) return edges.error();
    result_.edge_flips += edges.value().flipped;
    result_.edge_splits += edges.value().splits;
    result_.edges_filled += edges.value().filled;
    result_.volume_points += edges.value().volume_points;
    result_.failures = std::move(edges.value().failures);
    return Done{};
  }

  void unlock_on(EdgeId edge) {
    for (FaceId f : conjoint_.model().edges[edge].faces) unlock(f);
  }

  void unlock(FaceId face) {
    if (!recovered_[face]) return;
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary().faces[face], face))
      if (const auto f = tets_.find_facet(t.vertices[0], t.vertices[1], t.vertices[2])) tets_.complex().unlock(*f);
    recovered_[face] = false;
    ++result_.faces[face].unlocks;
  }

  void lock(FaceId face, std::size_t parametric) {
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary().faces[face], face)) {
      const auto f = tets_.find_facet(t.vertices[0], t.vertices[1], t.vertices[2]);
      CURVETET_CHECK(f.has_value());
      tets_.lock(*f, face);
    }
    recovered_[face] = true;
    refined_[face] = 0;
    FaceCertificate& certificate = result_.faces[face];
    certificate.locked = facets_of(conjoint_.boundary().faces[face], face);
    certificate.parametric = parametric;
  }

  Status march_all() {
    std::size_t done = 0;
    for (std::size_t f = 0; f < recovered_.size(); ++f) {
      const FaceId face(f);
      if (context_.should_stop()) return context_.stop_error("face recovery");
      if (is_open(face)) march(face);
      done += recovered_[face] ? 1U : 0U;
      context_.advance(static_cast<double>(done) / static_cast<double>(recovered_.size()));
    }
    context_.log(LogLevel::debug,
                 fmt::format("round {}: {} of {} faces after the march", result_.rounds, done, recovered_.size()));
    return Done{};
  }

  void march(FaceId face) {
    const MarchResult m = march_face(conjoint_, face);
    FaceMesh& mesh = conjoint_.boundary().faces[face];
    const std::size_t parametric = surface_triangles(mesh, face).size();
    const bool taken = m.missing.empty() || take_over(mesh, face, m, result_.faces[face]);
    count_refined(face);
    if (m.complete && taken) lock(face, parametric);
  }

  void count_refined(FaceId face) {
    if (refined_[face] == 0) return;
    const std::size_t left = missing_triangles(conjoint_, face).size();
    result_.faces[face].ladder.refine.recovered += refined_[face] - std::min(left, refined_[face]);
    refined_[face] = 0;
  }

  void lock_as_is(FaceId face) { lock(face, surface_triangles(conjoint_.boundary().faces[face], face).size()); }

  /// What flips do not reach is left to filling, which looks at a hole as a whole.
  void reconnect_all() {
    for (std::size_t f = 0; f < recovered_.size(); ++f) {
      const FaceId face(f);
      if (!is_open(face) || context_.should_stop()) continue;
      const ReconnectResult r = reconnect_face(conjoint_, face);
      RungCounts& rung = result_.faces[face].ladder.reconnect;
      rung.tried += r.recovered + r.missing.size();
      rung.recovered += r.recovered;
      if (r.missing.empty()) lock_as_is(face);
    }
    fill_missing(false);
  }

  /// Points in the volume come first: what they recover stays as coarse as it is.
  bool refine_missing() {
    if (fill_missing(true) > 0) return true;
    std::size_t inserted = refine_pass();
    if (inserted == 0) {
      // The locks of other faces are in the way.
      for (std::size_t f = 0; f < recovered_.size(); ++f) unlock(FaceId(f));
      inserted = refine_pass();
    }
    result_.points += inserted;
    return inserted > 0;
  }

  /// Facets recovered.
  std::size_t fill_missing(bool with_points) {
    std::size_t recovered = 0;
    for (std::size_t f = 0; f < recovered_.size(); ++f) {
      const FaceId face(f);
      if (!is_open(face) || context_.should_stop()) continue;
      const std::size_t before = missing_triangles(conjoint_, face).size();
      const FillResult filled = fill_holes(conjoint_, face, with_points);
      const std::size_t after = missing_triangles(conjoint_, face).size();
      LadderCounts& ladder = result_.faces[face].ladder;
      (with_points ? ladder.volume_points : ladder.reconnect).recovered += before - after;
      if (with_points) ladder.volume_points.tried += before;
      result_.volume_points += filled.points;
      recovered += filled.recovered;
      if (after == 0) lock_as_is(face);
    }
    return recovered;
  }

  std::size_t refine_pass() {
    SurfaceRefinement refinement;
    refinement.floor = options_.floor;
    refinement.origin = Origin::stage_two;
    refinement.before_split = [this](EdgeId e) { unlock_on(e); };
    std::size_t inserted = 0;
    for (std::size_t f = 0; f < recovered_.size(); ++f) {
      const FaceId face(f);
      if (!is_open(face)) continue;
      const std::vector<SurfaceTriangle> missing = missing_triangles(conjoint_, face);
      refined_[face] = missing.size();
      result_.faces[face].ladder.refine.tried += missing.size();
      for (const SurfaceTriangle& t : missing) {
        const FaceMesh& mesh = conjoint_.boundary().faces[face];
        if (!mesh.triangle(t.triangle).alive() || mesh.vertices(t.triangle) != t.vertices) continue;
        if (refine_triangle(conjoint_, face, t.triangle, refinement).ok()) ++inserted;
      }
    }
    return inserted;
  }

  /// What the rounds left. Complete faces, which were unlocked only to make room for others, are locked first, so that
  /// the fallback sees them.
  Status end() {
    for (std::size_t f = 0; f < recovered_.size(); ++f)
      if (is_open(FaceId(f)) && missing_triangles(conjoint_, FaceId(f)).empty()) lock_as_is(FaceId(f));
    for (std::size_t f = 0; f < recovered_.size(); ++f) {
      const FaceId face(f);
      if (recovered_[face]) continue;
      if (context_.should_stop()) return context_.stop_error("face recovery");
      if (!options_.fallback && !is_forced(face))
        report_missing(face);
      else if (fall_back(conjoint_, face, result_, context_))
        lock_as_is(face);
    }
    return Done{};
  }

  void report_missing(FaceId face) {
    const auto missing = missing_triangles(conjoint_, face);
    RecoveryFailure failure;
    failure.faces = {face};
    failure.what = fmt::format("{} of {} facets of the face are not recovered", missing.size(),
                               conjoint_.boundary().faces[face].triangle_count());
    locate_failure(missing.front(), failure);
    result_.failures.push_back(failure);
  }

  void locate_failure(const SurfaceTriangle& t, RecoveryFailure& failure) const {
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 p = conjoint_.vertices().position(t.vertices[k]);
      failure.where = failure.where + (1.0 / 3) * p;
      longest = std::max(longest, distance(p, conjoint_.vertices().position(t.vertices[(k + 1) % 3])));
    }
    failure.size = 0.5 * longest;
  }

  Conjoint& conjoint_;
  Tetrahedralization& tets_;
  const FaceRecoveryOptions& options_;
  Context& context_;
  FaceRecoveryResult result_;
  IndexedVector<FaceId, char> recovered_;
  IndexedVector<FaceId, std::size_t> refined_;  ///< facets that were missing when the face was refined last
};

}  // namespace

std::vector<FacetKey> facets_of(const FaceMesh& mesh, FaceId face) {
  std::vector<FacetKey> facets;
  for (const SurfaceTriangle& t : surface_triangles(mesh, face))
    facets.push_back(facet_key(t.vertices[0], t.vertices[1], t.vertices[2]));
  std::sort(facets.begin(), facets.end());
  return facets;
}

IndexedVector<FaceId, std::vector<FacetKey>> locked_facets(const Tetrahedralization& tets, std::size_t faces) {
  IndexedVector<FaceId, std::vector<FacetKey>> facets(faces);
  const TetComplex& complex = tets.complex();
  for (std::size_t t = 0; t < complex.slots(); ++t) {
    if (!complex.is_alive(TetId(t))) continue;
    for (int i = 0; i < 4; ++i) {
      const TetFacet f{TetId(t), i};
      if (!complex.is_locked(f) || complex.neighbour(f.tet, i) < f.tet) continue;
      const auto v = complex.facet_vertices(f);
      facets[complex.locked_face(f)].push_back(facet_key(v[0], v[1], v[2]));
    }
  }
  for (std::size_t f = 0; f < faces; ++f) std::sort(facets[FaceId(f)].begin(), facets[FaceId(f)].end());
  return facets;
}

std::uint64_t facet_hash(const std::vector<FacetKey>& facets) {
  Fnv1a hash;
  for (const FacetKey& facet : facets)
    for (std::uint32_t value : facet)
      for (int shift = 0; shift < 32; shift += 8) hash.add((value >> shift) & 0xFFU);
  return hash.value();
}

bool take_over(FaceMesh& mesh, FaceId face, const MarchResult& march, FaceCertificate& certificate) {
  const std::vector<FacetKey> before = facets_of(mesh, face);
  if (!mesh.replace(march.triangles)) return false;
  for (const FacetKey& facet : facets_of(mesh, face))
    if (!std::binary_search(before.begin(), before.end(), facet)) certificate.marched.insert(facet);
  return true;
}

Result<FaceRecoveryResult> recover_faces(Conjoint& conjoint, const FaceRecoveryOptions& options, Context& context) {
  return FaceRecovery(conjoint, options, context).run();
}

}  // namespace curvetet
