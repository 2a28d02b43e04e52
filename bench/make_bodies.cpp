// Writes the bodies of the thin-wall, kind and seam checks as BREP files: bodies on which other meshers stop, and one
// or more of each kind of surface; and one for measuring speed. Usage: make_bodies FOLDER
#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_GTransform.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepOffsetAPI_MakeThickSolid.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepOffset_MakeOffset.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_ListOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>
#include <gp_Elips.hxx>
#include <numbers>
#include <string>

namespace {

std::filesystem::path folder;

void check(bool is_written, const std::string& name) {
  if (is_written) return;
  std::fprintf(stderr, "%s cannot be written\n", name.c_str());
  std::exit(1);
}

void save(const std::string& name, const TopoDS_Shape& shape) {
  check(BRepTools::Write(shape, (folder / (name + ".brep")).c_str()), name + ".brep");
  std::printf("%s\n", name.c_str());
}

TopoDS_Shape cut(const TopoDS_Shape& a, const TopoDS_Shape& b) { return BRepAlgoAPI_Cut(a, b).Shape(); }
gp_Ax2 axis(gp_Pnt p, gp_Dir d = gp_Dir(0, 0, 1)) { return gp_Ax2(p, d); }

void thin_walls() {
  for (const char* wall : {"1", "0.5", "0.2"}) {
    const double t = std::stod(wall);
    save(std::string("shell_") + wall, cut(BRepPrimAPI_MakeSphere(10).Shape(), BRepPrimAPI_MakeSphere(10 - t).Shape()));
    save(std::string("tube_") + wall,
         cut(BRepPrimAPI_MakeCylinder(10, 30).Shape(), BRepPrimAPI_MakeCylinder(10 - t, 30).Shape()));
  }
  save("lens", BRepAlgoAPI_Common(BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, -9.5), 10).Shape(),
                                  BRepPrimAPI_MakeSphere(gp_Pnt(0, 0, 9.5), 10).Shape())
                   .Shape());
  const double half_turn = std::numbers::pi / 2;
  save("bent_pipe",
       cut(BRepPrimAPI_MakeTorus(10, 3, half_turn).Shape(), BRepPrimAPI_MakeTorus(10, 2.7, half_turn).Shape()));
  save("ball_in_box", cut(BRepPrimAPI_MakeBox(gp_Pnt(-5.01, -5.01, -5.01), 10.02, 10.02, 10.02).Shape(),
                          BRepPrimAPI_MakeSphere(5).Shape()));
  save("two_bores", cut(cut(BRepPrimAPI_MakeBox(gp_Pnt(-8, -5, 0), 16, 10, 10).Shape(),
                            BRepPrimAPI_MakeCylinder(axis(gp_Pnt(-3.01, 0, -1)), 3, 12).Shape()),
                        BRepPrimAPI_MakeCylinder(axis(gp_Pnt(3.01, 0, -1)), 3, 12).Shape()));
  save("eccentric", cut(BRepPrimAPI_MakeCylinder(10, 20).Shape(),
                        BRepPrimAPI_MakeCylinder(axis(gp_Pnt(0.99, 0, -1)), 8.99, 22).Shape()));
  save("cone_shell",
       cut(BRepPrimAPI_MakeCone(6, 0, 12).Shape(), BRepPrimAPI_MakeCone(axis(gp_Pnt(0, 0, -0.5)), 6, 0, 12).Shape()));
}

Handle(Geom_BSplineCurve) spline(std::initializer_list<gp_Pnt> points) {
  TColgp_Array1OfPnt array(1, static_cast<int>(points.size()));
  int i = 1;
  for (const gp_Pnt& p : points) array(i++) = p;
  return GeomAPI_PointsToBSpline(array).Curve();
}

