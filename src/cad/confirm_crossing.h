// A second opinion on faces that a mesh of any size lets cross. Inside cad only.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "cad/body.h"

namespace curvetet {

/// Asks the CAD kernel (BOPAlgo_ArgumentAnalyzer) whether these faces (cad ids) interfere other than in what they
/// share. The error (self_intersection) names them; empty if the kernel finds nothing, or cannot tell. Time grows with
/// the square of the faces' number; meant for two.
std::optional<Error> confirm_crossing(const CadBody& body, const std::vector<std::uint32_t>& faces,
                                      const std::string& source);

}  // namespace curvetet
