// From a file to a labelled shape, unchanged: no healing yet.
#pragma once

#include <string>

#include "base/error.h"
#include "cad/body.h"

namespace curvetet {

enum class CadFormat { step, iges, brep, binary_brep };

/// By content, then by ending. Errors: file_not_found, file_unreadable (a directory), empty_file, unknown_format.
Result<CadFormat> detect_format(const std::string& path);

/// Reads the file with names, colours and assembly paths. `input_unit` is the unit of files that carry none (BREP).
/// STEP and IGES come in millimetres; a note says what the file had. The labels number the parts of the shape as read.
Result<CadBody> read_body(const std::string& path, const std::string& input_unit);

}  // namespace curvetet
