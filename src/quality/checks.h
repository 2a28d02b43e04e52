// Inside the room: what the checks of validate() share. Not for other rooms.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "base/box_tree.h"
#include "base/context.h"
#include "curvetet/mesh.h"
#include "geometry/model.h"
#include "quality/validate.h"

namespace curvetet::checks {

/// The region outside of all solids.
inline constexpr std::uint32_t kOutside = std::numeric_limits<std::uint32_t>::max();

/// Offenders that a finding names.
inline constexpr std::size_t kExamples = 5;

inline Vec3 vec(const Point& p) { return {p[0], p[1], p[2]}; }
std::string place(Vec3 p);  ///< "(1, 2, 3)"

/// Gathers findings in the order of their first occurrence; keeps five examples of each kind.
class Findings {
 public:
  /// Counts one offender; the example is made only if it will be kept.
  void add(const char* check, Severity severity, const std::function<std::string()>& example);
  std::vector<Finding> take() { return std::move(findings_); }
  bool any(const char* check) const;
  bool any_error() const;

 private:
  std::vector<Finding> findings_;
};

/// A facet of a tet, filed under its smallest vertex.
struct FacetUse {
  std::uint32_t middle = 0, largest = 0;  ///< the other two vertices
  std::uint32_t tet = 0;
  bool above =
      false;  ///< the tet lies on the side the normal of (smallest, middle, largest) points to; by its corners' order
  std::uint64_t key() const { return std::uint64_t{middle} << 32U | largest; }  ///< of the facet under its vertex
};

/// A facet between two different regions. Vertices ascend; `above` is the region on the side of their normal.
struct BoundaryFacet {
  std::array<std::uint32_t, 3> vertices{};
  std::uint32_t above = kOutside, below = kOutside;
  std::uint32_t tet = 0;              ///< one that has it
  std::uint32_t triangle = kOutside;  ///< the labelled triangle on it; kOutside if none
};

/// An edge of more than two boundary facets of one solid.
struct CrowdedEdge {
  std::uint32_t a = 0, b = 0;  ///< ascending
  std::uint32_t solid = 0;
  std::size_t facets = 0;
};
std::string describe(const Mesh& mesh, const CrowdedEdge& edge);

/// What the first checks find out and the later ones use. Only made for meshes whose arrays and indices are sound.
struct Topology {
  std::vector<std::int8_t> tet_sign;             ///< exact
  std::vector<std::uint32_t> facet_begin;        ///< by smallest vertex, into facet_uses; one longer than the points
  std::vector<FacetUse> facet_uses;              ///< sorted under each smallest vertex
  std::vector<BoundaryFacet> boundary;           ///< sorted by vertices
  std::vector<std::uint8_t> used;                ///< by point: in a tet
  std::uint32_t tet_components = 0;              ///< joined through facets
  std::vector<std::uint32_t> region_components;  ///< by solid: pieces joined through facets between tets of the solid
  std::vector<CrowdedEdge> crowded_edges;
  std::vector<std::uint32_t> outer_sheet;  ///< by boundary facet beside the outside: the same for those that are joined
                                           ///< by edges of two of these
  std::vector<int> euler;                  ///< by solid: V - E + F of its boundary
};

/// The uses of the facet with these ascending vertices.
std::span<const FacetUse> uses_of(const Topology& topology, const std::array<std::uint32_t, 3>& ascending);

/// Arrays of matching lengths, indices in range, finite coordinates. False: nothing else can be checked.
bool check_arrays(const Mesh& mesh, Findings& findings);
void check_nodes(const Mesh& mesh, const Topology& topology, Findings& findings);
/// Signs of tets, facets and their sides, pieces; fills the topology up to `boundary`.
Topology check_tets(const Mesh& mesh, Context& context, Findings& findings);
/// Labelled triangles against boundary facets: each once, the same sides for all triangles of a face.
void check_triangles(const Mesh& mesh, Topology& topology, Findings& findings);
/// Boundary of each solid closed; crowded edges, sheets and Euler characteristics are recorded.
void check_closedness(const Mesh& mesh, const Model* model, Topology& topology, Findings& findings);

BoxTree tree_of_boundary(const Mesh& mesh, const Topology& topology);

/// Boundary facets meet only in shared vertices and edges (exact).
void check_self_intersection(const Mesh& mesh, const Topology& topology, const BoxTree& tree, Context& context,
                             Findings& findings);
/// No vertex lies in or on a tet it does not belong to (exact). Where no error was found before, a proof is tried
/// first.
void check_overlap(const Mesh& mesh, const Topology& topology, const BoxTree& tree, Context& context,
                   Findings& findings);
/// True if it is proved that no place off the facets is in two tets, for a mesh of positive tets whose facets have one
/// tet, or two on opposite sides, and whose boundary facets do not meet. O(n log n) in the boundary facets.
bool is_covered_once(const Mesh& mesh, const Topology& topology, const BoxTree& tree);

/// Everything that needs the CAD: labels, vertices on their entities, folds, chains, coverage, volumes, Euler
/// characteristics.
void check_against_model(const Mesh& mesh, const Model& model, double unit_scale, const Topology& topology,
                         const std::vector<double>& volumes, Context& context, Findings& findings);

/// Volume of each solid entity, in the mesh's unit.
std::vector<double> solid_volumes(const Mesh& mesh);
QualitySummary summarize_quality(const Mesh& mesh, Context& context);
/// Tells which of the tets below five degrees the body itself forces; fills that part of the summary. Without a model
/// the mesh's own angles are taken for the body's.
void find_forced_angles(const Mesh& mesh, const Model* model, double unit_scale, QualitySummary& summary);

}  // namespace curvetet::checks
