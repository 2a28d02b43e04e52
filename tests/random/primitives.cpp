#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepOffsetAPI_MakePipe.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepPrimAPI_MakeWedge.hxx>
#include <TopoDS_Vertex.hxx>
#include <gp_Circ.hxx>
#include <gp_Elips.hxx>
#include <gp_Pln.hxx>
#include <numbers>

#include "random/shapes.h"
#include "support/occt_shapes.h"

namespace curvetet::test {

namespace {

using Points = std::vector<gp_Pnt>;
constexpr double kTurn = 2 * std::numbers::pi;

gp_Pnt at(const gp_Ax2& axes, double x, double y, double z) {
  return axes.Location().XYZ() + x * axes.XDirection().XYZ() + y * axes.YDirection().XYZ() + z * axes.Direction().XYZ();
}

TopoDS_Wire ring(const gp_Ax2& axes, double radius) {
  return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(axes, radius))).Wire();
}

/// Around the axis, at distances between two radii.
TopoDS_Wire closed_spline(Draw& draw, const gp_Ax2& axes, std::size_t count) {
  const double first = draw.between(0, kTurn);
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const double radius = draw.between(0.35, 1),
                 angle = first + kTurn * static_cast<double>(i) / static_cast<double>(count);
    points.push_back(at(axes, radius * std::cos(angle), radius * std::sin(angle), 0));
  }
  return BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(spline_through(points, true))).Wire();
}

TopoDS_Shape box(Draw& draw) {
  const gp_Ax2 axes = draw.axes();
  const double x = draw.length(0.3, 2), y = draw.length(0.3, 2);
  return BRepPrimAPI_MakeBox(axes, x, y, draw.length(0.3, 2)).Shape();
}

TopoDS_Shape cylinder(Draw& draw) {
  const gp_Ax2 axes = draw.axes();
  const double radius = draw.length(0.1, 0.8);
  return BRepPrimAPI_MakeCylinder(axes, radius, draw.length(0.5, 3)).Shape();
}

TopoDS_Shape ball(Draw& draw) {
  const gp_Ax2 axes = draw.axes();
  return BRepPrimAPI_MakeSphere(axes, draw.length(0.3, 1)).Shape();
}

TopoDS_Shape cone(Draw& draw) {
  const gp_Ax2 axes = draw.axes();
  const double radius = draw.length(0.2, 1), top = draw.coin() ? 0 : draw.between(0.05, 0.5);
  return BRepPrimAPI_MakeCone(axes, radius, top, draw.length(0.5, 2)).Shape();
}

TopoDS_Shape torus(Draw& draw) {
  const gp_Ax2 axes = draw.axes();
  const double radius = draw.length(0.5, 1.2);
  return BRepPrimAPI_MakeTorus(axes, radius, draw.between(0.1, 0.8) * radius).Shape();
}

TopoDS_Shape wedge(Draw& draw) {
  const gp_Ax2 axes = draw.axes();
  const double x = draw.length(0.5, 2), y = draw.length(0.5, 2), z = draw.length(0.5, 2);
  return BRepPrimAPI_MakeWedge(axes, x, y, z, draw.between(0, x)).Shape();
}

TopoDS_Shape spline_prism(Draw& draw) {
  const gp_Ax2 axes = draw.axes();
  const TopoDS_Wire outline = closed_spline(draw, axes, 4 + draw.below(5));
  const gp_Vec along = draw.length(0.4, 2) * gp_Vec(axes.Direction());
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(gp_Pln(axes), outline).Face(), along).Shape();
}

/// Ellipses and splines over one another, ruled or smooth, sometimes up to a point.
TopoDS_Shape loft(Draw& draw) {
  const gp_Ax2 axes = draw.axes();
  BRepOffsetAPI_ThruSections sections(true, draw.coin());
  const std::size_t count = 2 + draw.below(4);
  const bool pointed = draw.below(4) == 0, wild = draw.below(4) == 0;
  for (std::size_t i = 0; i < count; ++i) {
    gp_Ax2 here = axes;
    here.SetLocation(at(axes, 0, 0, 0.6 * static_cast<double>(i)));
    const double radius = draw.between(0.2, 0.9);
    const double other = radius * draw.between(0.5, 1);
    if (wild) {
      sections.AddWire(closed_spline(draw, here, 5));
    } else {
      sections.AddWire(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Elips(here, radius, other))).Wire());
    }
  }
  if (pointed) sections.AddVertex(BRepBuilderAPI_MakeVertex(at(axes, 0, 0, 0.6 * static_cast<double>(count))).Vertex());
  sections.Build();
  return sections.Shape();
}

TopoDS_Shape pipe(Draw& draw) {
  Points points;
  for (int i = 0; i < 4; ++i) {
    const double y = draw.between(-0.6, 0.6);
    points.emplace_back(-1.5 + i, y, draw.between(-0.6, 0.6));
  }
  const Handle(Geom_BSplineCurve) path = spline_through(points, false);
  gp_Pnt start;
  gp_Vec along;
  path->D1(path->FirstParameter(), start, along);
  const TopoDS_Wire spine = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(path)).Wire();
  const TopoDS_Wire outline = ring(gp_Ax2(start, gp_Dir(along)), draw.between(0.08, 0.3));
  return BRepOffsetAPI_MakePipe(spine, BRepBuilderAPI_MakeFace(outline).Face()).Shape();
}

/// A profile that is a spline, turned by all or a part of a turn; its ends are on the axis or beside it.
TopoDS_Shape revolution(Draw& draw) {
  const gp_Ax2 axes = draw.axes();
  const std::size_t count = 4 + draw.below(4);
  const bool to_axis = draw.coin();
  Points points;
  for (std::size_t i = 0; i < count; ++i) {
    const bool end = i == 0 || i + 1 == count;
    const double radius = draw.between(0.2, 1);
    points.push_back(
        at(axes, to_axis && end ? 0 : radius, 0, -1 + 2.0 * static_cast<double>(i) / static_cast<double>(count - 1)));
  }
  BRepBuilderAPI_MakeWire outline(BRepBuilderAPI_MakeEdge(spline_through(points, false)));
  const gp_Pnt low = at(axes, 0, 0, -1), high = at(axes, 0, 0, 1);
  if (!to_axis) outline.Add(BRepBuilderAPI_MakeEdge(points.back(), high));
  outline.Add(BRepBuilderAPI_MakeEdge(high, low));
  if (!to_axis) outline.Add(BRepBuilderAPI_MakeEdge(low, points.front()));
  const double turn = draw.coin() ? kTurn : draw.between(0.5, 6);
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(outline.Wire()).Face(),
                               gp_Ax1(axes.Location(), axes.Direction()), turn)
      .Shape();
}

}  // namespace

const std::vector<ShapeKind>& primitive_kinds() {
  static const std::vector<ShapeKind> kinds{
      {"box", box},   {"cylinder", cylinder}, {"cylinder", cylinder},    {"ball", ball},
      {"cone", cone}, {"torus", torus},       {"wedge", wedge},          {"prism", spline_prism},
      {"loft", loft}, {"pipe", pipe},         {"revolution", revolution}};
  return kinds;
}

}  // namespace curvetet::test
