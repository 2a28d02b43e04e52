// Shapes in memory are meshed as files are, keep what they are called, and stay as they were.
#include <gtest/gtest.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepLib.hxx>
#include <BRepOffsetAPI_MakePipe.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <gp_Cone.hxx>
#include <gp_Pln.hxx>
#include <limits>
#include <numbers>
#include <set>
#include <sstream>
#include <tuple>

#include "curvetet/occt.h"
#include "support/occt_shapes.h"

namespace curvetet {
namespace {

TopoDS_Shape block_with_bore() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  const TopoDS_Shape bore = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 10, -1), gp_Dir(0, 0, 1)), 3, 40).Shape();
  return BRepAlgoAPI_Cut(box, bore).Shape();
}

TopoDS_Shape face_of(const TopoDS_Shape& shape, int id) {
  TopTools_IndexedMapOfShape faces;
  TopExp::MapShapes(shape, TopAbs_FACE, faces);
  return faces(id);
}

int edges_of(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  return edges.Extent();
}

std::string bytes_of(const TopoDS_Shape& shape) {
  std::ostringstream out;
  BinTools::Write(shape, out);
  return out.str();
}

TEST(MeshOfAShape, IsTheMeshOfItsFile) {
  const TopoDS_Shape block = block_with_bore();
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "curvetet_shape_test.bin";
  ASSERT_TRUE(BinTools::Write(block, file.c_str()));  // text would round
  Options options;
  options.isolate_cad = false;
  Context first, second;
  const Result<MeshOutput> of_shape = mesh(block, options, first);
  const Result<MeshOutput> of_file = mesh(Input{file.string()}, options, second);
  std::filesystem::remove(file);
  ASSERT_TRUE(of_shape) << of_shape.error().message;
  ASSERT_TRUE(of_file) << of_file.error().message;
  EXPECT_TRUE(of_shape.value().report.valid);
  EXPECT_EQ(of_shape.value().report.mesh_hash, of_file.value().report.mesh_hash);
  EXPECT_EQ(of_shape.value().report.input, "shape");
  const Report& report = of_shape.value().report;
  ASSERT_FALSE(report.stages.empty());
  for (const StageTime& stage : report.stages) {
    EXPECT_GT(stage.bytes, std::size_t{1} << 20U) << stage.stage;
    EXPECT_LE(stage.bytes, report.peak_bytes) << stage.stage;
  }
}

TEST(MeshOfAShape, KeepsNamesColoursAndUnit) {
  const TopoDS_Shape block = block_with_bore();
  ShapeLabels labels{"block", {{face_of(block, 2), "inlet", std::array<double, 3>{1, 0, 0}}}};
  labels.parts.push_back({TopExp_Explorer(block, TopAbs_SOLID).Current(), "steel", {}});
  Options options;
  options.input_unit = "cm";
  options.unit = "mm";
  options.size = 60;
  options.local_sizes.push_back({LocalSize::Kind::face, "inlet", 30});
  Context context;
  const Result<MeshOutput> made = mesh(block, labels, options, context);
  ASSERT_TRUE(made) << made.error().message;
  const Mesh& result = made.value().mesh;
  ASSERT_EQ(result.faces.size(), 7U);
  for (const Entity& face : result.faces) {
    EXPECT_EQ(face.name, face.cad_id == 2 ? "inlet" : "face_" + std::to_string(face.cad_id));
    EXPECT_EQ(face.colour.has_value(), face.cad_id == 2);
  }
  EXPECT_EQ(result.solids.at(0).name, "steel");
  EXPECT_EQ(result.unit, "mm");
  EXPECT_DOUBLE_EQ(result.solids[0].box[5] - result.solids[0].box[2], 300) << "30 cm";
}

