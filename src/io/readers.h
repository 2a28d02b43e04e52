// The readers, one per family of formats; each takes the whole file and throws BadFile on what it cannot read.
#pragma once

#include <string_view>

#include "curvetet/mesh.h"

namespace curvetet {

Mesh read_msh(std::string_view file);  ///< 4.1 and 2.2, text and binary
Mesh read_vtu(std::string_view file);  ///< as write_vtu writes it
Mesh read_medit(std::string_view file);

}  // namespace curvetet
