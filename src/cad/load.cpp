#include "cad/load.h"

#include "cad/heal.h"
#include "cad/read.h"

namespace curvetet {

Result<Model> load_model(const std::string& path, const LoadOptions& options, Context& context) {
  if (context.should_stop()) return context.stop_error("load");
  Result<CadBody> body = read_body(path, options.input_unit);
  if (!body) return body.error();
  if (context.should_stop()) return context.stop_error("load");
  return heal_and_convert(body.value(), path);
}

}  // namespace curvetet
