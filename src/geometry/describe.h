// What is in a body, in words or as JSON: for `curvetet info`.
#pragma once

#include <string>

#include "base/error.h"
#include "geometry/model.h"

namespace curvetet {

/// Unit, box, counts by kind of surface, solids (name, path, volume, faces), faces (id, kind, name, area, solids),
/// edges (id, kind, name, faces), and the healing notes. Lengths are in the model's unit. As JSON: one object,
/// keys in a fixed order, "schema": 1. Never fails for a model that load_model made.
Result<std::string> describe_model(const Model& model, bool json);

}  // namespace curvetet
