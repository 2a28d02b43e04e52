// The independent check of a mesh whose parts were meshed apart (geometry/parts.h).
#pragma once

#include "quality/validate.h"

namespace curvetet {

/// As validate(), for each part of the mesh (what hangs together through nodes) alone and against the solids it has.
/// Parts may meet and overlap, and each has nodes of its own where they share edges of the CAD. Without a model,
/// against nothing. Errors besides: empty_solid for a solid without tets.
ValidationReport validate_parts(const Mesh& mesh, const Model* model, double unit_scale, Context& context);

}  // namespace curvetet
