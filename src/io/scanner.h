// Reads numbers and words off untrusted bytes. Every step checks what is left, and nothing is allocated by a count that
// the file claims.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "base/error.h"

namespace curvetet {

/// Thrown and caught within this room: the file is not what it claims to be.
struct BadFile {
  std::string message;
  ErrorCode code = ErrorCode::reader_failed;
};

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}
  bool at_end() const { return at_ >= text_.size(); }
  std::size_t position() const { return at_; }
  std::size_t remaining() const { return text_.size() - at_; }
  std::string_view rest() const { return text_.substr(at_); }

  [[noreturn]] void fail(const std::string& what) const { throw BadFile{fmt::format("{} (near byte {})", what, at_)}; }
  /// The next line without its end; empty at the end of the file.
  std::string_view line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string_view found = text_.substr(at_, end - at_);
    at_ = std::min(end + 1, text_.size());
    while (!found.empty() && (found.back() == '\r' || found.back() == ' ')) found.remove_suffix(1);
    return found;
  }
  void skip_blanks() {
    while (!at_end() && is_blank(text_[at_])) ++at_;
  }
  /// The next word; fails at the end of the file.
  std::string_view word() {
    skip_blanks();
    const std::size_t begin = at_;
    while (!at_end() && !is_blank(text_[at_])) ++at_;
    if (at_ == begin) fail("the file ends too early");
    return text_.substr(begin, at_ - begin);
  }
  template <class Number>
  Number number() {
    std::string_view text = word();
    if (text.front() == '+') text.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      fail(fmt::format("a number was expected, not '{}'", shown(text)));
    return value;
  }
  template <class T>
  requires std::is_trivially_copyable_v<T> T raw() {
    if (remaining() < sizeof(T)) fail("the file ends too early");
    T value;
    std::memcpy(&value, text_.data() + at_, sizeof value);
    at_ += sizeof value;
    return value;
  }
  void skip(std::size_t n) {
    if (remaining() < n) fail("the file ends too early");
    at_ += n;
  }
  /// Moves behind the next occurrence; fails if there is none.
  void skip_past(std::string_view what) {
    const std::size_t found = text_.find(what, at_);
    if (found == std::string_view::npos) fail(fmt::format("'{}' is missing", what));
    at_ = found + what.size();
  }
  /// At most 40 printable bytes, for messages.
  static std::string shown(std::string_view text) {
    std::string result;
    for (const char c : text.substr(0, 40)) result.push_back(c >= 32 && c < 127 ? c : '?');
    return result;
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\n' || c == '\t' || c == '\r'; }
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace curvetet
