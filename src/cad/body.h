// What reading and healing hand on: a shape and a label for each of its parts. Inside cad only.
#pragma once

#include <TopAbs_ShapeEnum.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS_Shape.hxx>
#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "geometry/model.h"

namespace curvetet {

/// The kernel's own integrals, costly: found once and kept with the shape. Not a number where not found yet.
struct CadMeasures {
  std::vector<double> face_areas;     ///< in the order of the faces' labels
  std::vector<double> shell_volumes;  ///< signed, shell by shell as TopExp_Explorer finds them in solid after solid
};

/// A shape with labels. The labels of a type are as many as, and in the order of, TopExp::MapShapes on the shape.
struct CadBody {
  TopoDS_Shape shape;
  std::vector<Label> solids, faces, edges, vertices;
  std::vector<std::string> solid_paths;  ///< assembly path per solid
  /// The largest ids so far, those of parts that went included; where there is none, nothing went yet.
  std::map<TopAbs_ShapeEnum, std::uint32_t> last_ids;
  std::vector<char> shared_product;  ///< per solid: its product has other solids too (known while reading only)
  std::string unit = "mm";
  std::string file_unit;  ///< what the file says its lengths are in; empty if it does not
  std::vector<HealingNote> notes;
  /// Edges before faces, ascending ids. The faces are gone; the edges are left to convert_body to take as points.
  std::vector<SuppressedDetail> suppressed;
  CadMeasures measures;
};

/// The four types that carry labels, in the order solids, faces, edges, vertices.
inline constexpr std::array kLabelled{TopAbs_SOLID, TopAbs_FACE, TopAbs_EDGE, TopAbs_VERTEX};
/// "solid", "face", "edge" or "vertex".
const char* type_name(TopAbs_ShapeEnum type);
std::vector<Label>& labels_of(CadBody& body, TopAbs_ShapeEnum type);
const std::vector<Label>& labels_of(const CadBody& body, TopAbs_ShapeEnum type);

/// Distinct sub-shapes of a type in the order of TopExp::MapShapes.
TopTools_IndexedMapOfShape sub_shapes(const TopoDS_Shape& shape, TopAbs_ShapeEnum type);

/// By number in the map of edges: is it suppressed? The shape has it still.
std::vector<char> suppressed_edges(const CadBody& body);

/// Brings `suppressed` into its order.
void sort_suppressed(CadBody& body);

/// Signed volume within the faces of a shape, by those of the kernel's rules that agree best.
double volume_of(const TopoDS_Shape& shape);

/// Numbers all sub-shapes 1..n, without names.
void label_all(CadBody& body);

/// Replaces the shape; `image` gives for a part of the old shape what became of it (null: removed; possibly several
/// parts in a compound). Labels follow their parts; of several parts the first keeps the id. The others keep the name
/// and colour and get the next free ids, as do parts that come from nowhere; the id of a part that went is not given
/// again.
void replace_shape(CadBody& body, const TopoDS_Shape& shape,
                   const std::function<TopoDS_Shape(const TopoDS_Shape&)>& image);

}  // namespace curvetet
