// From the caller's options to the stages' own: checked, resolved against the model, in working units.
#pragma once

#include <string>

#include "base/error.h"
#include "curvetet/options.h"
#include "geometry/model.h"
#include "sizing/size_field.h"

namespace curvetet {

/// Refuses absurd options (sizes that are not positive and finite, unknown units, ...) before any work.
Status check_options(const Options& options);

/// Everything derived from options and model.
struct Settings {
  double unit_scale = 1;  ///< output length = CAD length * unit_scale
  std::string unit;       ///< the output's
  double size = 0;        ///< working units
  double floor = 0;       ///< spacing floor of recovery, working units
  SizingOptions sizing;
};

/// An error names the local size whose entity does not exist, or a size out of all proportion to the body.
Result<Settings> resolve(const Options& options, const Model& model);

/// The options in full, as the report echoes them.
std::string options_json(const Options& options, const Settings& settings, const Model& model);

}  // namespace curvetet
