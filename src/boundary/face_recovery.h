// Recovery of all curved faces: march, reconnect without points, refine conjointly, lock (the paper's sections 3.2
// to 3.5, in the order DESIGN's improved default asks for).
//
// Before: valid face meshes free of crossings, all their vertices in the tetrahedralization, segments recovered and
// kept. After (complete): for each face the triangles of t_ps are facets of the tetrahedralization, locked for the
// face; no locked facet was ever split while locked. Terminates: rounds are bounded, every round inserts at least one
// vertex above the floor or recovers a facet.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "base/context.h"
#include "boundary/cure_crossings.h"
#include "boundary/march.h"
#include "curvetet/report.h"

namespace curvetet {

/// What recovery did to one face; becomes its certificate in the report.
struct FaceCertificate {
  std::set<FacetKey> marched;    ///< facets that the march put in the place of triangles of t_3d
  std::vector<FacetKey> locked;  ///< T_Γ when it was locked last, sorted
  std::size_t parametric = 0;    ///< triangles of t_3d whose place T_Γ took then
  std::size_t unlocks = 0;
  bool fallback = false;
  LadderCounts ladder;  ///< but for the outer loop's
};

struct FaceRecoveryOptions {
  double floor = 0;
  /// Each refines all that is missing of t_3d, which is free of crossings; where that many do not help a smaller size
  /// is the better cure. Points are bounded by the floor.
  int rounds = 30;
  bool fallback = false;  ///< facet by facet what the rounds leave; the paper's mode does so whatever this says
  std::function<bool(FaceId)> force_fallback = nullptr;  ///< faces recovered by nothing else, for tests; empty: none
};

struct FaceRecoveryResult {
  IndexedVector<FaceId, FaceCertificate> faces;
  int rounds = 0;
  std::size_t points = 0;
  std::size_t volume_points = 0;  ///< not on the surface: where a hole could be filled by no other means
  std::size_t edge_flips = 0, edge_splits = 0, edges_filled = 0;
  std::vector<RecoveryFailure> failures;  ///< empty when complete
};

Result<FaceRecoveryResult> recover_faces(Conjoint& conjoint, const FaceRecoveryOptions& options, Context& context);

/// The facets of a face's t_3d, sorted.
std::vector<FacetKey> facets_of(const FaceMesh& mesh, FaceId face);
/// The facets that are locked for each face in the tetrahedralization, sorted.
IndexedVector<FaceId, std::vector<FacetKey>> locked_facets(const Tetrahedralization& tets, std::size_t faces);
/// Of sorted facets.
std::uint64_t facet_hash(const std::vector<FacetKey>& facets);
/// Puts the triangles that a march found in the place of those of t_3d, and notes in the certificate which are new.
/// False, and nothing is changed, if the face mesh refuses them.
bool take_over(FaceMesh& mesh, FaceId face, const MarchResult& march, FaceCertificate& certificate);

}  // namespace curvetet
