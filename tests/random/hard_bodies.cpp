#include "random/hard_bodies.h"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepLib.hxx>
#include <BRepOffsetAPI_MakePipe.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <gp_Circ.hxx>
#include <numbers>

#include "random/changes.h"

namespace curvetet::test {

namespace {

/// 10^-low to 10^-high.
double tiny(Draw& draw, double low, double high) { return std::pow(10, -draw.between(low, high)); }

TopoDS_Shape box(const gp_Pnt& corner, double x, double y, double z) {
  return BRepPrimAPI_MakeBox(corner, x, y, z).Shape();
}

TopoDS_Shape scaled(const TopoDS_Shape& shape, double factor, const gp_Vec& to) {
  gp_Trsf scale, move;
  scale.SetScale(gp_Pnt(0, 0, 0), factor);
  move.SetTranslation(to);
  return BRepBuilderAPI_Transform(shape, move * scale, true).Shape();
}

}  // namespace

TopoDS_Shape near_faces(Draw& draw) {
  TopoDS_Shape shape = box({0, 0, 0}, 1, 1, 1);
  for (std::size_t count = 1 + draw.below(3); count > 0; --count) {
    const double step = (draw.coin() ? 1 : -1) * tiny(draw, 1, 6), over = tiny(draw, 1, 6);
    const double width = draw.between(0.2, 1), length = draw.between(0.2, 1);
    switch (draw.below(3)) {
      case 0:  // a block on the top, flush with two sides but for the step
        shape = fuse(shape, box({step, over, 1}, width, length, 0.5));
        break;
      case 1:  // a pocket that leaves a thin floor
        shape = cut(shape, box({0.2, 0.2, over}, 0.6 * width, 0.6 * length, 2));
        break;
      default:  // a bore beside a wall
        shape =
            cut(shape, BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.5, 0.2 + over, -1), gp_Dir(0, 0, 1)), 0.2, 3).Shape());
    }
  }
  return draw.coin() ? dress(draw, shape) : shape;
}

TopoDS_Shape slits(Draw& draw) {
  TopoDS_Shape shape = primitive(draw);
  for (std::size_t count = 1 + draw.below(4); count > 0; --count) {
    const gp_Ax2 axes = draw.axes();
    const double width = tiny(draw, 1, 4), x = draw.between(0.3, 3), y = draw.between(0.3, 3);
    shape = cut(shape, BRepPrimAPI_MakeBox(axes, x, y, width).Shape());
  }
  return shape;
}

TopoDS_Shape knife(Draw& draw) {
  const double angle = tiny(draw, 0.3, 2.5), length = draw.between(0.5, 2);
  BRepBuilderAPI_MakePolygon section;
  section.Add(gp_Pnt(0, 0, 0));
  section.Add(gp_Pnt(length, 0, 0));
  section.Add(gp_Pnt(length, 0, length * std::tan(angle)));
  section.Close();
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(section.Wire()).Face();
  const TopoDS_Shape blade = BRepPrimAPI_MakePrism(face, gp_Vec(0, draw.between(0.3, 2), 0)).Shape();
  const TopoDS_Shape other = primitive(draw);
  const std::size_t how = draw.below(3);
  return how == 0 ? join(draw, blade, other) : how == 1 ? cut(other, blade) : blade;
}

TopoDS_Shape tangent(Draw& draw) {
  TopoDS_Shape shape = box({0, 0, 0}, 2, 1.5, 1);
  for (std::size_t count = 1 + draw.below(3); count > 0; --count) {
    const double radius = draw.between(0.1, 0.45), off = draw.coin() ? 0 : (draw.coin() ? 1 : -1) * tiny(draw, 2, 6);
    const double along = draw.between(0.5, 1.5);
    TopoDS_Shape round;
    switch (draw.below(3)) {
      case 0:  // touches the side y = 0 from within or without
        round = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(along, radius + off, -0.5), gp_Dir(0, 0, 1)), radius, 2).Shape();
        break;
      case 1:  // lies on the top
        round =
            BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.2, along, 1 + radius + off), gp_Dir(1, 0, 0)), radius, 1).Shape();
        break;
      default:
        round = BRepPrimAPI_MakeSphere(gp_Pnt(along, 0.7, 1 - radius + off), radius).Shape();
    }
    shape = draw.coin() ? fuse(shape, round) : cut(shape, round);
  }
  return shape;
}

TopoDS_Shape many_features(Draw& draw) {
  TopoDS_Shape shape = box({-1, -1, -0.5}, 2, 2, 1);
  for (std::size_t count = 5 + draw.below(16); count > 0; --count) {
    const TopoDS_Shape feature = primitive(draw);
    const double factor = draw.between(0.05, 0.4), x = draw.between(-1, 1), y = draw.between(-1, 1);
    shape = join(draw, shape, scaled(feature, factor, {x, y, draw.coin() ? 0.5 : -0.5}));
  }
  return draw.coin() ? dress(draw, shape) : shape;
}

TopoDS_Shape coil(Draw& draw) {
  const double radius = draw.between(0.3, 1), pitch = draw.between(0.2, 0.5), turns = draw.between(0.5, 3);
  const double wire = pitch * draw.between(0.05, 0.45);
  const Handle(Geom_CylindricalSurface) around = new Geom_CylindricalSurface(gp_Ax3(), radius);
  const double full = 2 * std::numbers::pi;
  const Handle(Geom2d_Line) line = new Geom2d_Line(gp_Pnt2d(0, 0), gp_Dir2d(full, pitch));
  const TopoDS_Edge helix = BRepBuilderAPI_MakeEdge(line, around, 0, turns * std::hypot(full, pitch)).Edge();
  BRepLib::BuildCurves3d(helix);
  const gp_Ax2 start(gp_Pnt(radius, 0, 0), gp_Dir(0, full * radius, pitch));
  const TopoDS_Wire outline = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(start, wire)).Edge()).Wire();
  const TopoDS_Wire spine = BRepBuilderAPI_MakeWire(helix).Wire();
  const TopoDS_Shape shape = BRepOffsetAPI_MakePipe(spine, BRepBuilderAPI_MakeFace(outline).Face()).Shape();
  return draw.coin() ? fuse(shape, primitive(draw)) : shape;
}

}  // namespace curvetet::test
