// The volume that a solid's faces enclose, as their parameters say: a second opinion to the CAD kernel's.
#pragma once

#include "geometry/model.h"

namespace curvetet {

struct EnclosedVolume {
  double volume = 0;  ///< working units cubed
  double error = 0;   ///< estimate of what the integration itself is off
};

/// Integrates (x . n) / 3 over the solid's faces. A face with the solid on both sides adds nothing. Gaps between faces
/// count as they do in any sum over faces. REQUIRED: the uses of every loop are on one lift, as Loop says. Complexity:
/// some ten thousand evaluations of the surface for every use of an edge, up to a million where an edge has many
/// waves.
EnclosedVolume enclosed_volume(const Model& model, SolidId solid);

}  // namespace curvetet
