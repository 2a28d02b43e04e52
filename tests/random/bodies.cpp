#include <BOPAlgo_ArgumentAnalyzer.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <TopExp_Explorer.hxx>
#include <numbers>

#include "random/changes.h"
#include "random/hard_bodies.h"
#include "support/occt_shapes.h"

namespace curvetet::test {

namespace {

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
    shape = cut(shape, bore);
  }
  if (draw.coin()) return shape;
  const double radius = draw.between(0.1, 0.4);
  const gp_Ax2 middle(gp_Pnt(length / 2, width / 2, 0), up);
  const TopoDS_Shape boss = BRepPrimAPI_MakeCylinder(middle, radius, draw.between(0.6, 2)).Shape();
  return fuse(shape, boss);
}

/// A cone from a needle to nearly flat, a whole or a part of it, cut by a primitive.
TopoDS_Shape tip(Draw& draw) {
  const double height = draw.between(0.3, 3), angle = draw.between(0.01, 1.45);
  const double turn = draw.coin() ? 2 * std::numbers::pi : draw.between(0.5, 6);
  TopoDS_Shape shape = BRepPrimAPI_MakeCone(gp_Ax2(), height * std::tan(angle), 0, height, turn).Shape();
  if (draw.coin()) shape = join(draw, shape, primitive(draw));
  return draw.coin() ? dress(draw, shape) : shape;
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
  return compound_of(shapes);
}

/// A primitive in the place that it has taken from another.
TopoDS_Shape inlay(Draw& draw) {
  const TopoDS_Shape around = primitive(draw), core = primitive(draw);
  const TopoDS_Shape rest = BRepAlgoAPI_Cut(around, core).Shape();
  return has_volume(rest) ? TopoDS_Shape(compound_of({rest, core})) : core;
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

// One that is listed more than once is drawn more often.
const std::vector<ShapeKind>& body_kinds() {
  static const std::vector<ShapeKind> kinds{{"combination", combination},
                                            {"combination", combination},
                                            {"combination", combination},
                                            {"dressed", dressed},
                                            {"plate", plate},
                                            {"tip", tip},
                                            {"stack", stack},
                                            {"inlay", inlay},
                                            {"near", near_faces},
                                            {"slit", slits},
                                            {"knife", knife},
                                            {"tangent", tangent},
                                            {"many", many_features},
                                            {"coil", coil}};
  return kinds;
}

bool is_sound(const TopoDS_Shape& shape) {
  if (!has_volume(shape)) return false;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next())
    if (crosses_itself(solid.Current())) return false;
  return true;
}

}  // namespace curvetet::test
