// Sizes that gaps demand: where two sheets of the boundary come close, chords must stay well within the gap.
#pragma once

#include <memory>
#include <vector>

#include "base/context.h"
#include "sizing/sampling.h"
#include "sizing/size_field.h"

namespace curvetet::sizing {

struct GapInput {
  const Model& model;
  const SizingOptions& options;
  const SizeField& field;  ///< of all sizes but gaps
  const std::vector<std::unique_ptr<TrimmedDomain>>& domains;
  const std::vector<FaceSamples>& faces;
  const std::vector<EdgeSamples>& edges;
};

/// Sources where the chord height of an element of the field's size would exceed a quarter of the gap; in an order that
/// does not depend on the number of threads. Fewer, if the context wants to stop.
std::vector<SizeSource> gap_sources(const GapInput& input, Context& context);

}  // namespace curvetet::sizing
