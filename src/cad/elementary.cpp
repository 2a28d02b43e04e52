// OpenCASCADE intersects a cylinder in closed form but a surface of revolution by marching, and its projections onto
// the latter go astray. ShapeCustom::SweptToElementary was rejected: it crashes (7.6.3) on solids of which only some
// faces change.
#include "cad/elementary.h"

#include <BRep_Tool.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_Line.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Face.hxx>
#include <cmath>
#include <gp_Ax3.hxx>

namespace curvetet {
namespace {

constexpr double kSine = 1e-9;  ///< of angles that count as none

Handle(Geom_Line) line_of(const Handle(Geom_Curve) & curve) {
  const Handle(Geom_TrimmedCurve) trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve);
  return Handle(Geom_Line)::DownCast(trimmed.IsNull() ? curve : trimmed->BasisCurve());
}

}  // namespace

Handle(Geom_Surface) ElementarySurfaces::elementary(const Handle(Geom_Surface) & surface) {
  const Handle(Geom_SurfaceOfRevolution) swept = Handle(Geom_SurfaceOfRevolution)::DownCast(surface);
  if (swept.IsNull()) return {};
  const Handle(Geom_Line) line = line_of(swept->BasisCurve());
  if (line.IsNull()) return {};
  const gp_Ax1 axis = swept->Axis();
  const gp_XYZ along = axis.Direction().XYZ(), origin = axis.Location().XYZ();
  const gp_XYZ start = line->Position().Location().XYZ(), direction = line->Position().Direction().XYZ();
  const gp_XYZ foot = origin + along * (start - origin).Dot(along);
  const double radius = (start - foot).Modulus();
  if (!(radius > 1e-9 * (1 + start.Modulus()))) return {};
  const gp_XYZ outward = (start - foot) / radius;
  const double slope = direction.Dot(outward);
  if (std::abs(direction.Dot(along.Crossed(outward))) > kSine || std::abs(direction.Dot(along)) < 0.01) return {};
  gp_Ax3 frame{gp_Pnt(foot), gp_Dir(along), gp_Dir(outward)};
  if (direction.Dot(along) < 0) frame.ZReverse();
  if (std::abs(slope) <= kSine) return new Geom_CylindricalSurface(frame, radius);
  return new Geom_ConicalSurface(frame, std::asin(slope), radius);
}

Standard_Boolean ElementarySurfaces::NewSurface(const TopoDS_Face& face, Handle(Geom_Surface) & surface,
                                                TopLoc_Location& location, Standard_Real& tolerance,
                                                Standard_Boolean& reverse_wires, Standard_Boolean& reverse_face) {
  surface = elementary(BRep_Tool::Surface(face, location));
  tolerance = BRep_Tool::Tolerance(face);
  reverse_wires = reverse_face = false;
  return !surface.IsNull();
}

Standard_Boolean ElementarySurfaces::NewCurve(const TopoDS_Edge&, Handle(Geom_Curve) &, TopLoc_Location&,
                                              Standard_Real&) {
  return false;
}

Standard_Boolean ElementarySurfaces::NewPoint(const TopoDS_Vertex&, gp_Pnt&, Standard_Real&) { return false; }

Standard_Boolean ElementarySurfaces::NewCurve2d(const TopoDS_Edge& edge, const TopoDS_Face& face, const TopoDS_Edge&,
                                                const TopoDS_Face&, Handle(Geom2d_Curve) & curve,
                                                Standard_Real& tolerance) {
  TopLoc_Location location;
  if (elementary(BRep_Tool::Surface(face, location)).IsNull()) return false;
  Standard_Real low = 0, high = 0;
  curve = BRep_Tool::CurveOnSurface(edge, face, low, high);
  tolerance = BRep_Tool::Tolerance(edge);
  return !curve.IsNull();
}

Standard_Boolean ElementarySurfaces::NewParameter(const TopoDS_Vertex&, const TopoDS_Edge&, Standard_Real&,
                                                  Standard_Real&) {
  return false;
}

GeomAbs_Shape ElementarySurfaces::Continuity(const TopoDS_Edge& edge, const TopoDS_Face& one, const TopoDS_Face& two,
                                             const TopoDS_Edge&, const TopoDS_Face&, const TopoDS_Face&) {
  return BRep_Tool::Continuity(edge, one, two);
}

}  // namespace curvetet
