#include "base/error.h"

#include <fmt/format.h>

namespace curvetet {

const char* name(ErrorCode code) {
  switch (code) {
    case ErrorCode::bad_option:
      return "bad_option";
    case ErrorCode::file_not_found:
      return "file_not_found";
    case ErrorCode::file_unreadable:
      return "file_unreadable";
    case ErrorCode::unknown_format:
      return "unknown_format";
    case ErrorCode::empty_file:
      return "empty_file";
    case ErrorCode::reader_failed:
      return "reader_failed";
    case ErrorCode::reader_crashed:
      return "reader_crashed";
    case ErrorCode::no_faces:
      return "no_faces";
    case ErrorCode::no_solid:
      return "no_solid";
    case ErrorCode::open_shell:
      return "open_shell";
    case ErrorCode::not_finite:
      return "not_finite";
    case ErrorCode::zero_size:
      return "zero_size";
    case ErrorCode::unbounded:
      return "unbounded";
    case ErrorCode::overlapping_solids:
      return "overlapping_solids";
    case ErrorCode::bad_face:
      return "bad_face";
    case ErrorCode::self_intersection:
      return "self_intersection";
    case ErrorCode::output_unwritable:
      return "output_unwritable";
    case ErrorCode::not_conformal:
      return "not_conformal";
    case ErrorCode::cancelled:
      return "cancelled";
    case ErrorCode::time_limit:
      return "time_limit";
    case ErrorCode::memory_limit:
      return "memory_limit";
    case ErrorCode::invalid_mesh:
      return "invalid_mesh";
    case ErrorCode::recovery_failed:
      return "recovery_failed";
    case ErrorCode::internal:
      return "internal";
  }
  return "internal";
}

int exit_code(ErrorCode code) {
  const int value = static_cast<int>(code);
  if (value < 200) return 2;
  if (value < 300) return 3;
  if (value < 400) return 4;
  return value < 500 ? 5 : 70;
}

void fail_internal(const char* what, const char* file, int line) {
  throw InternalError(fmt::format("internal check failed: {} ({}:{})", what, file, line));
}

}  // namespace curvetet
