// Hashes that are the same on every machine.
#pragma once

#include <cstdint>
#include <string_view>

namespace curvetet {

/// FNV-1a with 64 bits: tells damage and change, not malice.
class Fnv1a {
 public:
  void add(std::uint64_t value) { value_ = (value_ ^ value) * 0x100000001b3ULL; }
  void add(std::string_view bytes) {
    for (const char c : bytes) add(static_cast<unsigned char>(c));
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

}  // namespace curvetet
