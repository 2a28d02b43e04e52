// Makes a shape that the mesher can rely on, changing it as little as possible, and says what was changed.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/units.h"
#include "cad/body.h"
#include "cad/joining.h"

namespace curvetet {

struct HealOptions {
  Joining joining;
  Length min_feature;                     ///< details below are suppressed; 0: none
  std::vector<std::uint32_t> suspects{};  ///< faces, by cad id: do they cross?
};

/// Sews faces into solids where there are none or where a solid is open, repairs what the check of the converted model
/// finds broken, and returns that model. `body` becomes the healed shape; ids stay those of the shape as it came.
/// Errors: no_faces, no_solid, open_shell (number of free edges, and a place), bad_face (which, and what is wrong), and
/// those of convert_body; overlapping_solids where those are refused; not_conformal where solids that touch must be
/// joined and cannot; self_intersection where the kernel finds that the suspects cross; bad_option for a smallest
/// feature that is no length or more than a tenth of the body's diagonal.
Result<Model> heal_and_convert(CadBody& body, const std::string& source, const HealOptions& options);

}  // namespace curvetet
