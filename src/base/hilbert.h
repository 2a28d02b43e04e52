// The Hilbert curve through the cells of a cube, by table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/vec.h"

namespace curvetet {

/// How one level of the curve runs: by state, which is the corner where the curve enters (three bits) and 8 times the
/// axis along which it leaves, and by octant (bit k: the upper half of axis k). An entry is the octant's number along
/// the curve and 8 times the state within it (Hamilton, Compact Hilbert Indices, 2006).
constexpr std::array<std::array<std::uint8_t, 8>, 24> hilbert_table() {
  const auto rotated_left = [](unsigned x, unsigned by) { return ((x << by % 3) | (x >> (3 - by % 3))) & 7U; };
  const auto gray = [](unsigned w) { return w ^ w >> 1; };
  const auto trailing_ones = [](unsigned w) {
    return (w & 1U) == 0 ? 0U : (w & 2U) == 0 ? 1U : (w & 4U) == 0 ? 2U : 3U;
  };
  std::array<std::array<std::uint8_t, 8>, 24> table{};
  for (unsigned state = 0; state < 24; ++state) {
    const unsigned entry = state & 7U, axis = state >> 3;
    for (unsigned w = 0; w < 8; ++w) {
      const unsigned octant = rotated_left(gray(w), axis + 1) ^ entry;
      const unsigned enters = w == 0 ? 0 : gray((w - 1) / 2 * 2);
      const unsigned along = w == 0 ? 0 : trailing_ones(w % 2 == 0 ? w - 1 : w);
      const unsigned next = (entry ^ rotated_left(enters, axis + 1)) | (axis + along + 1) % 3 << 3;
      table[state][octant] = static_cast<std::uint8_t>(w | next << 3);
    }
  }
  return table;
}

/// Index along the curve of a cell with coordinates below 2^bits; bits at most 21.
inline std::uint64_t hilbert_index(const std::array<std::uint32_t, 3>& cell, int bits) {
  static constexpr auto kTable = hilbert_table();
  std::uint64_t index = 0;
  std::size_t state = 0;
  for (int bit = bits - 1; bit >= 0; --bit) {
    const std::uint32_t octant = (cell[0] >> bit & 1U) | (cell[1] >> bit & 1U) << 1 | (cell[2] >> bit & 1U) << 2;
    const std::uint8_t step = kTable[state][octant];
    index = index << 3 | (step & 7U);
    state = step >> 3;
  }
  return index;
}

/// Index of the cell of a point whose coordinates lie between -1 and 1, in 2^20 cells a side.
inline std::uint64_t hilbert_index(Vec3 p) {
  constexpr int kBits = 20;
  const auto cell = [](double x) { return static_cast<std::uint32_t>((x + 1) * (1 << (kBits - 1))); };
  return hilbert_index({cell(p.x), cell(p.y), cell(p.z)}, kBits);
}

}  // namespace curvetet
