// The box of a body, from samples of its boundary.
#pragma once

#include "geometry/model.h"

namespace curvetet {

/// Box of samples on all edges and, where the surface is not plane, in the interior of all faces. It may miss bulges
/// between samples by a few thousandths of the body's size; good for sizes and frames, no proof of containment.
Box3 sampled_box(const Model& model);

}  // namespace curvetet
