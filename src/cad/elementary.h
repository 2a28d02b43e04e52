// Surfaces swept from straight lines as the cylinders and cones they are. Inside cad only.
#pragma once

#include <BRepTools_Modification.hxx>

namespace curvetet {

/// For BRepTools_Modifier: replaces every surface of revolution of a straight line by a cylinder or cone with the same
/// parameters, so that parameter curves stay as they are. Lines across or askew of the axis are left alone.
class ElementarySurfaces : public BRepTools_Modification {
 public:
  /// The cylinder or cone; null if the surface is none, or is stored as one already.
  static Handle(Geom_Surface) elementary(const Handle(Geom_Surface) & surface);

  Standard_Boolean NewSurface(const TopoDS_Face& face, Handle(Geom_Surface) & surface, TopLoc_Location& location,
                              Standard_Real& tolerance, Standard_Boolean& reverse_wires,
                              Standard_Boolean& reverse_face) override;
  Standard_Boolean NewCurve(const TopoDS_Edge& edge, Handle(Geom_Curve) & curve, TopLoc_Location& location,
                            Standard_Real& tolerance) override;
  Standard_Boolean NewPoint(const TopoDS_Vertex& vertex, gp_Pnt& point, Standard_Real& tolerance) override;
  Standard_Boolean NewCurve2d(const TopoDS_Edge& edge, const TopoDS_Face& face, const TopoDS_Edge& new_edge,
                              const TopoDS_Face& new_face, Handle(Geom2d_Curve) & curve,
                              Standard_Real& tolerance) override;
  Standard_Boolean NewParameter(const TopoDS_Vertex& vertex, const TopoDS_Edge& edge, Standard_Real& parameter,
                                Standard_Real& tolerance) override;
  GeomAbs_Shape Continuity(const TopoDS_Edge& edge, const TopoDS_Face& one, const TopoDS_Face& two,
                           const TopoDS_Edge& new_edge, const TopoDS_Face& new_one,
                           const TopoDS_Face& new_two) override;
};

}  // namespace curvetet
