#include <fmt/format.h>

#include "cad/load.h"
#include "commands.h"
#include "geometry/describe.h"
#include "own_program.h"
#include "terminal.h"

namespace curvetet::cli {

int run_info(const InfoCommand& command) {
  Context context;
  Terminal terminal(Volume::quiet);
  terminal.attach(context);
  const CancelOnSignal signals(context);
  LoadOptions options;
  options.input_unit = command.input_unit;
  options.isolate = command.isolate;
  options.helper = own_program();
  options.joining = command.joining;
  options.min_feature.value = command.min_feature;
  const Result<Model> model = load_model(command.input, options, context);
  if (!model) return show_error(model.error());
  const Result<std::string> text = describe_model(model.value(), command.json);
  if (!text) return show_error(text.error());
  fmt::print("{}", text.value());
  return 0;
}

}  // namespace curvetet::cli
