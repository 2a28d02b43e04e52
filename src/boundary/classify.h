// Tets into solids and outside, by flooding across unlocked facets; contradictions with the CAD are failures.
//
// Before: all faces locked. After (no failures): region(t) is SolidId.value() + 1, or 0 outside; every locked facet has
// on its two sides the solids the CAD says; every solid has tets.
#pragma once

#include <vector>

#include "base/context.h"
#include "boundary/cure_crossings.h"

namespace curvetet {

struct ClassifyResult {
  IndexedVector<SolidId, std::size_t> tets;
  IndexedVector<SolidId, double> volumes;  ///< working units cubed
  std::vector<RecoveryFailure> failures;
};

/// O(tets).
ClassifyResult classify(Conjoint& conjoint);

}  // namespace curvetet
