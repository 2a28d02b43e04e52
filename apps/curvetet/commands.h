// The six commands. Each returns the exit code; exceptions are the caller's business.
#pragma once

#include "arguments.h"

namespace curvetet::cli {

int run_mesh(const MeshCommand& command);
int run_info(const InfoCommand& command);
int run_check(const CheckCommand& command);
int run_picture(const PictureCommand& command);
int run_batch(const BatchCommand& command);
int run_replay(const ReplayCommand& command);

}  // namespace curvetet::cli
