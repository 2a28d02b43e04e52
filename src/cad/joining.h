// What is done with solids that touch or overlap.
#pragma once

#include "curvetet/options.h"

namespace curvetet {

struct Joining {
  Conformal conformal = Conformal::automatic;
  Overlaps overlaps = Overlaps::refuse;
};

}  // namespace curvetet
