// Every segment of every curve mesh becomes an edge of the tetrahedralization (the paper's section 2) and is kept from
// then on.
//
// Before: all boundary vertices are in the tetrahedralization. After (no failures): each segment is an edge and kept.
// Terminates: a split halves a segment that is longer than the floor.
#pragma once

#include <vector>

#include "base/context.h"
#include "boundary/cure_crossings.h"

namespace curvetet {

struct EdgeRecoveryOptions {
  double floor = 0;
  bool flips = true;  ///< try to reconnect without a point first; off: the paper's splitting
  bool split_encroached =
      false;  ///< split a segment whose diametral sphere holds a vertex on no face of its curve (paper)
  std::function<void(EdgeId)> before_split;
  std::function<bool(EdgeId)> may_split;  ///< where only encroached: curves with a locked face may not; empty: all may
};
struct EdgeRecoveryResult {
  std::size_t flipped = 0, splits = 0;
  std::size_t filled = 0;         ///< by making the tetrahedralization around them anew (fill_holes)
  std::size_t volume_points = 0;  ///< that this took, none on the surface
  std::vector<RecoveryFailure> failures;
};
Result<EdgeRecoveryResult> recover_edges(Conjoint& conjoint, const EdgeRecoveryOptions& options, Context& context);

}  // namespace curvetet
