// The running program, which reads CAD files as a helper of its own.
#pragma once

#include <string>

namespace curvetet::cli {

/// Its path, whatever it was renamed to; empty where the system does not tell.
std::string own_program();

}  // namespace curvetet::cli
