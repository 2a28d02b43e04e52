// What a failed run needs of the CAD once the Model is made: the healed body as bytes, from which the same Model is
// made again without the file and without repairs, and single parts of the input as BREP.
//
// The bytes are OpenCASCADE's. A form of our own for all curves and surfaces was rejected: free forms are evaluated by
// OpenCASCADE, and another evaluator would differ in the last bits, so that a failure need not occur again.
#pragma once

#include <string>
#include <vector>

#include "base/context.h"
#include "base/error.h"
#include "cad/load.h"
#include "geometry/model.h"

namespace curvetet {

Result<std::string> pack_body(const KeptBody& body);
/// REQUIRED: the bytes are as pack_body made them (a checksum tells): OpenCASCADE trusts what it reads. Bytes of
/// another version, or of something else, are an error (file_unreadable).
Result<KeptBody> unpack_body(const std::string& bytes);

/// The model again. With suspects (faces, by cad id) it is an error, self_intersection, if the CAD kernel finds that
/// they cross. `source` names the body in messages.
Result<Model> model_of(const KeptBody& body, const std::string& source, const std::vector<std::uint32_t>& suspects);

/// These parts ("face 12", by cad id) as the text of a BREP file; names without a part are passed over, and none at all
/// is an error (no_faces).
Result<std::string> brep_of_parts(const KeptBody& body, const std::vector<std::string>& parts,
                                  const std::string& source);
/// Those of a file as it is, before any repair; read in a helper process if the options say so.
Result<std::string> brep_of_parts(const std::string& path, const LoadOptions& options,
                                  const std::vector<std::string>& parts, Context& context);

}  // namespace curvetet
