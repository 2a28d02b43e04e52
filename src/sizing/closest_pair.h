// The closest pair of points of two surfaces, near a given pair.
#pragma once

#include "geometry/surface.h"

namespace curvetet::sizing {

struct ParameterPair {
  Vec2 one, two;
};

/// Damped Newton steps on the distance in the four parameters; the distance never grows, at most a dozen steps.
/// Not confined to trimmed domains, and local: the pair may be a saddle's side or run along a line of equal distance.
ParameterPair approach(const Surface& one, const Surface& two, ParameterPair start, double furthest);

}  // namespace curvetet::sizing
