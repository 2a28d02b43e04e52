// The three kinds of failure: the input's fault (Error in a Result), our fault (InternalError, thrown), cancelled (a
// code).
#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "curvetet/vec.h"

namespace curvetet {

enum class ErrorCode {
  // the caller's options (exit code 2)
  bad_option = 100,
  // the input's fault (exit code 3)
  file_not_found = 200,
  file_unreadable,
  unknown_format,
  empty_file,
  reader_failed,
  reader_crashed,
  no_faces,
  no_solid,
  open_shell,
  not_finite,
  zero_size,
  unbounded,
  overlapping_solids,
  bad_face,
  self_intersection,
  output_unwritable,
  not_conformal,
  // no mesh within budget or wish (exit code 4)
  cancelled = 300,
  time_limit,
  memory_limit,
  // a mesh was made but is not valid (exit code 5)
  invalid_mesh = 400,
  recovery_failed,
  // our fault (exit code 70)
  internal = 500,
};

/// Stable lower-case name of a code, as the JSON report writes it.
const char* name(ErrorCode code);
/// Exit code of the command line for an error: 2, 3, 4, 5 or 70.
int exit_code(ErrorCode code);

/// A failure that is not ours: what, where, and what to do about it.
struct Error {
  ErrorCode code = ErrorCode::internal;
  std::string message;                  ///< one sentence, names the file or the CAD entity
  std::vector<std::string> entities{};  ///< e.g. "face 12", "edge 7": ids of the input shape
  std::optional<Vec3> where{};          ///< in the output's unit
  std::string hint{};                   ///< what the user can do
};

/// Our fault: an internal check failed.
class InternalError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

/// Throws InternalError; kept out of line so that checks stay cheap.
[[noreturn]] void fail_internal(const char* what, const char* file, int line);

/// Always-on O(1) internal check.
#define CURVETET_CHECK(condition)                                                \
  do {                                                                           \
    if (!(condition)) ::curvetet::fail_internal(#condition, __FILE__, __LINE__); \
  } while (false)

/// A value or an Error.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : data_(std::move(value)) {}      // NOLINT: implicit by intent
  Result(Error error) : data_(std::move(error)) {}  // NOLINT: implicit by intent
  bool ok() const { return data_.index() == 0; }
  explicit operator bool() const { return ok(); }
  T& value() { return std::get<0>(data_); }
  const T& value() const { return std::get<0>(data_); }
  const Error& error() const { return std::get<1>(data_); }

 private:
  std::variant<T, Error> data_;
};

/// Success without a value.
struct Done {};
using Status = Result<Done>;

}  // namespace curvetet
