// The stages in order, for a body from wherever: a file or a shape in memory.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "curvetet/curvetet.h"
#include "geometry/model.h"

namespace curvetet {

/// What to mesh. `load` is called once, with options that were found sane.
struct Source {
  std::string name;  ///< what messages and the report call it
  std::function<Result<Model>(Context&)> load;
  /// Whether the CAD kernel, too, says that these faces (cad ids) cross; empty: nobody can tell.
  std::function<std::optional<Error>(const std::vector<std::uint32_t>&, Context&)> confirm_crossing;
  std::function<std::string()> hash;  ///< of its bytes, asked for once loading went well; empty if it has none
};

Result<MeshOutput> mesh_source(const Source& source, const Options& options, Context& context,
                               Report* report_on_failure);

}  // namespace curvetet
