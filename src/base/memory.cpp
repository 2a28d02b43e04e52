// Counting our own arrays was rejected: most of the memory of a run on a small mesh is the CAD kernel's, and it is the
// whole that fits into a machine or does not.
#include "base/memory.h"

#ifdef __linux__
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>
#endif

namespace curvetet {

#ifdef __linux__

std::size_t resident_memory() {
  std::ifstream file("/proc/self/statm");
  std::size_t total = 0, resident = 0;
  return file >> total >> resident ? resident * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) : 0;
}

std::size_t peak_resident_memory() {
  rusage usage{};
  return getrusage(RUSAGE_SELF, &usage) == 0 ? static_cast<std::size_t>(usage.ru_maxrss) * 1024 : 0;
}

#else

std::size_t resident_memory() { return 0; }
std::size_t peak_resident_memory() { return 0; }

#endif

}  // namespace curvetet
