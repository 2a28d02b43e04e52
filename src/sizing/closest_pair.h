// The closest pair of points of two surfaces, near a given pair.
#pragma once

#include <optional>

#include "geometry/surface.h"

namespace curvetet::sizing {

struct ParameterPair {
  Vec2 one, two;
};

/// Damped Newton steps on the distance in the four parameters; the distance never grows, at most a dozen steps.
/// Not confined to trimmed domains, and local: the pair may be a saddle's side or run along a line of equal distance.
ParameterPair approach(const Surface& one, const Surface& two, ParameterPair start, double furthest);

/// A pair closer than `contact`, if the surfaces come that close within `furthest` of the first point: where they cross
/// or touch. Steps to where the slope of the distance would bring it to zero, at most a dozen, each closer than the
/// last.
std::optional<ParameterPair> meeting_point(const Surface& one, const Surface& two, ParameterPair start, double contact,
                                           double furthest);

}  // namespace curvetet::sizing
