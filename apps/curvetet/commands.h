// The four commands. Each returns the exit code; exceptions are the caller's business.
#pragma once

#include <string>

#include "arguments.h"

namespace curvetet::cli {

/// Path of the running program, which reads CAD files as a helper of its own, whatever it was renamed to; empty where
/// the system does not tell.
std::string own_program();

int run_mesh(const MeshCommand& command);
int run_info(const InfoCommand& command);
int run_check(const CheckCommand& command);
int run_picture(const PictureCommand& command);

}  // namespace curvetet::cli
