// A file that appears whole or not at all: written beside its place under another name, flushed to the disk, then
// renamed.
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/error.h"

namespace curvetet {

/// Before commit() succeeds, the path is untouched; if the object dies first, nothing is left behind. A failed write is
/// remembered and reported by commit(). A path that is a device or a pipe is written to directly.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void put(std::string_view bytes) {
    buffer_.append(bytes);
    if (buffer_.size() >= kBufferSize) flush();
  }
  void put(const char* bytes) { put(std::string_view(bytes)); }
  void put(char c) { put(std::string_view(&c, 1)); }
  /// Shortest text that reads back as the same number.
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void put(Number number) {
    char text[40];
    const auto end = std::to_chars(text, text + sizeof text, number);
    put(std::string_view(text, static_cast<std::size_t>(end.ptr - text)));
  }
  /// The parts, separated by blanks, and a line end.
  template <class First, class... Rest>
  void line(const First& first, const Rest&... rest) {
    put(first);
    ((put(' '), put(rest)), ...);
    put('\n');
  }
  /// The bytes of a value as they are in memory.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void raw(const T& value) { put(std::string_view(reinterpret_cast<const char*>(&value), sizeof value)); }

  Status commit();

 private:
  static constexpr std::size_t kBufferSize = std::size_t{1} << 20U;
  void open_beside();
  void flush();
  void fail(const char* doing);
  void discard();

  std::string path_, temporary_, failure_, buffer_;
  int descriptor_ = -1;
};

}  // namespace curvetet