TEST(MeshOfAShape, FollowsTheSizesOfACallback) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(10, 20, 30).Shape();
  Options options;
  options.size = 5;
  Context context;
  const Result<MeshOutput> plain = mesh(box, options, context);
  options.unit = "cm";  // what the callback is asked and answers in
  options.size = 0.5;
  options.size_callback = [](Point p) { return p[2] < 1 ? 0.15 : 0.5; };
  const Result<MeshOutput> made = mesh(box, options, context);
  ASSERT_TRUE(plain && made);
  EXPECT_TRUE(made.value().report.valid);
  EXPECT_GT(made.value().report.points, 2 * plain.value().report.points);
  std::size_t low = 0, high = 0;
  for (const Point& p : made.value().mesh.points) ++(p[2] < 1 ? low : high);
  EXPECT_GT(low, 2 * high) << "a third of the body, but finer";
}

TEST(MeshOfAShape, CancelInAnyStageIsNoOtherError) {
  const TopoDS_Shape block = block_with_bore();
  std::vector<std::string> stages;
  Context whole;
  whole.on_progress = [&](std::string_view stage, double) { stages.emplace_back(stage); };
  ASSERT_TRUE(mesh(block, Options{}, whole));
  ASSERT_EQ(stages.back(), "done");
  stages.pop_back();
  ASSERT_GT(stages.size(), 8U);
  for (const std::string& at : stages) {
    Context context;
    context.on_progress = [&](std::string_view stage, double) {
      if (stage == at) context.cancel();
    };
    Report report;
    const Result<MeshOutput> made = mesh(block, Options{}, context, &report);
    ASSERT_FALSE(made) << at;
    EXPECT_EQ(made.error().code, ErrorCode::cancelled) << at;
    EXPECT_FALSE(report.stages.empty()) << "what is finished is kept";
  }
}

TEST(MeshOfAShape, ProgressRisesWithTheFacesRecovered) {
  std::vector<double> all;
  std::set<double> in_recovery;
  Context context;
  context.on_progress = [&](std::string_view stage, double fraction) {
    all.push_back(fraction);
    if (stage == "recovery") in_recovery.insert(fraction);
  };
  ASSERT_TRUE(mesh(block_with_bore(), Options{}, context));
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
  EXPECT_EQ(all.back(), 1);
  EXPECT_GE(in_recovery.size(), 7U) << "a step for each of seven faces";
}

/// Loose faces are sewn, which changes tolerances and merges edges: in a copy.
TEST(MeshOfAShape, LeavesTheShapeAsItWas) {
  TopoDS_Compound loose;
  BRep_Builder builder;
  builder.MakeCompound(loose);
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
  for (TopExp_Explorer face(box, TopAbs_FACE); face.More(); face.Next())
    builder.Add(loose, BRepBuilderAPI_NurbsConvert(face.Current(), true).Shape());
  const std::string before = bytes_of(loose);
  Context context;
  const Result<MeshOutput> made = mesh(loose, Options{}, context);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_FALSE(made.value().report.healing.empty());
  EXPECT_EQ(bytes_of(loose), before);
}

/// A ring whose ends touch along a line, each with edges and vertices of its own there.
TopoDS_Shape ring_that_touches_itself() {
  BRepBuilderAPI_MakePolygon profile;
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{
           {0, 0}, {10, 0}, {10, 10}, {0, 10}, {1.5, 5}, {3, 7}, {7, 7}, {7, 3}, {3, 3}, {1.5, 5}})
    profile.Add(gp_Pnt(x, y, 0));
  profile.Close();
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(profile.Wire(), true).Face(), gp_Vec(0, 0, 4)).Shape();
}

TEST(MeshOfAShape, TouchesItselfWhereTheShapeDoes) {
  for (const double size : {12.0, 6.0, 2.0}) {
    Options options;
    options.size = size;
    Context context;
    const Result<MeshOutput> made = mesh(ring_that_touches_itself(), options, context);
    ASSERT_TRUE(made) << size << ": " << made.error().message;
    EXPECT_TRUE(made.value().report.valid) << size;
    const std::vector<std::string>& healing = made.value().report.healing;
    EXPECT_TRUE(std::any_of(healing.begin(), healing.end(), [](const std::string& note) {
      return note.find("where the body touches itself") != std::string::npos;
    })) << size;
  }
}

