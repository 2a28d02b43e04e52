// Direct modelling, and exporters that trim a curve by the wrong parameters, leave edges whose curve stops before the
// vertex that the faces' other edges meet in. What is missing is where the faces say it is: on all of them. Raising the
// vertex's tolerance to the gap, as the CAD kernel does when it reads such a file, was rejected: a loop that jumps is
// no border to mesh.
#include "cad/complete_edges.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Curve.hxx>
#include <ShapeAnalysis_Surface.hxx>
#include <ShapeFix_Edge.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>

namespace curvetet {
namespace {

constexpr int kSamples = 8;  ///< of a straight piece

bool lies_on(const gp_Pnt& from, const gp_Pnt& to, const TopTools_ListOfShape& faces, double tolerance) {
  for (const TopoDS_Shape& face : faces) {
    ShapeAnalysis_Surface surface(BRep_Tool::Surface(TopoDS::Face(face)));
    for (int i = 0; i <= kSamples; ++i) {
      const gp_Pnt p = from.Translated(gp_Vec(from, to) * (static_cast<double>(i) / kSamples));
      surface.ValueOfUV(p, tolerance);
      if (!(surface.Gap() <= tolerance)) return false;
    }
  }
  return true;
}

/// Does a curve that leaves its end forward (1) or backward (-1) head for a point, rather than away from it? A straight
/// piece that turned back would run along the edge itself.
bool goes_on(const Geom_Curve& curve, double parameter, const gp_Pnt& to, int sense) {
  gp_Pnt end;
  gp_Vec along;
  curve.D1(parameter, end, along);
  return sense * along.Dot(gp_Vec(end, to)) > 0;
}

class EdgeCompleter {
 public:
  EdgeCompleter(double least, double tolerance) : least_(least), tolerance_(tolerance) {}

  /// The edge between the ends of its curve, and straight edges from there to its vertices, as a wire; null if it needs
  /// none or cannot have them.
  TopoDS_Shape completed(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) const {
    TopoDS_Vertex start, end;
    TopExp::Vertices(edge, start, end);
    Standard_Real low = 0, high = 0;
    const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, low, high);
    if (start.IsNull() || end.IsNull() || curve.IsNull() || BRep_Tool::Degenerated(edge)) return {};
    const gp_Pnt first = curve->Value(low), last = curve->Value(high);
    const bool before = misses(start, first), after = misses(end, last);
    if (!before && !after) return {};
    const auto can_join = [&](const TopoDS_Vertex& vertex, double parameter, int sense) {
      const gp_Pnt to = BRep_Tool::Pnt(vertex);
      return goes_on(*curve, parameter, to, sense) && lies_on(curve->Value(parameter), to, faces, tolerance_);
    };
    if ((before && !can_join(start, low, -1)) || (after && !can_join(end, high, 1))) return {};

    const TopoDS_Vertex from = before ? vertex_at(first) : start, to = after ? vertex_at(last) : end;
    TopoDS_Wire wire;
    const BRep_Builder builder;
    builder.MakeWire(wire);
    if (before) builder.Add(wire, straight(start, from, faces));
    builder.Add(wire, between(edge, from, to));
    if (after) builder.Add(wire, straight(to, end, faces));
    return wire;
  }

 private:
  bool misses(const TopoDS_Vertex& vertex, const gp_Pnt& end) const {
    return BRep_Tool::Pnt(vertex).Distance(end) > least_;
  }

  TopoDS_Vertex vertex_at(const gp_Pnt& point) const {
    TopoDS_Vertex made;
    BRep_Builder().MakeVertex(made, point, tolerance_);
    return made;
  }

  static TopoDS_Edge between(const TopoDS_Edge& edge, const TopoDS_Vertex& from, const TopoDS_Vertex& to) {
    TopoDS_Edge made = TopoDS::Edge(edge.EmptyCopied());
    const BRep_Builder builder;
    builder.Add(made, from.Oriented(TopAbs_FORWARD));
    builder.Add(made, to.Oriented(TopAbs_REVERSED));
    return made;
  }

  TopoDS_Edge straight(const TopoDS_Vertex& from, const TopoDS_Vertex& to, const TopTools_ListOfShape& faces) const {
    TopoDS_Edge made = BRepBuilderAPI_MakeEdge(from, to);
    ShapeFix_Edge fix;
    for (const TopoDS_Shape& face : faces) fix.FixAddPCurve(made, TopoDS::Face(face), Standard_False, tolerance_);
    return made;
  }

  double least_, tolerance_;
};

}  // namespace

bool complete_edges(CadBody& body, double least, double tolerance) {
  TopTools_IndexedDataMapOfShapeListOfShape faces;
  TopExp::MapShapesAndUniqueAncestors(body.shape, TopAbs_EDGE, TopAbs_FACE, faces);
  const TopTools_IndexedMapOfShape edges = sub_shapes(body.shape, TopAbs_EDGE);
  const Handle(BRepTools_ReShape) change = new BRepTools_ReShape;
  const EdgeCompleter completer(least, tolerance);
  bool any = false;
  for (int e = 1; e <= edges.Extent(); ++e) {
    const TopoDS_Edge edge = TopoDS::Edge(edges(e).Oriented(TopAbs_FORWARD));
    const TopoDS_Shape made = completer.completed(edge, faces.FindFromKey(edges(e)));
    if (made.IsNull()) continue;
    change->Replace(edge, made);
    body.notes.push_back({"edge " + std::to_string(body.edges[static_cast<std::size_t>(e - 1)].cad_id),
                          "ends short of a vertex; a straight edge joins them"});
    any = true;
  }
  if (!any) return false;
  replace_shape(body, change->Apply(body.shape), [&](const TopoDS_Shape& part) { return change->Value(part); });
  return true;
}

}  // namespace curvetet
