// The independent check of a finished mesh: what `curvetet check MESH [CAD]` runs. Shares no code with the kernel that
// made the mesh, not even its predicates (quality/exact.h).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/context.h"
#include "curvetet/mesh.h"
#include "geometry/model.h"

namespace curvetet {

enum class Severity { error, warning };

/// One kind of defect: how often, and the first few offenders.
struct Finding {
  std::string check;  ///< stable lower-case name, e.g. "negative_tet"
  Severity severity = Severity::error;
  std::size_t count = 0;
  std::vector<std::string> examples;  ///< at most five: id, place, note
};

struct Histogram {
  double smallest = 0, largest = 0, mean = 0;
  std::vector<std::size_t> bins;  ///< equal width over [0, 1] or [0, 180]
};

/// A small dihedral angle that every mesh of the body with elements of this size must have: faces that meet in a thin
/// wedge along an edge, two edges of a face that meet in one at a vertex, or a face as narrow, over the size of the
/// tet, as the angle is small. Fields are entities of the mesh, ascending.
struct ForcedAngle {
  std::vector<std::uint32_t> faces;     ///< the two of the wedge, the one with the corner, or the narrow one
  std::vector<std::uint32_t> edges;     ///< the one of the wedge, the two that meet, or those on both sides
  std::optional<std::uint32_t> vertex;  ///< of the corner
  double angle = 0;                     ///< the smallest met, degrees
  Point place{};                        ///< where that is
  std::size_t tets = 0;                 ///< below five degrees because of it
};

struct QualitySummary {
  Histogram radius_ratio;                                     ///< 3 r / R in [0,1]
  Histogram dihedral;                                         ///< smallest angle of each tet, degrees
  std::size_t below_half_degree = 0, below_five_degrees = 0;  ///< all tets, forced or not
  std::size_t forced_below_half = 0, forced_below_five = 0;
  std::vector<ForcedAngle> forced;
  Point worst_place{};
  double worst_dihedral = 0;
};

struct ValidationReport {
  std::vector<Finding> findings;
  QualitySummary quality;
  std::vector<double> solid_volumes;  ///< by solid entity
  bool valid() const;                 ///< no finding of severity error
};

/// Checks the mesh alone, and against the model if given: exact positivity, conformity (each facet in one or two tets,
/// on opposite sides), closed boundary equal to the labelled triangles, no boundary self-intersection, folds against
/// CAD normals, vertices on their CAD entity, every CAD edge a chain of mesh edges, volumes within what chord heights
/// explain, quality. The mesh's coordinates are in the CAD's unit times `unit_scale`.
ValidationReport validate(const Mesh& mesh, const Model* model, double unit_scale, Context& context);

}  // namespace curvetet
