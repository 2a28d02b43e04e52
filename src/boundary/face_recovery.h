// Recovery of all curved faces: march, reconnect without points, refine conjointly, lock (the paper's sections 3.2
// to 3.5, in the order DESIGN's improved default asks for).
//
// Before: valid face meshes free of crossings, all their vertices in the tetrahedralization, segments recovered and
// kept. After (complete): for each face the triangles of t_ps are facets of the tetrahedralization, locked for the
// face; no locked facet was ever split while locked. Terminates: rounds are bounded, every round inserts at least one
// vertex above the floor.
#pragma once

#include <cstdint>
#include <set>
#include <vector>

#include "base/context.h"
#include "boundary/cure_crossings.h"
#include "boundary/march.h"

namespace curvetet {

/// What recovery did to one face; becomes its certificate in the report.
struct FaceCertificate {
  std::set<FacetKey> initial;   ///< t_3d when recovery began
  std::size_t triangles = 0;    ///< in T_Γ
  std::size_t coincide = 0;     ///< of them also in the t_3d recovery began with
  std::size_t marched = 0;      ///< triangles replaced by the march
  std::size_t reconnected = 0;  ///< facets recovered by flips, without points
  std::size_t unlocks = 0, relocks = 0, steiner = 0;
  std::uint64_t hash_locked = 0;
  bool fallback = false;
};

struct FaceRecoveryOptions {
  double floor = 0;
  int rounds = 30;
};

struct FaceRecoveryResult {
  IndexedVector<FaceId, FaceCertificate> faces;
  int rounds = 0;
  std::size_t points = 0;
  std::size_t edge_flips = 0, edge_splits = 0;
  std::vector<RecoveryFailure> failures;  ///< empty when complete
};

Result<FaceRecoveryResult> recover_faces(Conjoint& conjoint, const FaceRecoveryOptions& options, Context& context);

/// Hash of the facets of a face, from its face mesh: independent of the order of triangles.
std::uint64_t facet_hash(const FaceMesh& mesh, FaceId face);
/// The same from the facets that are locked for each face in the tetrahedralization.
IndexedVector<FaceId, std::uint64_t> locked_hashes(const Tetrahedralization& tets, std::size_t faces);

}  // namespace curvetet
