// With isolation everything that runs the CAD kernel's readers and repairs happens in the helper; what comes back is a
// shape that was converted once already, and is converted again here.
#include "cad/load.h"

#include "cad/convert.h"
#include "cad/heal.h"
#include "cad/isolate.h"
#include "cad/read.h"

namespace curvetet {

namespace {

/// Keeps the body that the model was made of, if both are wanted and there.
Result<Model> keep(Result<Model> model, CadBody body, KeptBody* kept) {
  if (model && kept != nullptr) *kept = std::make_shared<const CadBody>(std::move(body));
  return model;
}

}  // namespace

Result<Model> load_model(const std::string& path, const LoadOptions& options, Context& context, KeptBody* kept) {
  if (context.should_stop()) return context.stop_error("load");
  if (const Result<CadFormat> format = detect_format(path); !format) return format.error();
  if (options.isolate) {
    if (const auto helper = find_helper(options)) {
      Result<CadBody> body = read_isolated(path, *helper, options, {}, context);
      if (!body) return body.error();
      Result<Model> model = convert_body(body.value(), path);
      return keep(std::move(model), std::move(body.value()), kept);
    }
    context.log(LogLevel::warning, "no helper program found: the CAD file is read in this process");
  }
  Result<CadBody> body = read_body(path, options.input_unit);
  if (!body) return body.error();
  if (context.should_stop()) return context.stop_error("load");
  Result<Model> model = heal_and_convert(body.value(), path, {options.joining, options.min_feature, options.suspects});
  return keep(std::move(model), std::move(body.value()), kept);
}

}  // namespace curvetet
