// Refines t_3d until no two of its triangles cross: the paper's first stage (section 3.1) driven by crossings
// themselves.
//
// Before: valid face meshes. After (complete): no two triangles of t_3d cross, exactly, and none is folded back against
// the normal of its face. Terminates: each round takes out a node of the first face meshes, or splits at least one
// triangle or segment, none below the floor, and the rounds are bounded, and the points by the area that crosses over
// the square of the floor.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "boundary/refine_surface.h"

namespace curvetet {

/// Where recovery failed, in the form the outer loop needs.
struct RecoveryFailure {
  std::vector<FaceId> faces;
  Vec3 where;       ///< working coordinates
  double size = 0;  ///< that would do there
  std::string what;
  bool proved = false;    ///< the body itself is at fault: flat faces cross
  bool crossing = false;  ///< facets of the two faces cross, whatever their size
};

/// Of facets that are folded against their faces: half their longest edges would do, or the radius that the face is
/// bent by, down to a twentieth of them. One place of two faces that cross is as good as another, but each fold has a
/// cause of its own; of very many some are told, evenly spread over the list.
std::vector<RecoveryFailure> fold_failures(const Conjoint& conjoint, const std::vector<SurfaceTriangle>& folded);

struct CrossingOptions {
  double floor = 0;
  int rounds = 40;  ///< shells of a ten-thousandth of their radius, as coarse as can be, took thirty
};
struct CrossingResult {
  std::size_t first_pairs = 0;  ///< crossings of the initial meshes
  std::size_t first_folds = 0;  ///< folded triangles of the initial meshes
  std::size_t points = 0;       ///< inserted
  int rounds = 0;
  std::vector<RecoveryFailure> failures;
};
Result<CrossingResult> cure_crossings(Conjoint& conjoint, const CrossingOptions& options, Context& context);

}  // namespace curvetet
