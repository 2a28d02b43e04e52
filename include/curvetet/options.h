// What to mesh and how. Lengths are in the output's unit.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "curvetet/mesh.h"

namespace curvetet {

/// Sizes asked for one CAD entity, by id ("12") or by name ("inlet").
struct LocalSize {
  enum class Kind { face, edge, solid } kind = Kind::face;
  std::string which;
  double size = 0;
};

enum class RecoveryMode { conjoint, paper };

/// What is done with solids that overlap: refused, or split so that what they have in common is a solid of its own.
enum class Overlaps { refuse, split };

struct Options {
  std::optional<double> size;  ///< largest edge length; default: the body's diagonal over `size_divisor`
  double size_divisor = 10;    ///< at least 1
  std::optional<double>
      min_size;           ///< floor of derived sizes; default: size / 1000, size / 50 for curvature of free forms
  double curvature = 12;  ///< elements per full turn; 0: off
  std::optional<double> chord_height;  ///< largest distance of a chord to its arc; default: off
  double grading = 0.5;                ///< growth of the size per length, > 0
  bool gaps = true;                    ///< chord height at most a quarter of the local gap
  std::vector<LocalSize> local_sizes;
  std::function<double(Point)> size_callback;

  std::string unit;  ///< of the output: "um", "mm", "cm", "m", "inch", "ft"; default: mm, or `input_unit` if given
  std::string input_unit;  ///< of BREP files and shapes in memory, which carry none; default: mm
  Overlaps overlaps = Overlaps::refuse;
  bool isolate_cad = true;  ///< read and heal in a helper process
  std::string cad_helper;   ///< the curvetet program that helps; default: this one, or one beside it, if so named

  RecoveryMode recovery = RecoveryMode::conjoint;
  bool refine_interior = true;
  bool improve = true;
  double radius_edge = 2.0;          ///< bound for tets away from the boundary
  std::optional<double> time_limit;  ///< seconds
  std::size_t memory_limit = 0;      ///< bytes of our own arrays; 0: none
  int threads = 0;                   ///< 0: all cores
  std::uint64_t seed = 1;
};

}  // namespace curvetet
