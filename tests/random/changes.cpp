#include "random/changes.h"

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepCheck_Analyzer.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepGProp.hxx>
#include <BRepOffsetAPI_DraftAngle.hxx>
#include <BRepOffsetAPI_MakeThickSolid.hxx>
#include <GProp_GProps.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <gp_Pln.hxx>

namespace curvetet::test {

namespace {

TopTools_IndexedMapOfShape parts(const TopoDS_Shape& shape, TopAbs_ShapeEnum kind) {
  TopTools_IndexedMapOfShape all;
  TopExp::MapShapes(shape, kind, all);
  return all;
}

const TopoDS_Shape& any_of(Draw& draw, const TopTools_IndexedMapOfShape& all) {
  return all(1 + static_cast<int>(draw.below(static_cast<std::size_t>(all.Extent()))));
}

/// Fillets or chamfers along some edges.
template <typename Maker>
TopoDS_Shape along_edges(Draw& draw, const TopoDS_Shape& shape) {
  const double width = draw.coin() ? draw.between(0.01, 0.05) : draw.between(0.03, 0.15);
  const TopTools_IndexedMapOfShape edges = parts(shape, TopAbs_EDGE);
  std::vector<TopoDS_Edge> chosen;
  for (std::size_t i = 1 + draw.below(6); i > 0; --i) chosen.push_back(TopoDS::Edge(any_of(draw, edges)));
  return try_change(shape, [&]() -> TopoDS_Shape {
    Maker maker(shape);
    for (const TopoDS_Edge& edge : chosen) maker.Add(width, edge);
    maker.Build();
    return maker.IsDone() ? maker.Shape() : TopoDS_Shape();
  });
}

TopoDS_Shape hollow(Draw& draw, const TopoDS_Shape& shape) {
  TopTools_ListOfShape open;
  open.Append(any_of(draw, parts(shape, TopAbs_FACE)));
  const double wall = draw.between(0.01, 0.1);
  return try_change(shape, [&]() -> TopoDS_Shape {
    BRepOffsetAPI_MakeThickSolid maker;
    maker.MakeThickSolidByJoin(shape, open, -wall, 1e-4);
    return maker.IsDone() ? maker.Shape() : TopoDS_Shape();
  });
}

TopoDS_Shape draft(Draw& draw, const TopoDS_Shape& shape) {
  const TopTools_IndexedMapOfShape faces = parts(shape, TopAbs_FACE);
  const TopoDS_Face face = TopoDS::Face(any_of(draw, faces));
  const double angle = draw.between(0.02, 0.2);
  const gp_Ax2 axes = draw.axes();
  return try_change(shape, [&]() -> TopoDS_Shape {
    BRepOffsetAPI_DraftAngle maker(shape);
    maker.Add(face, axes.Direction(), angle, gp_Pln(axes.Location(), axes.Direction()));
    if (!maker.AddDone()) return {};
    maker.Build();
    return maker.IsDone() ? maker.Shape() : TopoDS_Shape();
  });
}

TopoDS_Shape mirrored(const TopoDS_Shape& shape) {
  gp_Trsf mirror;
  mirror.SetMirror(gp_Ax2(gp_Pnt(0.3, 0.2, 0.1), gp_Dir(1, 2, 3)));
  return try_change(shape, [&]() -> TopoDS_Shape { return BRepBuilderAPI_Transform(shape, mirror, true).Shape(); });
}

}  // namespace

bool has_volume(const TopoDS_Shape& shape) {
  if (shape.IsNull() || !TopExp_Explorer(shape, TopAbs_SOLID).More() || !BRepCheck_Analyzer(shape).IsValid())
    return false;
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass() > 1e-3;
}

TopoDS_Shape primitive(Draw& draw) { return primitive_kinds()[draw.below(primitive_kinds().size())].draw(draw); }

TopoDS_Shape fuse(const TopoDS_Shape& shape, const TopoDS_Shape& tool) {
  return try_change(shape, [&]() -> TopoDS_Shape { return BRepAlgoAPI_Fuse(shape, tool).Shape(); });
}

TopoDS_Shape cut(const TopoDS_Shape& shape, const TopoDS_Shape& tool) {
  return try_change(shape, [&]() -> TopoDS_Shape { return BRepAlgoAPI_Cut(shape, tool).Shape(); });
}

TopoDS_Shape join(Draw& draw, const TopoDS_Shape& shape, const TopoDS_Shape& tool) {
  const std::size_t how = draw.below(5);
  if (how < 2) return fuse(shape, tool);
  if (how < 4) return cut(shape, tool);
  return try_change(shape, [&]() -> TopoDS_Shape { return BRepAlgoAPI_Common(shape, tool).Shape(); });
}

TopoDS_Shape dress(Draw& draw, const TopoDS_Shape& shape) {
  switch (draw.below(8)) {
    case 0:
    case 1:
      return along_edges<BRepFilletAPI_MakeFillet>(draw, shape);
    case 2:
      return along_edges<BRepFilletAPI_MakeChamfer>(draw, shape);
    case 3:
      return hollow(draw, shape);
    case 4:
      return draft(draw, shape);
    case 5:
      return mirrored(shape);
    case 6:
      return try_change(shape, [&]() -> TopoDS_Shape { return BRepBuilderAPI_NurbsConvert(shape).Shape(); });
    default:
      return shape;
  }
}

}  // namespace curvetet::test
