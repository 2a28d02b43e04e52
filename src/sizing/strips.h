// Sizes beside narrow faces: a strip much narrower than the elements beside it bounds their dihedral angles.
#pragma once

#include <vector>

#include "base/context.h"
#include "sizing/sampling.h"
#include "sizing/size_field.h"

namespace curvetet::sizing {

struct StripInput {
  const Model& model;
  const SizingOptions& options;
  const SizeField& field;  ///< of all sizes but those of strips
  const std::vector<EdgeSamples>& edges;
};

/// Sources along the edges of faces that are narrower than 1/50 of the field's size, but not narrower than 1/250; in an
/// order that does not depend on the number of threads. Fewer, if the context wants to stop. A projection for each
/// sample of an edge and each other edge of the face within reach.
std::vector<SizeSource> strip_sources(const StripInput& input, Context& context);

}  // namespace curvetet::sizing
