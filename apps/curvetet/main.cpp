// The program: hands the command line to a command, and turns whatever escapes it into exit code 70.
#include <fmt/format.h>

#include <cstring>
#include <exception>
#include <new>

#include "base/child_program.h"
#include "cad/load.h"
#include "commands.h"

namespace {

int run(int argc, char** argv) {
  using namespace curvetet::cli;
  const Arguments arguments = parse(argc, argv);
  if (arguments.mesh) return run_mesh(*arguments.mesh);
  if (arguments.info) return run_info(*arguments.info);
  if (arguments.check) return run_check(*arguments.check);
  if (arguments.picture) return run_picture(*arguments.picture);
  if (arguments.batch) return run_batch(*arguments.batch);
  if (arguments.replay) return run_replay(*arguments.replay);
  return arguments.exit_code;
}

constexpr int kInternal = 70;

int fail(const char* what) {
  fmt::print(stderr, "curvetet: internal error: {}\n  please report it, with the input and the command line\n", what);
  return kInternal;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    curvetet::end_with_parent();
    // The helper that reads CAD files is this same program, started again by the library.
    if (argc > 1 && std::strcmp(argv[1], "--cad-helper") == 0) return curvetet::run_cad_helper(argc, argv);
    return run(argc, argv);
  } catch (const std::bad_alloc&) {
    return fail("out of memory");
  } catch (const std::exception& error) {
    return fail(error.what());
  } catch (...) {
    return fail("unknown exception");
  }
}
