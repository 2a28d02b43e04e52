// From a CAD file to a Model: read, convert units, heal with a report, classify solids. The only room that sees
// OpenCASCADE.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "base/units.h"
#include "cad/joining.h"
#include "geometry/model.h"

namespace curvetet {

struct LoadOptions {
  std::string input_unit;  ///< for files that carry no unit: "mm", "cm", "m", "inch"; empty: mm
  Joining joining;
  Length min_feature;   ///< details below are suppressed (see heal.h); 0: none
  bool isolate = true;  ///< read and heal in a helper process, so that a crash or a loop there becomes a message
  double isolate_time_limit = 60;                            ///< seconds
  std::size_t isolate_memory_limit = std::size_t{4} << 30U;  ///< bytes
  /// Faces (cad ids) that a mesh lets cross: if the CAD kernel confirms it, that is an error (self_intersection).
  std::vector<std::uint32_t> suspects{};
  std::string helper;  ///< program that serves as helper ("curvetet" itself); empty: this executable
};

struct CadBody;
/// The healed body that a Model was made of, for those who may want it again (cad/kept_body.h).
using KeptBody = std::shared_ptr<const CadBody>;

/// Reads STEP, IGES or BREP (by content, then by ending). Ids are those of the input shape, carried through healing.
/// `kept`, if given, receives the body.
Result<Model> load_model(const std::string& path, const LoadOptions& options, Context& context,
                         KeptBody* kept = nullptr);

/// What the helper process runs: reads `path`, heals, writes the healed shape and its labels to `out_path`. Exit code
/// for main.
int run_cad_helper(int argc, char** argv);

}  // namespace curvetet
