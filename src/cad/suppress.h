// Small details taken out of a body on request. Inside cad only.
#pragma once

#include <functional>

#include "cad/body.h"

namespace curvetet {

/// Removes faces narrower than `length`, so that their neighbours meet in their place, alone or in connected sets, and
/// chooses edges that are shorter for convert_body to take as points. Each detail goes only if what is left is valid
/// and as closed as before, lacks nothing else, differs by no more than the detail explains, and is accepted by
/// `is_sound`; otherwise it stays as it is, and a note says why. `body.suppressed` lists what went; whatever is left
/// keeps its id.
void suppress_details(CadBody& body, double length, const std::function<bool(const CadBody&)>& is_sound);

}  // namespace curvetet
