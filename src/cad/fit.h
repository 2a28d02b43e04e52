// Parameter curves that do not run along their edge, and tolerances that do not tell the truth.
#pragma once

#include "geometry/model.h"

namespace curvetet {

/// Measures how far surface(parameter curve(t)) lies from curve(t). Where the edge lies on the surface but the two are
/// parametrized differently, the parameter curve is replaced by the projection of the edge's curve. What distance
/// remains becomes the tolerance of the edge, up to a ten-thousandth of the body; larger ones are left for the check to
/// find. The same for vertices off the ends of their edges. Notes go to the model's healing.
void fit_parameter_curves(Model& model);

}  // namespace curvetet