TopoDS_Shape profile_face() {
  const auto profile = spline({{2, 0, 0}, {3, 0, 2}, {1.5, 0, 4}, {2.5, 0, 6}});
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(profile).Edge(),
                               BRepBuilderAPI_MakeEdge(gp_Pnt(2.5, 0, 6), gp_Pnt(0, 0, 6)).Edge(),
                               BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 6), gp_Pnt(0, 0, 0)).Edge(),
                               BRepBuilderAPI_MakeEdge(gp_Pnt(0, 0, 0), gp_Pnt(2, 0, 0)).Edge());
  return BRepBuilderAPI_MakeFace(wire.Wire()).Face();
}

TopoDS_Shape revolved_profile() {
  return BRepPrimAPI_MakeRevol(profile_face(), gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape();
}

TopoDS_Shape elliptic_prism() {
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(gp_Elips(axis(gp_Pnt(0, 0, 0)), 4, 2)).Edge());
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0, 0, 6)).Shape();
}

void kinds() {
  save("kind_plane", BRepPrimAPI_MakeBox(3, 4, 5).Shape());
  save("kind_cylinder", BRepPrimAPI_MakeCylinder(2, 6).Shape());
  save("kind_cone_apex", BRepPrimAPI_MakeCone(3, 0, 5).Shape());
  save("kind_cone", BRepPrimAPI_MakeCone(3, 1, 5).Shape());
  save("kind_sphere", BRepPrimAPI_MakeSphere(4).Shape());
  save("kind_torus", BRepPrimAPI_MakeTorus(6, 2).Shape());
  save("kind_horn_torus_sector", BRepPrimAPI_MakeTorus(6, 2, 2.0).Shape());
  save("kind_bspline", BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeTorus(6, 2).Shape()).Shape());
  save("kind_bspline_ball", BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeSphere(4).Shape()).Shape());
  const TopoDS_Shape section = profile_face();
  save("kind_revolution", revolved_profile());
  save("kind_extrusion", BRepPrimAPI_MakePrism(section, gp_Vec(0, 5, 1)).Shape());
  save("kind_closed_extrusion", elliptic_prism());
  BRepOffsetAPI_ThruSections loft(true, false);
  for (double z : {0.0, 3.0, 6.0}) {
    const double r = z == 3.0 ? 1.5 : 3.0;
    loft.AddWire(
        BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(gp_Circ(axis(gp_Pnt(0.3 * z, 0, z)), r)).Edge()).Wire());
  }
  save("kind_loft", loft.Shape());
  BRepOffset_MakeOffset offset(BRepPrimAPI_MakePrism(section, gp_Vec(0, 5, 0)).Shape(), 0.3, 1e-4, BRepOffset_Skin,
                               false, false, GeomAbs_Intersection);
  if (offset.IsDone()) save("kind_offset", offset.Shape());
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(6, 6, 4).Shape();
  BRepFilletAPI_MakeFillet fillet(block);
  for (TopExp_Explorer e(block, TopAbs_EDGE); e.More(); e.Next()) fillet.Add(0.8, TopoDS::Edge(e.Current()));
  save("kind_fillet", fillet.Shape());
}

/// A bore of radius r across the seams at u = 0, from the axis of z outward.
TopoDS_Shape bored(const TopoDS_Shape& body, double z, double r) {
  return cut(body, BRepPrimAPI_MakeCylinder(axis(gp_Pnt(0, 0, z), gp_Dir(1, 0, 0)), r, 20).Shape());
}