double shortest_edge(const Mesh& mesh) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Point &a = mesh.points[t[i]], &b = mesh.points[t[(i + 1) % 3]];
      shortest = std::min(shortest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
    }
  return shortest;
}

/// Where only the surface mesh matters.
Options surface_only(double size) {
  Options options;
  options.size = size;
  options.refine_interior = false;
  options.improve = false;
  return options;
}

// Edges between the rims of a spline's patches were split on lines of one parameter, where triangles lay flat on each
// other.
TEST(MeshOfAShape, FineTorusOfSplinesHasNoCrossings) {
  const TopoDS_Shape torus = BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeTorus(6, 2).Shape());
  for (const double size : {0.5, 0.23}) {
    const Options options = surface_only(size);
    Context context;
    const Result<MeshOutput> made = mesh(torus, options, context);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(made.value().report.valid);
    EXPECT_EQ(made.value().report.recovery.crossings, 0U) << size;
    EXPECT_GT(shortest_edge(made.value().mesh), 0.1 * size);
  }
}

// Edges wrapped around a spline's surface, which nothing led out of, and triangles crossed.
TEST(MeshOfAShape, ThinElbowOfSplinesHasNoCrossings) {
  const TopoDS_Shape elbow = BRepBuilderAPI_NurbsConvert(BRepPrimAPI_MakeTorus(10, 0.02, 1).Shape());
  const Options options = surface_only(1);
  Context context;
  const Result<MeshOutput> made = mesh(elbow, options, context);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made.value().report.valid);
  EXPECT_EQ(made.value().report.recovery.crossings, 0U);
}

/// A bore that reaches the outside along a line: the seams of both cylinders are one edge there.
TEST(MeshOfAShape, ABoreMayTouchTheOutsideInALine) {
  const TopoDS_Shape rod = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 3, 4).Shape();
  const TopoDS_Shape bore = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(2, 0, -1), gp_Dir(0, 0, 1)), 1, 6).Shape();
  const TopoDS_Shape body = BRepAlgoAPI_Cut(rod, bore).Shape();
  ASSERT_EQ(edges_of(body), 5) << "the line is one edge";
  for (const double size : {2.0, 0.7}) {
    Options options;
    options.size = size;
    Context context;
    const Result<MeshOutput> made = mesh(body, options, context);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(made.value().report.valid) << size;
  }
}

/// A prism over a closed spline through points on two circles in turn.
TopoDS_Shape star(int rays, double inner, double outer) {
  std::vector<gp_Pnt> points;
  for (int i = 0; i < 2 * rays; ++i) {
    const double angle = std::numbers::pi * i / rays, r = i % 2 == 0 ? outer : inner;
    points.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
  }
  const TopoDS_Wire wire = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(test::spline_through(points, true)));
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire), gp_Vec(0, 0, 1)).Shape();
}

// The check saw an edge at a few places, here the tips of the rays, and missed triangles between them.
TEST(MeshOfAShape, AnEdgeMayBendMoreOftenThanItIsLookedAt) {
  const Options options = surface_only(0.4);
  Context context;
  const Result<MeshOutput> made = mesh(star(24, 8, 10), options, context);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made.value().report.valid);
  EXPECT_TRUE(made.value().report.warnings.empty()) << made.value().report.warnings.front();
}

