// `curvetet mesh`, and what it has in common with `replay`: meshes, writes the outputs and the report, and says in
// words what was done. The report is written whatever happened, a mesh only if it is valid or the user insists.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <new>

#include "commands.h"
#include "curvetet/curvetet.h"
#include "mesh_to_files.h"
#include "pipeline/pipeline.h"
#include "summary.h"
#include "terminal.h"

namespace curvetet::cli {

namespace {

/// Whether a file could be put there; asked before any work, since meshing may take long.
Status check_writable(const std::string& path) {
  std::error_code ignored;
  const std::filesystem::path folder = std::filesystem::absolute(path, ignored).parent_path();
  const auto error = [&](const std::string& why) {
    return Error{ErrorCode::output_unwritable,
                 fmt::format("{} cannot be written: {}", path, why),
                 {},
                 {},
                 "nothing was meshed yet; choose another place"};
  };
  if (std::filesystem::is_directory(path, ignored)) return error("it is a folder");
  if (!std::filesystem::is_directory(folder, ignored)) return error(folder.string() + " is not a folder");
  if (::access(folder.c_str(), W_OK | X_OK) != 0) return error(folder.string() + " does not permit it");
  return Done{};
}

Status check_outputs(const MeshCommand& command) {
  for (const Output& output : command.outputs) {
    if (Status status = check_writable(output.path); !status) return status;
  }
  return command.report.empty() ? Status(Done{}) : check_writable(command.report);
}

/// Writes the report if one is wanted; the exit code is the worse of the given one and that of a failed writing.
int keep_report(const MeshCommand& command, const Report& report, int code) {
  if (command.report.empty()) return code;
  const Status written = write_file_atomically(command.report, report.to_json());
  if (written) return code;
  const int failed = show_error(written.error());
  return code == 0 ? failed : code;
}

int write_outputs(const MeshCommand& command, const Mesh& mesh) {
  for (const Output& output : command.outputs) {
    if (const Status written = write_mesh(mesh, output.path, output.options); !written)
      return show_error(written.error());
  }
  return 0;
}

int finish(const MeshCommand& command, const MeshOutput& made) {
  const bool write = made.report.valid || command.keep_invalid;
  int code = write ? write_outputs(command, made.mesh) : 0;
  if (!command.quiet) fmt::print("{}", summary(made.report));
  if (code == 0 && !made.report.valid) {
    code = show_error({ErrorCode::invalid_mesh,
                       "the mesh did not pass its final check",
                       {},
                       {},
                       command.keep_invalid ? "" : "nothing was written; --keep-invalid writes it all the same"});
  }
  return keep_report(command, made.report, code);
}

/// While it lives, the program gets no more than so many bytes of memory for data; 0: no limit. Allocations beyond
/// fail.
class DataLimit {
 public:
  explicit DataLimit(std::size_t bytes) {
    if (bytes == 0 || ::getrlimit(RLIMIT_DATA, &before_) != 0) return;
    struct rlimit limit = before_;
    limit.rlim_cur = std::min<rlim_t>(bytes, before_.rlim_max);
    is_set_ = ::setrlimit(RLIMIT_DATA, &limit) == 0;
  }
  ~DataLimit() {
    if (is_set_) ::setrlimit(RLIMIT_DATA, &before_);
  }
  DataLimit(const DataLimit&) = delete;
  DataLimit& operator=(const DataLimit&) = delete;

 private:
  struct rlimit before_ {};
  bool is_set_ = false;
};

Result<MeshOutput> mesh_within_limits(const MeshCommand& command, const Mesher& mesher, Context& context,
                                      Report& report) {
  const DataLimit limit(command.options.memory_limit);
  return mesher(context, &report);
}

/// An exception from within is an error like others, so that the report is still kept.
Result<MeshOutput> mesh_or_internal_error(const MeshCommand& command, const Mesher& mesher, Context& context,
                                          Report& report) {
  const auto kept = [&](Error error) {
    report.version = version();
    report.input = command.input;
    report.errors.push_back(error);
    return error;
  };
  try {
    return mesh_within_limits(command, mesher, context, report);
  } catch (const std::exception& thrown) {
    return kept(error_of(thrown, command.options));
  }
}

}  // namespace

int mesh_to_files(const MeshCommand& command, const Mesher& mesher, Report& report) {
  if (const Status writable = check_outputs(command); !writable) return show_error(writable.error());
  Context context;
  Terminal terminal(command.quiet ? Volume::quiet : command.verbose ? Volume::verbose : Volume::normal);
  terminal.attach(context);
  const CancelOnSignal signals(context);
  context.threads = command.options.threads;
  context.seed = command.options.seed;
  context.memory_limit = command.options.memory_limit;
  const Result<MeshOutput> made = mesh_or_internal_error(command, mesher, context, report);
  terminal.clear_bar();
  if (!made) return keep_report(command, report, show_error(made.error()));
  report = made.value().report;
  return finish(command, made.value());
}

int run_mesh(const MeshCommand& command) {
  Report report;
  const Mesher mesher = [&](Context& context, Report* failed) {
    return mesh({command.input}, command.options, context, failed);
  };
  return mesh_to_files(command, mesher, report);
}

}  // namespace curvetet::cli
