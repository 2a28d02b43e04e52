// The stages in order, for a body from wherever: a file or a shape in memory.
#pragma once

#include <cstdint>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "curvetet/curvetet.h"
#include "geometry/model.h"
#include "pipeline/body_mesher.h"

namespace curvetet {

/// What to mesh.
struct Source {
  std::string name;  ///< what messages and the report call it
  /// Called with options that were found sane; again with faces (cad ids) that a mesh lets cross, where it is an error
  /// (self_intersection) if the CAD kernel confirms it.
  std::function<Result<Model>(const std::vector<std::uint32_t>& suspects, Context&)> load;
  std::function<std::string()> hash;  ///< of its bytes, asked for once loading went well; empty if it has none
  // What a dossier asks for: the healed body that the model was made of, as pack_body gives it, and parts of the input
  // ("face 12") as BREP text.
  std::function<Result<std::string>()> body;
  std::function<Result<std::string>(const std::vector<std::string>& parts, Context&)> parts;
  OuterLoop loop;  ///< where it stands from the beginning
};

/// What came as an exception, in words.
Error error_of(const std::exception& thrown, const Options& options);

Result<MeshOutput> mesh_source(const Source& source, const Options& options, Context& context,
                               Report* report_on_failure);

}  // namespace curvetet
