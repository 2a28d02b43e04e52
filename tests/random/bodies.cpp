#include <BOPAlgo_ArgumentAnalyzer.hxx>
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
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Builder.hxx>
#include <GProp_GProps.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <gp_Pln.hxx>
#include <numbers>

#include "random/shapes.h"

namespace curvetet::test {

namespace {

bool has_volume(const TopoDS_Shape& shape) {
  if (shape.IsNull() || !TopExp_Explorer(shape, TopAbs_SOLID).More() || !BRepCheck_Analyzer(shape).IsValid())
    return false;
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass() > 1e-3;
}

/// The changed shape where the change succeeds and leaves a solid, else the shape as it was.
template <typename Change>
TopoDS_Shape try_change(const TopoDS_Shape& shape, Change change) {
  try {
    const TopoDS_Shape changed = change();
    return has_volume(changed) ? changed : shape;
  } catch (const Standard_Failure&) {
    return shape;
  }
}

TopoDS_Shape draw_from(const std::vector<ShapeKind>& kinds, Draw& draw) {
  return kinds[draw.below(kinds.size())].draw(draw);
}

TopoDS_Shape primitive(Draw& draw) { return draw_from(primitive_kinds(), draw); }

TopoDS_Shape join(Draw& draw, const TopoDS_Shape& shape, const TopoDS_Shape& tool) {
  const std::size_t how = draw.below(5);
  return try_change(shape, [&]() -> TopoDS_Shape {
    if (how < 2) return BRepAlgoAPI_Fuse(shape, tool).Shape();
    if (how < 4) return BRepAlgoAPI_Cut(shape, tool).Shape();
    return BRepAlgoAPI_Common(shape, tool).Shape();
  });
}

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

/// Up to six primitives joined, then dressed.
TopoDS_Shape combination(Draw& draw) {
  TopoDS_Shape shape = primitive(draw);
  for (std::size_t count = 1 + draw.below(5); count > 0; --count) shape = join(draw, shape, primitive(draw));
  for (std::size_t count = draw.below(3); count > 0; --count) shape = dress(draw, shape);
  return shape;
}

TopoDS_Shape dressed(Draw& draw) {
  TopoDS_Shape shape = primitive(draw);
  for (std::size_t count = 1 + draw.below(3); count > 0; --count) shape = dress(draw, shape);
  return shape;
}

/// A plate with bores, countersunk or not, some of which cut its rim or each other, and perhaps a boss.
TopoDS_Shape plate(Draw& draw) {
  const double length = draw.length(2, 4), width = draw.length(1, 3), height = draw.between(0.05, 0.5);
  const gp_Dir up(0, 0, 1);
  TopoDS_Shape shape = BRepPrimAPI_MakeBox(length, width, height).Shape();
  for (std::size_t count = 1 + draw.below(8); count > 0; --count) {
    const double radius = draw.between(0.03, 0.3), x = draw.between(0, length), y = draw.between(0, width);
    const TopoDS_Shape bore =
        draw.below(3) > 0 ? BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, y, -1), up), radius, 3).Shape()
                          : BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(x, y, 0), up), radius, 2 * radius, height).Shape();
    shape = try_change(shape, [&]() -> TopoDS_Shape { return BRepAlgoAPI_Cut(shape, bore).Shape(); });
  }
  if (draw.coin()) return shape;
  const double radius = draw.between(0.1, 0.4);
  const gp_Ax2 middle(gp_Pnt(length / 2, width / 2, 0), up);
  const TopoDS_Shape boss = BRepPrimAPI_MakeCylinder(middle, radius, draw.between(0.6, 2)).Shape();
  return try_change(shape, [&]() -> TopoDS_Shape { return BRepAlgoAPI_Fuse(shape, boss).Shape(); });
}

/// A cone from a needle to nearly flat, a whole or a part of it, cut by a primitive.
TopoDS_Shape tip(Draw& draw) {
  const double height = draw.between(0.3, 3), angle = draw.between(0.01, 1.45);
  const double turn = draw.coin() ? 2 * std::numbers::pi : draw.between(0.5, 6);
  TopoDS_Shape shape = BRepPrimAPI_MakeCone(gp_Ax2(), height * std::tan(angle), 0, height, turn).Shape();
  if (draw.coin()) shape = join(draw, shape, primitive(draw));
  return draw.coin() ? dress(draw, shape) : shape;
}

TopoDS_Compound together(const std::vector<TopoDS_Shape>& shapes) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes) builder.Add(compound, shape);
  return compound;
}

/// Blocks and cylinders on one another.
TopoDS_Shape stack(Draw& draw) {
  std::vector<TopoDS_Shape> shapes;
  double z = 0;
  for (std::size_t count = 2 + draw.below(4); count > 0; --count) {
    const double height = draw.length(0.1, 0.6), off = draw.coin() ? 0 : draw.between(-0.1, 0.1);
    const gp_Ax2 axes(gp_Pnt(off, 0, z), gp_Dir(0, 0, 1));
    const double size = draw.length(0.3, 1);
    if (draw.coin()) {
      shapes.push_back(BRepPrimAPI_MakeCylinder(axes, size, height).Shape());
    } else {
      shapes.push_back(BRepPrimAPI_MakeBox(axes, size, draw.length(0.3, 1), height).Shape());
    }
    z += height;
  }
  return together(shapes);
}

/// A primitive in the place that it has taken from another.
TopoDS_Shape inlay(Draw& draw) {
  const TopoDS_Shape around = primitive(draw), core = primitive(draw);
  const TopoDS_Shape rest = BRepAlgoAPI_Cut(around, core).Shape();
  return has_volume(rest) ? TopoDS_Shape(together({rest, core})) : core;
}

bool crosses_itself(const TopoDS_Shape& shape) {
  BOPAlgo_ArgumentAnalyzer analyzer;
  analyzer.SetShape1(shape);
  analyzer.SelfInterMode() = true;
  analyzer.ArgumentTypeMode() = false;
  analyzer.SmallEdgeMode() = false;
  analyzer.RebuildFaceMode() = false;
  analyzer.Perform();
  return analyzer.HasFaulty();
}

}  // namespace

const std::vector<ShapeKind>& body_kinds() {
  static const std::vector<ShapeKind> kinds{{"combination", combination},
                                            {"combined", combination},
                                            {"joined", combination},
                                            {"dressed", dressed},
                                            {"plate", plate},
                                            {"tip", tip},
                                            {"stack", stack},
                                            {"inlay", inlay}};
  return kinds;
}

bool is_sound(const TopoDS_Shape& shape) {
  if (!has_volume(shape)) return false;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
    if (crosses_itself(solid.Current())) return false;
  return true;
}

}  // namespace curvetet::test
