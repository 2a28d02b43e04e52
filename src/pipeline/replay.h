// A failed run's last attempt once more, from its state: without the CAD file, reading and repairs.
#pragma once

#include "curvetet/curvetet.h"
#include "pipeline/state.h"

namespace curvetet {

/// Meshes as the run did that left the state, from the size field on, beginning at the round of its last attempt.
/// Errors and report as of mesh(); file_unreadable if the state is none of its body.
Result<MeshOutput> replay(const State& state, Context& context, Report* report_on_failure);

/// Is this the failure that the state was written for: same code, same entities, and no farther from its place than the
/// size that was asked for?
bool recurs(const State& state, const Error& failure);

}  // namespace curvetet
