// The body as the mesher sees it: solids, faces, edges and vertices by id, with their curves and surfaces. No CAD
// kernel here.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/ids.h"
#include "base/vec.h"
#include "geometry/even_parameter.h"
#include "geometry/frame.h"
#include "geometry/surface.h"

namespace curvetet {

/// Colour of a CAD entity, components in [0,1].
struct Colour {
  double red = 0.8, green = 0.8, blue = 0.8;
};

/// What the CAD says about an entity besides its shape.
struct Label {
  std::uint32_t cad_id = 0;  ///< 1..n in the order of the input shape; what users see
  std::string name;          ///< the CAD's name; empty if it has none
  std::optional<Colour> colour;
};

struct ModelVertex {
  Label label;
  Vec3 point;            ///< working coordinates, on the grid
  double tolerance = 0;  ///< working units
};

struct ModelEdge {
  Label label;
  std::shared_ptr<const Curve> curve;  ///< null for a degenerate edge (a pole)
  double low = 0, high = 0;            ///< parameter range, low < high
  /// From the parameter of `curve` to the CAD's; null if they are the same (see even_parameter.h).
  std::shared_ptr<const ParameterSteps> steps;
  CadVertexId start, end;     ///< at low and at high; equal for a closed edge and for a degenerate one
  double tolerance = 0;       ///< working units
  bool degenerate = false;    ///< a pole: one point in space, a curve only in (u,v)
  std::vector<FaceId> faces;  ///< faces that use it, each once, ascending
  /// An edge in the same place that the body does not share (see touching_edges.h); both are cut at the same places.
  EdgeId twin;
  double twin_shift = 0, twin_scale = 1;  ///< own parameter: shift + scale * that of the twin

  double own_parameter(double t) const { return steps ? steps->own(t) : t; }
  double from_own_parameter(double t) const { return steps ? steps->even(t) : t; }
};

/// One use of an edge by a face. A seam has two uses in one face, with two parameter curves.
struct EdgeUse {
  EdgeId edge;
  bool reversed = false;  ///< the loop runs through the edge from high to low
  bool seam = false;      ///< the edge is used twice by this face and its two parameter curves lie a period apart
  bool internal =
      false;  ///< a constraint inside the face, both sides belong to it (a slit used twice counts as internal)
  std::shared_ptr<const ParameterCurve>
      curve;  ///< over [edge.low, edge.high], already on a consistent lift of the domain
};

/// A closed chain of uses: each ends where the next begins. Orientation as in the (u,v) plane: the face lies to the
/// left.
struct Loop {
  std::vector<EdgeUse> uses;
};

struct ModelFace {
  Label label;
  std::shared_ptr<const Surface> surface;
  bool reversed = false;                ///< the face's outward normal is minus du x dv
  std::vector<Loop> loops;              ///< the outer one first where it can be told
  std::vector<EdgeUse> internal_edges;  ///< constraints inside the face that close no loop
  std::vector<CadVertexId> internal_vertices;
  std::vector<Vec2> internal_vertex_uv;
  Vec2 low, high;        ///< box of the trimmed domain in (u,v)
  double tolerance = 0;  ///< working units
  /// Solids on the side the face's outward normal points to, and on the other; invalid: outside of every solid.
  SolidId front, back;
  double area = 0;  ///< the CAD's own, working units squared; 0 if unknown
};

/// The closest parameters in the box of the face's domain, where the surface is not periodic.
inline Vec2 within_box(const ModelFace& face, Vec2 uv) {
  if (!(face.surface->period_u() > 0)) uv.x = std::clamp(uv.x, face.low.x, face.high.x);
  if (!(face.surface->period_v() > 0)) uv.y = std::clamp(uv.y, face.low.y, face.high.y);
  return uv;
}

struct ModelSolid {
  Label label;
  std::string path;           ///< assembly path, "/" between levels; empty at the top
  std::vector<FaceId> faces;  ///< all faces of its shells
  double volume = 0;          ///< the CAD's own, working units cubed
};

/// One change that healing made.
struct HealingNote {
  std::string entity;       ///< "face 12"
  std::string what;         ///< "sewn", "wire reordered", ...
  bool is_warning = false;  ///< the mesh will lack something that the file has or that it should have
};

/// A detail of the input that the body lacks on request. Its size (length of an edge, width of a face) and place are
/// those of the CAD.
struct SuppressedDetail {
  enum class Kind { edge, face } kind = Kind::edge;
  Label label;
  double size = 0;
  Vec3 place;
};

inline const char* name(SuppressedDetail::Kind kind) { return kind == SuppressedDetail::Kind::edge ? "edge" : "face"; }

/// A body ready to be meshed.
struct Model {
  Frame frame;
  std::string unit = "mm";  ///< unit of the CAD coordinates that `frame` maps from
  std::string file_unit;    ///< of the lengths in the file, which reading converted to `unit`; empty: it says none
  Box3 box;                 ///< of the body, working coordinates
  IndexedVector<SolidId, ModelSolid> solids;
  IndexedVector<FaceId, ModelFace> faces;
  IndexedVector<EdgeId, ModelEdge> edges;
  IndexedVector<CadVertexId, ModelVertex> vertices;
  std::vector<HealingNote> healing;
  std::vector<SuppressedDetail> suppressed;  ///< edges before faces, ascending ids
  double diagonal() const { return box.diagonal(); }
  std::string face_name(FaceId face) const;     ///< the CAD's name, or "face_12"
  std::string edge_name(EdgeId edge) const;     ///< the CAD's name, or "edge_7"
  std::string solid_name(SolidId solid) const;  ///< the CAD's name, or "solid_1"
  /// The CAD faces that a vertex with this owner lies on (ascending).
  std::vector<FaceId> faces_at(CadVertexId vertex) const;
};

}  // namespace curvetet