void seams() {
  const TopoDS_Shape torus = BRepPrimAPI_MakeTorus(6, 2).Shape();
  save("seam_cylinder_hole", bored(BRepPrimAPI_MakeCylinder(3, 10).Shape(), 5, 1));
  save("seam_cone_hole", bored(BRepPrimAPI_MakeCone(4, 0, 10).Shape(), 4, 1));
  save("seam_sphere_hole", bored(BRepPrimAPI_MakeSphere(4).Shape(), 0, 1));
  save("seam_torus_hole",
       cut(torus, BRepPrimAPI_MakeCylinder(axis(gp_Pnt(6, 0, 0), gp_Dir(1, 0, 0)), 0.7, 10).Shape()));
  save("seam_bspline_hole", cut(BRepBuilderAPI_NurbsConvert(torus).Shape(),
                                BRepPrimAPI_MakeCylinder(axis(gp_Pnt(6, 0, 0), gp_Dir(1, 0, 0)), 0.7, 10).Shape()));
  save("seam_revolution_hole", bored(revolved_profile(), 3, 0.8));
  save("seam_extrusion_hole", bored(elliptic_prism(), 3, 1));
  save("pole_hole",
       cut(BRepPrimAPI_MakeSphere(4).Shape(), BRepPrimAPI_MakeCylinder(axis(gp_Pnt(0, 0, 0)), 1, 10).Shape()));
}

/// Bodies whose coarse meshes without curvature are tempted: by a facet over all of a half turn of a slot or ridge, and
/// by one edge for two faces across a countersink or where bores meet.
void coarse() {
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(60, 30, 20).Shape();
  const gp_Dir along(1, 0, 0), across(0, 1, 0);
  save("coarse_slot", cut(block, BRepPrimAPI_MakeCylinder(axis(gp_Pnt(12, 15, 20), along), 1.5, 54).Shape()));
  save("coarse_ridge",
       BRepAlgoAPI_Fuse(block, BRepPrimAPI_MakeCylinder(axis(gp_Pnt(12, 15, 20), along), 1, 36).Shape()).Shape());
  save("coarse_slots", cut(cut(block, BRepPrimAPI_MakeCylinder(axis(gp_Pnt(20, -1, 20), across), 2, 40).Shape()),
                           BRepPrimAPI_MakeCylinder(axis(gp_Pnt(-1, 11, 20), along), 1.6, 99).Shape()));
  TopoDS_Shape sunk = BRepPrimAPI_MakeBox(80, 50, 20).Shape(), bored = sunk;
  for (const gp_Pnt& p : {gp_Pnt(10, 12, 0), gp_Pnt(28, 21, 0)}) {
    sunk = cut(sunk, BRepPrimAPI_MakeCylinder(axis(gp_Pnt(p.X(), p.Y(), -1)), 3, 22).Shape());
    sunk = cut(sunk, BRepPrimAPI_MakeCone(axis(gp_Pnt(p.X(), p.Y(), 17)), 3, 6, 3).Shape());
    bored = cut(bored, BRepPrimAPI_MakeCylinder(axis(gp_Pnt(p.X(), -1, 10), across), 4, 60).Shape());
    bored = cut(bored, BRepPrimAPI_MakeCylinder(axis(gp_Pnt(p.X(), 25, -1)), 3.6, 22).Shape());
  }
  save("coarse_countersinks", sunk);
  save("coarse_bores", bored);
}

/// For measuring speed: the surface is simple, so that most of the work is inside. As STEP, too, for peers that read
/// nothing else.
void bulk() {
  const TopoDS_Shape box =
      cut(BRepPrimAPI_MakeBox(1, 1, 1).Shape(), BRepPrimAPI_MakeSphere(gp_Pnt(0.5, 0.5, 0.5), 0.3).Shape());
  const TopoDS_Shape body = cut(box, BRepPrimAPI_MakeCylinder(axis(gp_Pnt(0.15, 0.15, -1)), 0.1, 3).Shape());
  save("bulk", body);
  STEPControl_Writer writer;
  writer.Transfer(body, STEPControl_AsIs);
  check(writer.Write((folder / "bulk.step").c_str()) == IFSelect_RetDone, "bulk.step");
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_bodies FOLDER\n");
    return 2;
  }
  folder = argv[1];
  std::filesystem::create_directories(folder);
  thin_walls();
  kinds();
  seams();
  coarse();
  bulk();
  return 0;
}
