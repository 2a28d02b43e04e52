// The stages in order, for a body from wherever: a file or a shape in memory.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "curvetet/curvetet.h"
#include "geometry/model.h"

namespace curvetet {

/// What to mesh.
struct Source {
  std::string name;  ///< what messages and the report call it
  /// Called with options that were found sane; again with faces (cad ids) that a mesh lets cross, where it is an error
  /// (self_intersection) if the CAD kernel confirms it.
  std::function<Result<Model>(const std::vector<std::uint32_t>& suspects, Context&)> load;
  std::function<std::string()> hash;  ///< of its bytes, asked for once loading went well; empty if it has none
};

Result<MeshOutput> mesh_source(const Source& source, const Options& options, Context& context,
                               Report* report_on_failure);

}  // namespace curvetet
