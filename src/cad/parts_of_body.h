// Single parts of a shape. Inside cad only.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "cad/body.h"

namespace curvetet {

/// The parts of these names ("face 12", by cad id) as a compound in the order of the body; names that it has not are
/// passed over. An error (no_faces) if it has none of them. The labels do not follow.
Result<CadBody> parts_of_body(const CadBody& body, const std::vector<std::string>& names, const std::string& source);

}  // namespace curvetet