/// A flat ring with a full round along its outside, of much smaller radius than its chords are high.
TopoDS_Shape ring_with_round_rim(double radius) {
  const gp_Pnt a(0.5, 0, -radius), b(1, 0, -radius), c(1, 0, radius), d(0.5, 0, radius);
  BRepBuilderAPI_MakeWire outline;
  outline.Add(BRepBuilderAPI_MakeEdge(a, b));
  outline.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(b, gp_Pnt(1 + radius, 0, 0), c).Value()));
  outline.Add(BRepBuilderAPI_MakeEdge(c, d));
  outline.Add(BRepBuilderAPI_MakeEdge(d, a));
  const TopoDS_Face section = BRepBuilderAPI_MakeFace(outline.Wire());
  return BRepPrimAPI_MakeRevol(section, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape();
}

// Facets from one border of the round to the other lie inside of the ring and look away from the round, where it is
// closest; points on the round do not help, shorter chords do.
TEST(MeshOfAShape, CoarseChordsAlongAThinRoundAreSplit) {
  for (const double radius : {0.01, 0.003}) {
    for (const double size : {2.0, 0.7, 0.3}) {
      Options options;
      options.size = size;
      options.curvature = 0;
      Context context;
      const Result<MeshOutput> made = mesh(ring_with_round_rim(radius), options, context);
      ASSERT_TRUE(made) << radius << " at " << size << ": " << made.error().message;
      EXPECT_TRUE(made.value().report.valid) << radius << " at " << size;
    }
  }
}

/// A cone of which both nappes are in use.
TopoDS_Shape hourglass() {
  const TopoDS_Shape face = BRepBuilderAPI_MakeFace(gp_Cone(gp_Ax3(), 0.5, 1), 0, 2 * std::numbers::pi, -3, 1).Shape();
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(face, TopAbs_EDGE, edges);
  BRepBuilderAPI_Sewing sewing(1e-6);
  sewing.Add(face);
  for (int e = 1; e <= edges.Extent(); ++e) {
    const BRepAdaptor_Curve curve(TopoDS::Edge(edges(e)));
    if (curve.GetType() != GeomAbs_Circle) continue;
    const TopoDS_Wire rim = BRepBuilderAPI_MakeWire(TopoDS::Edge(edges(e)));
    sewing.Add(BRepBuilderAPI_MakeFace(rim, true).Shape());
  }
  sewing.Perform();
  return BRepBuilderAPI_MakeSolid(TopoDS::Shell(sewing.SewedShape())).Shape();
}

/// Along a helix of radius 0.7 and pitch 0.3.
TopoDS_Shape wire_coil(double turns, double radius) {
  constexpr double kTurn = 2 * std::numbers::pi;
  const Handle(Geom_CylindricalSurface) around = new Geom_CylindricalSurface(gp_Ax3(), 0.7);
  const Handle(Geom2d_Line) line = new Geom2d_Line(gp_Pnt2d(0, 0), gp_Dir2d(kTurn, 0.3));
  const TopoDS_Edge helix = BRepBuilderAPI_MakeEdge(line, around, 0, turns * std::hypot(kTurn, 0.3)).Edge();
  BRepLib::BuildCurves3d(helix);
  const gp_Circ circle(gp_Ax2(gp_Pnt(0.7, 0, 0), gp_Dir(0, 0.7 * kTurn, 0.3)), radius);
  const TopoDS_Wire outline = BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle)).Wire();
  const TopoDS_Wire spine = BRepBuilderAPI_MakeWire(helix).Wire();
  return BRepOffsetAPI_MakePipe(spine, BRepBuilderAPI_MakeFace(outline).Face()).Shape();
}

// Chords as long as the coil is wide: each round of the outer loop told of folds in other places of the one face, or
// found an edge around the wire from a vertex to itself and gave up.
TEST(MeshOfAShape, AThinWireMayBeMeshedWithChordsAsLongAsItsCoilIsWide) {
  for (const auto& [turns, radius, size] :
       {std::tuple(1.0, 0.03, 0.4), std::tuple(1.5, 0.015, 0.8), std::tuple(2.5, 0.03, 0.8)}) {
    Options options;
    options.size = size;
    options.curvature = 0;
    Context context;
    const Result<MeshOutput> made = mesh(wire_coil(turns, radius), options, context);
    ASSERT_TRUE(made) << turns << " " << made.error().message;
    EXPECT_TRUE(made.value().report.valid) << turns;
  }
}

