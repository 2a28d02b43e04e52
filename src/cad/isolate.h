// Reading and healing in a process of its own. Inside cad only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/context.h"
#include "cad/body.h"
#include "cad/load.h"

namespace curvetet {

/// The program that can serve as helper: the one asked for, this executable if it is curvetet, or the curvetet beside
/// it.
std::optional<std::string> find_helper(const LoadOptions& options);

/// Reads and heals `path` in a helper process, which is killed when its time is over or the context says stop. With
/// `parts` ("face 12"), reads only, and returns these parts of the input. Errors: the helper's own, reader_crashed,
/// reader_failed (also when it takes too long), cancelled, bad_option (the program is no helper).
Result<CadBody> read_isolated(const std::string& path, const std::string& helper, const LoadOptions& options,
                              const std::vector<std::string>& parts, Context& context);

}  // namespace curvetet
