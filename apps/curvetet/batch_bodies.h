// Which bodies a batch is about, and what their meshes are called.
#pragma once

#include <string>
#include <vector>

#include "curvetet/error.h"

namespace curvetet::cli {

struct BatchBody {
  std::string name;                  ///< as the list has it, or relative to the folder
  std::vector<std::string> options;  ///< of `mesh`, for this body alone
  std::string path;                  ///< of the CAD file
  std::string stem;                  ///< of the files made for it; unique, a plain file name
};

/// The bodies of a list, or all STEP, IGES and BREP files of a folder and those below it, in the order of their names.
/// A line of a list is a path, relative to the list's folder, and options for this body, if any, separated by tabs;
/// lines with # are comments; equal lines count once. Errors: not there, not readable, no body.
Result<std::vector<BatchBody>> find_bodies(const std::string& source);

}  // namespace curvetet::cli
