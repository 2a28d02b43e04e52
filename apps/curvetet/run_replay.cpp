// `curvetet replay`: a failed run's last attempt again; says whether it ends as recorded.
#include <fmt/format.h>

#include "commands.h"
#include "mesh_to_files.h"
#include "pipeline/replay.h"
#include "terminal.h"

namespace curvetet::cli {

namespace {

/// True if the options are others now.
bool apply(const ReplayChanges& changes, Options& options) {
  bool changed = !changes.local_sizes.empty();
  const auto set = [&](auto& option, const auto& value) {
    if (!value) return;
    option = *value;
    changed = true;
  };
  if (changes.size_divisor) options.size.reset();
  set(options.size, changes.size);
  set(options.size_divisor, changes.size_divisor);
  set(options.min_size, changes.min_size);
  set(options.curvature, changes.curvature);
  set(options.recovery, changes.recovery);
  set(options.seed, changes.seed);
  options.local_sizes.insert(options.local_sizes.end(), changes.local_sizes.begin(), changes.local_sizes.end());
  return changed;
}

void say_whether_it_recurs(const State& state, const Report& report) {
  fmt::print("recorded  {} [{}]\n", state.failure.message, name(state.failure.code));
  if (report.errors.empty()) {
    fmt::print("now       valid: the failure does not recur\n");
    return;
  }
  const Error& now = report.errors.front();
  fmt::print("now       {} [{}]\n", now.message, name(now.code));
  fmt::print("          {}\n", recurs(state, now) ? "the failure recurs" : "another failure");
}

}  // namespace

int run_replay(const ReplayCommand& command) {
  Result<State> read = read_state(command.mesh.input);
  if (!read) return show_error(read.error());
  State& state = read.value();
  if (state.version != version())
    fmt::print(stderr, "curvetet: warning: the state is of version {}, this is {}\n", state.version, version());
  MeshCommand mesh = command.mesh;
  if (apply(command.changes, state.options)) state.loop = OuterLoop();
  state.options.threads = mesh.options.threads;
  state.options.time_limit = mesh.options.time_limit;
  state.options.memory_limit = mesh.options.memory_limit;
  state.options.dossier = mesh.options.dossier;
  mesh.options = state.options;
  Report report;
  const Mesher mesher = [&](Context& context, Report* failed) { return replay(state, context, failed); };
  const int code = mesh_to_files(mesh, mesher, report);
  if (!mesh.quiet && (code == 0 || !report.errors.empty())) say_whether_it_recurs(state, report);
  return code;
}

}  // namespace curvetet::cli
