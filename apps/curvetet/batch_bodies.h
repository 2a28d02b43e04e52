// Which bodies a batch is about, and what their meshes are called.
#pragma once

#include <string>
#include <vector>

#include "curvetet/error.h"

namespace curvetet::cli {

struct BatchBody {
  std::string name;  ///< as the list has it, or relative to the folder
  std::string path;  ///< of the CAD file
  std::string stem;  ///< of the files made for it; unique, a plain file name
};

/// The bodies of a list (a path a line, relative to the list's folder, # for comments, each once), or all STEP, IGES
/// and BREP files of a folder and those below it, in the order of their names. Errors: not there, not readable, no
/// body.
Result<std::vector<BatchBody>> find_bodies(const std::string& source);

}  // namespace curvetet::cli
