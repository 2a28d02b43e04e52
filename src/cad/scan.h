// A look at the text of a CAD file before OpenCASCADE's reader sees it: for what its readers loop on or let pass.
#pragma once

#include <optional>
#include <string>

#include "base/error.h"

namespace curvetet {

/// Numbers of a STEP file that are none (nan, inf) or beyond any body (exponents above 100); names the entity.
/// O(bytes).
std::optional<Error> scan_step(const std::string& path);

/// Whether a text BREP file is there to its end: `tail` are its last bytes.
bool brep_is_complete(const std::string& tail);

}  // namespace curvetet
