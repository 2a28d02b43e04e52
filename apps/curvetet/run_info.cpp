#include <fmt/format.h>

#include <filesystem>

#include "cad/load.h"
#include "commands.h"
#include "geometry/describe.h"
#include "terminal.h"

namespace curvetet::cli {

std::string own_program() {
  std::error_code code;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", code);
  return code ? std::string() : self.string();
}

int run_info(const InfoCommand& command) {
  Context context;
  Terminal terminal(Volume::quiet);
  terminal.attach(context);
  const CancelOnSignal signals(context);
  LoadOptions options;
  options.input_unit = command.input_unit;
  options.isolate = command.isolate;
  options.helper = own_program();
  options.overlaps = command.overlaps;
  const Result<Model> model = load_model(command.input, options, context);
  if (!model) return show_error(model.error());
  const Result<std::string> text = describe_model(model.value(), command.json);
  if (!text) return show_error(text.error());
  fmt::print("{}", text.value());
  return 0;
}

}  // namespace curvetet::cli
