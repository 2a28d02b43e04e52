// What a failed run leaves in a folder: words, the report, the CAD faces, the surface meshes of the spot, and the state
// to make the attempt again (docs/dossier.md).
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "curvetet/mesh.h"
#include "curvetet/report.h"
#include "pipeline/state.h"

namespace curvetet {

/// A failed run, as far as it got.
struct FailedRun {
  const Report& report;                           ///< has an error
  std::map<std::string, std::string> in_words{};  ///< "face 12": "face 12 (cylinder, inlet)"; empty: not known
  std::optional<Mesh> spot{};                     ///< none: no attempt failed that had surface triangles to show
  /// The parts of the input that are named ("face 12"), as BREP text.
  std::function<Result<std::string>(const std::vector<std::string>& names)> parts{};
  std::string no_state{};  ///< why there is none
  std::optional<State> state{};
};

/// Writes summary.txt, report.json, and of faces.brep, spot.vtu and replay.bin those that there is something for;
/// summary.txt says which and why not. Each appears whole or not at all, and replaces, or removes, that of an earlier
/// run. The folder is made if it is missing, and not left empty. The error (output_unwritable) is that of the first
/// file that could not be written; the others are there.
Status write_dossier(const FailedRun& run, const std::string& folder);

}  // namespace curvetet
