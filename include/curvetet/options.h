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

/// Solids that touch are joined, so that they share what they touch in and the mesh is conformal across it: where the
/// CAD kernel can (automatic; a note in the report's healing where it cannot), or not at all (off: solids that share no
/// face in the file are meshed apart, each with nodes of its own, and may touch and overlap), or always (strict: it is
/// an error, not_conformal, where that fails).
enum class Conformal { automatic, off, strict };

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
  std::function<double(Point)> size_callback;  ///< size wanted at a point, or 0; called from several threads at a time

  std::string unit;  ///< of the output: "um", "mm", "cm", "m", "inch", "ft"; default: mm, or `input_unit` if given
  std::string input_unit;  ///< of BREP files and shapes in memory, which carry none; default: mm
  Conformal conformal = Conformal::automatic;
  Overlaps overlaps = Overlaps::refuse;  ///< with Conformal::off, solids may overlap, and nothing is split
  /// Edges shorter and faces narrower than this are suppressed where that leaves a sound body, and reported; 0: none
  /// are. At most a tenth of the body's diagonal.
  double min_feature = 0;
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

  /// Folder for what a failed run leaves to look at and to repeat (docs/dossier.md); empty: none. Made if missing, and
  /// only if a run fails otherwise than by being cancelled. What cannot be written there is a warning.
  std::string dossier;
};

}  // namespace curvetet
