// STEP is scanned as a stream of arguments: what stands between '(' ',' and ',' ')' outside of strings and comments. A
// word there is legal only before '(' (a typed value); of the others only those are refused that some writers put for
// numbers, so that sloppy files are left to the reader.
#include "cad/scan.h"

#include <cctype>
#include <cstdlib>
#include <fstream>
#include <string_view>

namespace curvetet {
namespace {

constexpr std::size_t kLongestWord = 40;
constexpr int kLargestExponent = 100;  // OpenCASCADE itself writes 2e100 for infinity

bool is_no_number(const std::string& word) {
  std::string text;
  for (const unsigned char c : word) text += static_cast<char>(std::tolower(c));
  const std::size_t sign = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  const std::string_view body = std::string_view(text).substr(sign);
  for (const std::string_view bad : {"nan", "inf", "infinity", "1.#"})
    if (body == bad || (bad.back() == '#' && body.starts_with(bad)) || body.starts_with("nan(")) return true;
  return false;
}

bool is_too_large(const std::string& word) {
  if (word.empty()) return false;
  const auto first = static_cast<unsigned char>(word.front());
  const std::size_t e = word.find_first_of("eE");
  if ((std::isdigit(first) == 0 && first != '-' && first != '+') || e == std::string::npos) return false;
  return word.size() - e > 12 || std::atoi(word.c_str() + e + 1) > kLargestExponent;
}

class StepScan {
 public:
  explicit StepScan(const std::string& path) : path_(path), in_(path, std::ios::binary) {}

  std::optional<Error> run() {
    char c = 0;
    while (in_.get(c)) {
      if (skipped(c) || std::isspace(static_cast<unsigned char>(c)) != 0) continue;
      const bool ends_argument = c == ',' || c == ')';
      if (ends_argument && (is_no_number(word_) || is_too_large(word_))) return bad_number();
      if (c == ';') entity_.clear();
      in_head_ = c == ';' || (in_head_ && c != '=');
      if (in_head_ && c != ';' && entity_.size() < kLongestWord) entity_ += c;
      if (ends_argument || c == '(' || c == ';') {
        word_.clear();
        in_argument_ = c == '(' || c == ',';
      } else if (in_argument_ && word_.size() < kLongestWord) {
        word_ += c;
      }
    }
    return std::nullopt;
  }

 private:
  /// Strings and comments.
  bool skipped(char c) {
    if (c == '\'') {
      while (in_.get(c) && c != '\'') continue;
      word_ += '\'';  // so that it is no number
      return true;
    }
    if (c != '/' || in_.peek() != '*') return false;
    for (char before = 0; in_.get(c) && !(before == '*' && c == '/');) before = c;
    return true;
  }

  Error bad_number() const {
    return Error{ErrorCode::not_finite,
                 path_ + " has a coordinate that is no number: '" + word_ + "' in entity " + entity_,
                 {entity_},
                 {},
                 "export the body again from the CAD system"};
  }

  std::string path_;
  std::ifstream in_;
  std::string word_;    ///< of the argument so far
  std::string entity_;  ///< "#12", before the '='
  bool in_argument_ = false, in_head_ = true;
};

}  // namespace

std::optional<Error> scan_step(const std::string& path) { return StepScan(path).run(); }

bool brep_is_complete(const std::string& tail) {
  // The last list of sub-shapes ends with '*'; after it comes the root: orientation, number, location, and nothing but
  // zeros and blanks.
  const std::size_t star = tail.rfind('*');
  if (star == std::string::npos) return false;
  std::size_t at = star + 1, numbers = 0;
  const auto skip_blanks = [&] {
    while (at < tail.size() && std::isspace(static_cast<unsigned char>(tail[at])) != 0) ++at;
  };
  skip_blanks();
  if (at == tail.size() || std::string_view("+-ie").find(tail[at]) == std::string_view::npos) return false;
  for (++at; at < tail.size(); ++numbers) {
    if (std::isdigit(static_cast<unsigned char>(tail[at])) == 0) return false;
    while (at < tail.size() && std::isdigit(static_cast<unsigned char>(tail[at])) != 0) ++at;
    skip_blanks();
  }
  return numbers >= 2;
}

}  // namespace curvetet
