// How much memory the process has.
#pragma once

#include <cstddef>

namespace curvetet {

/// Bytes of the process that are in the machine's memory now (resident), and the most there have been; 0 where the
/// system does not tell.
std::size_t resident_memory();
std::size_t peak_resident_memory();

}  // namespace curvetet
