// Makes a shape that the mesher can rely on, changing it as little as possible, and says what was changed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "cad/body.h"
#include "cad/joining.h"

namespace curvetet {

/// Sews faces into solids where there are none or where a solid is open, repairs what the check of the converted model
/// finds broken, and returns that model. `body` becomes the healed shape; ids stay those of the shape as it came.
/// Errors: no_faces, no_solid, open_shell (number of free edges, and a place), bad_face (which, and what is wrong), and
/// those of convert_body; overlapping_solids where those are refused; not_conformal where solids that touch must be
/// joined and cannot; self_intersection where the kernel finds that the suspects (faces, by cad id) cross.
Result<Model> heal_and_convert(CadBody& body, const std::string& source, const Joining& joining,
                               const std::vector<std::uint32_t>& suspects = {});

}  // namespace curvetet
