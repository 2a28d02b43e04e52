// A round: segments, then a march over every face that is not locked, then reconnection by flips for the faces the
// march left, then one vertex for each triangle that is still missing. A face is locked as soon as it is complete, so
// that what is recovered stays recovered; a curve that must be split unlocks the faces on it, which is counted.
// Rejected: refining before reconnecting. It converges too, but to a mesh much finer than asked wherever faces meet at
// small angles.
#include "boundary/face_recovery.h"

#include <fmt/format.h>

#include <algorithm>

#include "boundary/edge_recovery.h"
#include "boundary/reconnect.h"

namespace curvetet {

namespace {

std::uint64_t hash_keys(std::vector<FacetKey> keys) {
  std::sort(keys.begin(), keys.end());
  std::uint64_t hash = 0xcbf29ce484222325ULL;  // FNV-1a
  for (const FacetKey& key : keys)
    for (std::uint32_t value : key)
      for (int shift = 0; shift < 32; shift += 8) hash = (hash ^ ((value >> shift) & 0xFFU)) * 0x100000001b3ULL;
  return hash;
}

class FaceRecovery {
 public:
  FaceRecovery(Conjoint& conjoint, const FaceRecoveryOptions& options, Context& context)
      : conjoint_(conjoint),
        tets_(*conjoint.tets()),
        options_(options),
        context_(context),
        recovered_(conjoint.model().faces.size(), false) {
    result_.faces.resize(conjoint.model().faces.size());
    for (std::size_t f = 0; f < recovered_.size(); ++f)
      for (const SurfaceTriangle& t : surface_triangles(conjoint.boundary().faces[FaceId(f)], FaceId(f)))
        result_.faces[FaceId(f)].initial.insert(facet_key(t.vertices[0], t.vertices[1], t.vertices[2]));
  }

  Result<FaceRecoveryResult> run() {
    for (result_.rounds = 0;; ++result_.rounds) {
      const Status edges = drain_edges();
      if (!edges.ok()) return edges.error();
      if (!result_.failures.empty()) break;
      const Status pass = march_all();
      if (!pass.ok()) return pass.error();
      reconnect_all();
      if (all_recovered()) break;
      if (result_.rounds >= options_.rounds || !refine_missing()) {
        report_missing();
        break;
      }
    }
    for (std::size_t f = 0; f < recovered_.size(); ++f) certify(FaceId(f));
    return std::move(result_);
  }

 private:
  bool all_recovered() const {
    return std::all_of(recovered_.begin(), recovered_.end(), [](bool r) { return r; });
  }

  Status drain_edges() {
    EdgeRecoveryOptions options;
    options.floor = options_.floor;
    options.before_split = [this](EdgeId e) { unlock_on(e); };
    auto edges = recover_edges(conjoint_, options, context_);
    if (!edges.ok()) return edges.error();
    result_.edge_flips += edges.value().flipped;
    result_.edge_splits += edges.value().splits;
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

  void lock(FaceId face) {
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary().faces[face], face)) {
      const auto f = tets_.find_facet(t.vertices[0], t.vertices[1], t.vertices[2]);
      CURVETET_CHECK(f.has_value());
      tets_.lock(*f, face);
    }
    recovered_[face] = true;
    result_.faces[face].hash_locked = facet_hash(conjoint_.boundary().faces[face], face);
  }

  Status march_all() {
    std::size_t done = 0;
    for (std::size_t f = 0; f < recovered_.size(); ++f) {
      const FaceId face(f);
      if (context_.should_stop()) return context_.stop_error("face recovery");
      if (!recovered_[face]) march(face);
      done += recovered_[face] ? 1U : 0U;
    }
    context_.log(LogLevel::debug,
                 fmt::format("round {}: {} of {} faces after the march", result_.rounds, done, recovered_.size()));
    return Done{};
  }

  void march(FaceId face) {
    MarchResult m = march_face(conjoint_, face);
    FaceMesh& mesh = conjoint_.boundary().faces[face];
    bool complete = m.complete;
    if (!m.missing.empty()) {
      std::set<FacetKey> before;
      for (const SurfaceTriangle& t : surface_triangles(mesh, face))
        before.insert(facet_key(t.vertices[0], t.vertices[1], t.vertices[2]));
      if (mesh.replace(m.triangles)) {
        for (const SurfaceTriangle& t : surface_triangles(mesh, face))
          result_.faces[face].marched += before.count(facet_key(t.vertices[0], t.vertices[1], t.vertices[2])) ? 0U : 1U;
      } else {
        complete = false;
      }
    }
    if (complete) lock(face);
  }

