// Solids of an assembly that claim the same space. Inside cad only.
#pragma once

#include <optional>
#include <string>

#include "base/error.h"
#include "cad/body.h"

namespace curvetet {

/// Looks for a vertex or a point on an edge of one solid that lies clearly inside of another one; the error names both
/// solids and the point. Not finding one proves nothing: faces may cross without it, and are left to the mesher.
std::optional<Error> find_overlap(const CadBody& body, const std::string& source);

}  // namespace curvetet
