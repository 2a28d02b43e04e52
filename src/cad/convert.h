// From a labelled shape to a Model. The shape is not changed; what is wrong with it is left to geometry/check.h to
// find.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "cad/body.h"

namespace curvetet {

/// Before: the shape's solids are the body; faces outside of them are ignored (with a note). Errors: no_faces,
/// no_solid, unbounded, not_finite, zero_size, overlapping_solids. `source` names the file in messages. The body's
/// measures are used where they are there, and completed.
Result<Model> convert_body(CadBody& body, const std::string& source);

/// The faces that reach to infinity, as "face 12"; at most twenty.
std::vector<std::string> unbounded_faces(const CadBody& body);

}  // namespace curvetet