  void reconnect_all() {
    for (int depth : {3, 6}) {
      for (std::size_t f = 0; f < recovered_.size(); ++f) {
        const FaceId face(f);
        if (recovered_[face] || context_.should_stop()) continue;
        const ReconnectResult r = reconnect_face(conjoint_, face, depth);
        result_.faces[face].reconnected += r.recovered;
        if (r.missing.empty()) lock(face);
      }
    }
  }

  std::vector<SurfaceTriangle> missing_triangles(FaceId face) const {
    std::vector<SurfaceTriangle> missing;
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary().faces[face], face)) {
      const auto f = tets_.find_facet(t.vertices[0], t.vertices[1], t.vertices[2]);
      const FaceId owner = f ? tets_.complex().locked_face(*f) : FaceId();
      if (!f || (owner.valid() && owner != face)) missing.push_back(t);
    }
    return missing;
  }

  bool refine_missing() {
    std::size_t inserted = refine_pass();
    if (inserted == 0) {  // the locks of other faces are in the way
      for (std::size_t f = 0; f < recovered_.size(); ++f) unlock(FaceId(f));
      inserted = refine_pass();
    }
    result_.points += inserted;
    return inserted > 0;
  }

  std::size_t refine_pass() {
    SurfaceRefinement refinement;
    refinement.floor = options_.floor;
    refinement.origin = Origin::stage_two;
    refinement.before_split = [this](EdgeId e) { unlock_on(e); };
    std::size_t inserted = 0;
    for (std::size_t f = 0; f < recovered_.size(); ++f) {
      const FaceId face(f);
      if (recovered_[face]) continue;
      for (const SurfaceTriangle& t : missing_triangles(face)) {
        const FaceMesh& mesh = conjoint_.boundary().faces[face];
        if (!mesh.triangle(t.triangle).alive() || mesh.vertices(t.triangle) != t.vertices) continue;
        if (refine_triangle(conjoint_, face, t.triangle, refinement).ok()) ++inserted;
      }
    }
    return inserted;
  }

  void report_missing() {
    for (std::size_t f = 0; f < recovered_.size(); ++f) {
      const FaceId face(f);
      if (recovered_[face]) continue;
      const auto missing = missing_triangles(face);
      RecoveryFailure failure;
      failure.faces = {face};
      failure.what = fmt::format("{} of {} facets of the face are not recovered", missing.size(),
                                 conjoint_.boundary().faces[face].triangle_count());
      if (!missing.empty()) locate_failure(missing.front(), failure);
      result_.failures.push_back(failure);
    }
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

  void certify(FaceId face) {
    FaceCertificate& c = result_.faces[face];
    for (const SurfaceTriangle& t : surface_triangles(conjoint_.boundary().faces[face], face)) {
      ++c.triangles;
      c.coincide += c.initial.count(facet_key(t.vertices[0], t.vertices[1], t.vertices[2]));
    }
  }

  Conjoint& conjoint_;
  Tetrahedralization& tets_;
  const FaceRecoveryOptions& options_;
  Context& context_;
  FaceRecoveryResult result_;
  IndexedVector<FaceId, char> recovered_;
};

}  // namespace

std::uint64_t facet_hash(const FaceMesh& mesh, FaceId face) {
  std::vector<FacetKey> keys;
  for (const SurfaceTriangle& t : surface_triangles(mesh, face))
    keys.push_back(facet_key(t.vertices[0], t.vertices[1], t.vertices[2]));
  return hash_keys(std::move(keys));
}

IndexedVector<FaceId, std::uint64_t> locked_hashes(const Tetrahedralization& tets, std::size_t faces) {
  IndexedVector<FaceId, std::vector<FacetKey>> keys(faces);
  const TetComplex& complex = tets.complex();
  for (std::size_t t = 0; t < complex.slots(); ++t) {
    if (!complex.is_alive(TetId(t))) continue;
    for (int i = 0; i < 4; ++i) {
      const TetFacet f{TetId(t), i};
      if (!complex.is_locked(f) || complex.neighbour(f.tet, i) < f.tet) continue;
      const auto v = complex.facet_vertices(f);
      keys[complex.locked_face(f)].push_back(facet_key(v[0], v[1], v[2]));
    }
  }
  IndexedVector<FaceId, std::uint64_t> hashes(faces);
  for (std::size_t f = 0; f < faces; ++f) hashes[FaceId(f)] = hash_keys(std::move(keys[FaceId(f)]));
  return hashes;
}

Result<FaceRecoveryResult> recover_faces(Conjoint& conjoint, const FaceRecoveryOptions& options, Context& context) {
  return FaceRecovery(conjoint, options, context).run();
}

}  // namespace curvetet
