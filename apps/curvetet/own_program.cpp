#include "own_program.h"

#include <filesystem>

namespace curvetet::cli {

std::string own_program() {
  std::error_code code;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", code);
  return code ? std::string() : self.string();
}

}  // namespace curvetet::cli
