// With isolation everything that runs the CAD kernel's readers and repairs happens in the helper; what comes back is a
// shape that was converted once already, and is converted again here.
#include "cad/load.h"

#include "cad/convert.h"
#include "cad/heal.h"
#include "cad/isolate.h"
#include "cad/read.h"

namespace curvetet {

Result<Model> load_model(const std::string& path, const LoadOptions& options, Context& context) {
  if (context.should_stop()) return context.stop_error("load");
  if (const Result<CadFormat> format = detect_format(path); !format) return format.error();
  if (options.isolate) {
    if (const auto helper = find_helper(options)) {
      Result<CadBody> body = read_isolated(path, *helper, options, context);
      if (!body) return body.error();
      return convert_body(body.value(), path);
    }
    context.log(LogLevel::warning, "no helper program found: the CAD file is read in this process");
  }
  Result<CadBody> body = read_body(path, options.input_unit);
  if (!body) return body.error();
  if (context.should_stop()) return context.stop_error("load");
  return heal_and_convert(body.value(), path, {options.joining, options.min_feature, options.suspects});
}

}  // namespace curvetet
