// What commands that make meshes have in common.
#pragma once

#include <functional>

#include "arguments.h"
#include "curvetet/curvetet.h"

namespace curvetet::cli {

using Mesher = std::function<Result<MeshOutput>(Context& context, Report* report_on_failure)>;

/// Runs the mesher within the command's limits, with progress on the terminal, and writes outputs and report. Returns
/// the exit code; `report` becomes the run's, and has no error if nothing was tried.
int mesh_to_files(const MeshCommand& command, const Mesher& mesher, Report& report);

}  // namespace curvetet::cli