// A cone of 0.6 degrees with a slot to its axis. Where it is thinner than the least size, triangles spanned half a turn
// and ran through the slot.
TEST(MeshOfAShape, ANeedleKeepsItsSlotUpToTheTip) {
  for (const double size : {0.4, 0.8}) {
    Options options;
    options.size = size;
    Context context;
    const Result<MeshOutput> made = mesh(BRepPrimAPI_MakeCone(0.03, 0, 3, 5.2).Shape(), options, context);
    ASSERT_TRUE(made) << made.error().message;
    EXPECT_TRUE(made.value().report.valid) << size;
  }
}

/// A spline profile from axis to axis, turned, that overshoots the axis before its upper end.
TopoDS_Shape overshot_revolution() {
  const std::vector<gp_Pnt> points{{0, 0, -1}, {1, 0, -0.5}, {0.05, 0, 0.5}, {0, 0, 1}};
  BRepBuilderAPI_MakeWire outline(BRepBuilderAPI_MakeEdge(test::spline_through(points, false)));
  outline.Add(BRepBuilderAPI_MakeEdge(points.back(), points.front()));
  const TopoDS_Face section = BRepBuilderAPI_MakeFace(outline.Wire()).Face();
  return BRepPrimAPI_MakeRevol(section, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape();
}

/// The error of a face that crosses itself, its message with that word; where it does.
Vec3 place_of_crossing(const TopoDS_Shape& shape, const std::string& word) {
  Context context;
  const Result<MeshOutput> made = mesh(shape, {}, context);
  EXPECT_FALSE(made);
  if (made) return {1e9, 1e9, 1e9};
  EXPECT_EQ(made.error().code, ErrorCode::self_intersection);
  EXPECT_NE(made.error().message.find(word), std::string::npos) << made.error().message;
  EXPECT_TRUE(made.error().where);
  return made.error().where.value_or(Vec3{1e9, 1e9, 1e9});
}

TEST(MeshOfAShape, ARevolutionWhoseProfileCrossesItsAxisCrossesItself) {
  const Vec3 where = place_of_crossing(overshot_revolution(), "axis");
  EXPECT_NEAR(std::hypot(where.x, where.y), 0, 1e-3);
}

TEST(MeshOfAShape, AConeThroughItsApexCrossesItself) {
  const Vec3 where = place_of_crossing(hourglass(), "apex");
  EXPECT_NEAR(where.x, 0, 1e-6);
  EXPECT_NEAR(where.z, -1 / std::tan(0.5), 1e-6);
}

TEST(MeshOfAShape, RefusesWhatItCannotMesh) {
  const TopoDS_Shape block = block_with_bore();
  const auto code = [](const TopoDS_Shape& shape, const ShapeLabels& labels, const Options& options) {
    Context context;
    Report report;
    const Result<MeshOutput> made = mesh(shape, labels, options, context, &report);
    if (made) return ErrorCode::internal;
    EXPECT_EQ(report.errors.size(), 1U);
    EXPECT_NE(made.error().message, "");
    return made.error().code;
  };
  EXPECT_EQ(code(TopoDS_Shape(), {}, {}), ErrorCode::no_faces);
  EXPECT_EQ(code(face_of(block, 1), {}, {}), ErrorCode::open_shell);
  EXPECT_EQ(code(block, {"block", {{TopoDS_Shape(), "nothing", {}}}}, {}), ErrorCode::bad_option);
  const TopoDS_Shape other = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  EXPECT_EQ(code(block, {"block", {{face_of(other, 1), "stranger", {}}}}, {}), ErrorCode::bad_option);
  Options options;
  options.input_unit = "furlong";
  EXPECT_EQ(code(block, {}, options), ErrorCode::bad_option);
}

}  // namespace
}  // namespace curvetet
