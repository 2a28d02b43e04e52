// The library: one call from a CAD file to a labelled tetrahedral mesh.
#pragma once

#include <optional>
#include <string>

#include "curvetet/context.h"
#include "curvetet/error.h"
#include "curvetet/mesh.h"
#include "curvetet/options.h"
#include "curvetet/report.h"

namespace curvetet {

/// What to mesh: a file (STEP, IGES or BREP). For a shape in memory see curvetet/occt.h.
struct Input {
  std::string path;
};

struct MeshOutput {
  Mesh mesh;
  Report report;
};

/// Meshes a body. Never prints, never exits, keeps no global state; may run on any thread. Cancel and progress through
/// the context. On failure the error says what, where and what to do; `report_on_failure`, if given, receives what was
/// finished.
Result<MeshOutput> mesh(const Input& input, const Options& options, Context& context,
                        Report* report_on_failure = nullptr);

/// Version of the library, "0.1.0".
const char* version();

}  // namespace curvetet
