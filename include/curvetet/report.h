// What a run did: the certificate of each face, counts, times, reductions of size, quality.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "curvetet/error.h"
#include "curvetet/mesh.h"

namespace curvetet {

struct StageTime {
  std::string stage;
  double seconds = 0;
  std::size_t bytes = 0;  ///< of memory that the process had when the stage ended; 0: the system does not tell
};

/// A rung of the ladder for what the march leaves: the facets it was tried on, again in each round that it was, and
/// those it recovered.
struct RungCounts {
  std::size_t tried = 0, recovered = 0;
};

/// The rungs in their order. The outer loop's are of restarts, not of facets: those that a face was named for, and
/// those after which it was not named again.
struct LadderCounts {
  RungCounts reconnect;      ///< by flips and filling, without points
  RungCounts refine;         ///< by points on the surface; recovered: how many fewer the next march missed
  RungCounts volume_points;  ///< by filling with points in the volume
  RungCounts outer_loop;     ///< by a smaller size
  RungCounts fallback;       ///< facet by facet, as a last resort
};

/// Certificate of one CAD face.
struct FaceReport {
  std::uint32_t cad_id = 0;
  std::string name, kind;
  std::size_t triangles_parametric = 0;  ///< in t_3d when T_Γ took its place
  std::size_t triangles = 0;             ///< in T_Γ: the locked facets of the finished mesh
  std::size_t coincide = 0;              ///< of T_Γ that t_3d had too; the march found the others
  double area = 0;                       ///< of T_Γ
  double triangles_asked = 0;            ///< equilateral ones of the size asked that have that area
  std::size_t initial_points = 0, points_edge_recovery = 0, points_stage_one = 0, points_stage_two = 0;
  std::uint64_t hash_locked = 0, hash_final = 0;
  std::size_t relocks = 0, unlocks = 0, flips_without_points = 0;
  bool fallback = false;
  LadderCounts ladder;
};

struct SolidReport {
  std::uint32_t cad_id = 0;
  std::string name;
  std::size_t tets = 0;
  double volume = 0, cad_volume = 0;
};

/// A detail that was left out of the body before meshing (Options::min_feature).
struct SuppressedReport {
  std::string kind;  ///< "edge", whose ends are one vertex now, or "face", whose neighbours meet in its place
  std::uint32_t cad_id = 0;
  std::string name;  ///< the CAD's; empty if it has none
  double size = 0;   ///< length of the edge, width of the face
  Point where{};
};

/// Where the size had to be smaller than asked. Reason "shape": the outline and bending of the face needed it.
struct ReductionReport {
  std::uint32_t face = 0, other = 0;  ///< cad ids; other is 0 where there is none
  std::string reason;
  double size = 0, gap = 0;
  Point where{};
};

/// A small dihedral angle that the body itself forces on every mesh of it with elements of this size: two faces that
/// meet in a thin wedge along an edge, two edges of a face that meet in one at a vertex, or one face that is narrow
/// between two edges (or vertices).
struct ForcedAngleReport {
  std::vector<std::uint32_t> faces, edges;  ///< cad ids
  std::uint32_t vertex = 0;                 ///< cad id of the corner; 0 for a wedge and a narrow face
  double angle = 0;                         ///< degrees
  std::size_t tets = 0;                     ///< below five degrees because of it
  Point where{};
};

/// Counts of recovery as a whole, of the last round of the outer loop, also where that failed; those of the paper's
/// remeshing cases are of `--recovery paper` only.
struct RecoveryCounts {
  std::size_t crossings = 0;  ///< pairs of triangles of the first t_3d that crossed
  std::size_t edge_flips = 0, edge_splits = 0, edges_filled = 0;
  std::size_t volume_points = 0;  ///< put into the volume to fill a hole that no reconnection closed
  int rounds = 0;
  std::size_t stage_one_points = 0, stage_one_allowed = 0, stage_two_points = 0;
  std::size_t case1 = 0, case2 = 0, case3a = 0, case3b = 0, case4 = 0, fallback_faces = 0;
  LadderCounts ladder;  ///< of all faces together
};

struct Report {
  int schema = 2;
  std::string version, input, input_hash;
  std::string unit;       ///< of the output
  std::string file_unit;  ///< of the lengths in the file; empty if it does not say
  std::string mode;
  std::vector<std::string> healing;
  std::vector<SuppressedReport> suppressed;  ///< edges before faces, ascending ids
  std::string options_json;
  std::vector<StageTime> stages;
  std::size_t peak_bytes = 0;  ///< the most memory the process has had so far; 0: the system does not tell
  std::size_t points = 0, tets = 0, triangles = 0, segments = 0;
  std::size_t initial_surface_points = 0;
  int rounds = 0;  ///< of the outer loop; 0: none was needed
  RecoveryCounts recovery;
  std::vector<ReductionReport> reductions;
  std::vector<FaceReport> faces;
  std::vector<SolidReport> solids;
  std::size_t unmet_tets = 0;
  double worst_dihedral = 0;
  Point worst_place{};
  std::size_t tets_below_half_degree = 0, tets_below_five_degrees = 0;  ///< all, forced or not
  std::size_t forced_below_half_degree = 0, forced_below_five_degrees = 0;
  std::vector<ForcedAngleReport> forced_angles;
  double mean_radius_ratio = 0;
  std::vector<std::size_t> radius_ratio_histogram, dihedral_histogram;
  std::vector<std::string> warnings;
  std::uint64_t mesh_hash = 0;
  bool valid = false;
  std::vector<Error> errors;  ///< empty when a valid mesh was made

  std::string to_json() const;  ///< indented, keys in a fixed order
};

}  // namespace curvetet
