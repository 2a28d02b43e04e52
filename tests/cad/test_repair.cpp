// Faults that real files have: vertices that are one place, faces that meet in fours, solids that overlap.
#include <gtest/gtest.h>

#include <BRepAdaptor_Curve.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepTools_ReShape.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <ElSLib.hxx>
#include <Geom2d_Line.hxx>
#include <Geom_Line.hxx>
#include <Geom_Plane.hxx>
#include <Precision.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shell.hxx>
#include <TopoDS_Solid.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <gp.hxx>
#include <gp_Pln.hxx>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "cad/shape.h"
#include "shapes.h"
#include "support/occt_shapes.h"

namespace curvetet {
namespace {

using test::compound_of;

Result<Model> convert(const TopoDS_Shape& shape, Overlaps overlaps = Overlaps::refuse) {
  Context context;
  ShapeOptions options;
  options.joining.overlaps = overlaps;
  return model_from_shape(shape, options, context);
}

/// Flat faces over shared vertices and edges, each listed counterclockwise as seen from outside.
class Polyhedron {
 public:
  explicit Polyhedron(const std::vector<gp_Pnt>& points) {
    for (const gp_Pnt& p : points) vertices_.push_back(BRepBuilderAPI_MakeVertex(p).Vertex());
  }

  /// Before any face.
  void set_tolerance(std::size_t vertex, double tolerance) {
    BRep_Builder().UpdateVertex(vertices_[vertex], tolerance);
  }

  /// The plane is found where all edges have a length.
  void add_face(const std::vector<std::size_t>& corners, const std::optional<gp_Pln>& plane = std::nullopt) {
    // MakeWire would join the vertices itself.
    TopoDS_Wire wire;
    BRep_Builder builder;
    builder.MakeWire(wire);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      builder.Add(wire, edge(corners[i], corners[(i + 1) % corners.size()]));
    }
    wire.Closed(true);
    if (!plane) {
      faces_.push_back(BRepBuilderAPI_MakeFace(wire, true).Face());
      return;
    }
    TopoDS_Face face;
    builder.MakeFace(face, new Geom_Plane(*plane), Precision::Confusion());
    builder.Add(face, wire);
    for (TopExp_Explorer e(wire, TopAbs_EDGE); e.More(); e.Next()) give_curve(TopoDS::Edge(e.Current()), face, *plane);
    faces_.push_back(face);
  }

  TopoDS_Solid solid() const {
    TopoDS_Shell shell;
    TopoDS_Solid solid;
    BRep_Builder builder;
    builder.MakeShell(shell);
    for (const TopoDS_Shape& face : faces_) builder.Add(shell, face);
    builder.MakeSolid(solid);
    builder.Add(solid, shell);
    return solid;
  }

 private:
  TopoDS_Edge edge(std::size_t a, std::size_t b) {
    auto& known = edges_[std::minmax(a, b)];
    if (known.IsNull()) {
      const TopoDS_Vertex &from = vertices_[std::min(a, b)], &to = vertices_[std::max(a, b)];
      const bool is_empty = BRep_Tool::Pnt(from).Distance(BRep_Tool::Pnt(to)) == 0;
      known = is_empty ? empty_edge(from, to) : BRepBuilderAPI_MakeEdge(from, to).Edge();
    }
    return a < b ? known : TopoDS::Edge(known.Reversed());
  }

  /// The kernel makes none in a plane where the edge has no range.
  static void give_curve(const TopoDS_Edge& edge, const TopoDS_Face& face, const gp_Pln& plane) {
    Standard_Real low = 0, high = 0;
    BRep_Tool::Range(edge, low, high);
    if (low < high) return;
    double u = 0, v = 0;
    ElSLib::Parameters(plane, BRep_Tool::Pnt(TopExp::FirstVertex(edge)), u, v);
    BRep_Builder().UpdateEdge(edge, new Geom2d_Line(gp_Pnt2d(u, v), gp::DX2d()), face, Precision::Confusion());
  }

  static TopoDS_Edge empty_edge(const TopoDS_Vertex& from, const TopoDS_Vertex& to) {
    TopoDS_Edge edge;
    const BRep_Builder builder;
    builder.MakeEdge(edge, new Geom_Line(BRep_Tool::Pnt(from), gp::DX()), Precision::Confusion());
    builder.Add(edge, from.Oriented(TopAbs_FORWARD));
    builder.Add(edge, to.Oriented(TopAbs_REVERSED));
    builder.Range(edge, 0, 0);
    return edge;
  }

  std::vector<TopoDS_Vertex> vertices_;
  std::map<std::pair<std::size_t, std::size_t>, TopoDS_Edge> edges_;
  std::vector<TopoDS_Shape> faces_;
};

constexpr double kTiny = 2e-6;  // OpenCASCADE's own tolerance of an edge is 1e-7

/// A unit cube that has a tiny edge in the middle of its upper front edge.
TopoDS_Solid cube_with_tiny_edge(double tolerance, double length = kTiny) {
  Polyhedron cube({{0, 0, 0},
                   {1, 0, 0},
                   {1, 1, 0},
                   {0, 1, 0},
                   {0, 0, 1},
                   {1, 0, 1},
                   {1, 1, 1},
                   {0, 1, 1},
                   {0.5, 0, 1},
                   {0.5 + length, 0, 1}});
  cube.set_tolerance(9, tolerance);
  cube.add_face({3, 2, 1, 0});
  cube.add_face({4, 8, 9, 5, 6, 7});
  cube.add_face({0, 1, 5, 9, 8, 4});
  cube.add_face({1, 2, 6, 5});
  cube.add_face({2, 3, 7, 6});
  cube.add_face({3, 0, 4, 7});
  return cube.solid();
}

std::size_t used_edges(const Model& model) {
  return static_cast<std::size_t>(
      std::count_if(model.edges.begin(), model.edges.end(), [](const ModelEdge& edge) { return !edge.faces.empty(); }));
}

TEST(Repair, AnEdgeWithinTheToleranceOfItsEndsIsAPoint) {
  const Result<Model> model = convert(cube_with_tiny_edge(2 * kTiny));
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model.value().vertices.size(), 9U);
  EXPECT_EQ(used_edges(model.value()), 13U);
  EXPECT_FALSE(model.value().healing.empty());
  test::expect_sound(model.value(), "cube with a tiny edge");
}

TEST(Repair, AnEdgeBeyondTheToleranceOfItsEndsStays) {
  const Result<Model> model = convert(cube_with_tiny_edge(0.5 * kTiny));
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model.value().vertices.size(), 10U);
  EXPECT_EQ(used_edges(model.value()), 14U);
  test::expect_sound(model.value(), "cube with a short edge");
}

// However generous its ends are: it is far longer than its own tolerance.
TEST(Repair, AnEdgeThatIsExactStays) {
  const double length = 20 * kTiny;
  const Result<Model> model = convert(cube_with_tiny_edge(2 * length, length));
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model.value().vertices.size(), 10U);
  EXPECT_EQ(used_edges(model.value()), 14U);
}

bool has_note(const Model& model, const std::string& words) {
  return std::any_of(model.healing.begin(), model.healing.end(),
                     [&](const HealingNote& note) { return note.what.find(words) != std::string::npos; });
}

TEST(Repair, AVertexIsMovedToWhereItsEdgesEnd) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  const TopoDS_Vertex corner = TopoDS::Vertex(TopExp_Explorer(box, TopAbs_VERTEX).Current());
  const gp_Pnt before = BRep_Tool::Pnt(corner);
  BRep_Builder().UpdateVertex(corner, before.Translated(gp_Vec(0.008, 0.008, 0.008)), 0.05);
  const Result<Model> model = convert(box);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_TRUE(has_note(model.value(), "is moved by 0.0139"));
  test::expect_sound(model.value(), "box with a vertex aside");
  EXPECT_EQ(model.value().vertices.size(), 8U);
  EXPECT_EQ(used_edges(model.value()), 12U);
}

TEST(Repair, NoToleranceExplainsAVertexFarFromItsEdges) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  const TopoDS_Vertex corner = TopoDS::Vertex(TopExp_Explorer(box, TopAbs_VERTEX).Current());
  BRep_Builder().UpdateVertex(corner, gp_Pnt(0.3, 0.3, 0.3), 5);
  const Result<Model> model = convert(box);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::bad_face) << model.error().message;
}

/// The loose faces of a bent bar whose two ends touch along an edge: unit cubes around one that is left out.
TopoDS_Compound bar_that_touches_itself() {
  std::vector<TopoDS_Shape> faces;
  const auto filled = [](int x, int y) {
    const bool hole = x == 1 && y == 1, corner = x == 2 && y == 2;
    return x >= 0 && x < 3 && y >= 0 && y < 3 && !hole && !corner;
  };
  const auto add = [&](const std::array<gp_Pnt, 4>& p) {
    BRepBuilderAPI_MakeWire wire;
    for (std::size_t i = 0; i < 4; ++i) wire.Add(BRepBuilderAPI_MakeEdge(p[i], p[(i + 1) % 4]).Edge());
    faces.push_back(BRepBuilderAPI_MakeFace(wire.Wire(), true).Face());
  };
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 3; ++y) {
      if (!filled(x, y)) continue;
      const double a = x, b = x + 1, c = y, d = y + 1;
      add({gp_Pnt(a, c, 0), gp_Pnt(a, d, 0), gp_Pnt(b, d, 0), gp_Pnt(b, c, 0)});
      add({gp_Pnt(a, c, 1), gp_Pnt(b, c, 1), gp_Pnt(b, d, 1), gp_Pnt(a, d, 1)});
      if (!filled(x, y - 1)) add({gp_Pnt(a, c, 0), gp_Pnt(b, c, 0), gp_Pnt(b, c, 1), gp_Pnt(a, c, 1)});
      if (!filled(x, y + 1)) add({gp_Pnt(b, d, 0), gp_Pnt(a, d, 0), gp_Pnt(a, d, 1), gp_Pnt(b, d, 1)});
      if (!filled(x - 1, y)) add({gp_Pnt(a, d, 0), gp_Pnt(a, c, 0), gp_Pnt(a, c, 1), gp_Pnt(a, d, 1)});
      if (!filled(x + 1, y)) add({gp_Pnt(b, c, 0), gp_Pnt(b, d, 0), gp_Pnt(b, d, 1), gp_Pnt(b, c, 1)});
    }
  }
  return compound_of(faces);
}

/// Straight edges; the axis of a wedge of a cylinder is among them.
std::vector<TopoDS_Edge> straight_edges(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(shape, TopAbs_EDGE, map);
  std::vector<TopoDS_Edge> edges;
  for (int e = 1; e <= map.Extent(); ++e)
    if (BRepAdaptor_Curve(TopoDS::Edge(map(e))).GetType() == GeomAbs_Line) edges.push_back(TopoDS::Edge(map(e)));
  return edges;
}

/// Cuts the curves of an edge short at both ends, as an exporter that takes the wrong parameters, and raises the
/// tolerances of the vertices to the gap, as a reader may.
void cut_short(const TopoDS_Edge& edge, double by, bool raise) {
  Standard_Real low = 0, high = 0;
  BRep_Tool::Range(edge, low, high);
  const BRep_Builder builder;
  builder.Range(edge, low + by, high - 2 * by);
  if (!raise) return;
  for (TopExp_Explorer v(edge, TopAbs_VERTEX); v.More(); v.Next())
    builder.UpdateVertex(TopoDS::Vertex(v.Current()), 2 * by);
}

TEST(Repair, AnEdgeThatStopsShortOfItsVerticesIsJoinedToThem) {
  for (const bool raise : {false, true}) {
    for (std::size_t e = 0; e < 7; ++e) {
      const TopoDS_Shape wedge = BRepPrimAPI_MakeCylinder(5, 8, 0.5 * std::numbers::pi).Shape();
      ASSERT_EQ(straight_edges(wedge).size(), 7U);
      cut_short(straight_edges(wedge)[e], 1, raise);
      const Result<Model> model = convert(wedge);
      ASSERT_TRUE(model) << model.error().message << ", edge " << e;
      test::expect_sound(model.value(), "edge " + std::to_string(e));
      EXPECT_EQ(model.value().edges.size(), 11U);
      EXPECT_NEAR(test::total_volume(model.value()), 50 * std::numbers::pi, 1e-6);
      EXPECT_TRUE(has_note(model.value(), "ends short of a vertex"));
    }
  }
}

/// Where nothing says how the border goes on, it is not made up: the straight piece would leave a face.
TEST(Repair, AnEdgeThatStopsShortOnABentFaceIsRefused) {
  const TopoDS_Shape wedge = BRepPrimAPI_MakeCylinder(5, 8, 0.5 * std::numbers::pi).Shape();
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(wedge, TopAbs_EDGE, map);
  for (int e = 1; e <= map.Extent(); ++e) {
    const TopoDS_Edge edge = TopoDS::Edge(map(e));
    if (BRepAdaptor_Curve(edge).GetType() == GeomAbs_Circle) cut_short(edge, 0.2, false);
  }
  const Result<Model> model = convert(wedge);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::bad_face);
}

/// Nor where it would run back along the edge: this one goes the wrong way from its vertex.
TEST(Repair, AnEdgeThatGoesTheWrongWayIsRefused) {
  const TopoDS_Shape wedge = BRepPrimAPI_MakeCylinder(5, 8, 0.5 * std::numbers::pi).Shape();
  const TopoDS_Edge edge = straight_edges(wedge).front();
  Standard_Real low = 0, high = 0;
  BRep_Tool::Range(edge, low, high);
  BRep_Builder().Range(edge, low - (high - low), low);
  const Result<Model> model = convert(wedge);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::bad_face);
}

/// A cube with one edge twice, and between the two a face without area.
TopoDS_Solid cube_with_empty_face() {
  const TopoDS_Shape cube = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  const TopoDS_Edge edge = straight_edges(cube).front();
  Standard_Real low = 0, high = 0;
  const Handle(Geom_Curve) curve = BRep_Tool::Curve(edge, low, high);
  const TopoDS_Edge twin =
      BRepBuilderAPI_MakeEdge(curve, TopExp::FirstVertex(edge), TopExp::LastVertex(edge), low, high).Edge();
  TopoDS_Shell shell;
  TopoDS_Solid solid;
  const BRep_Builder builder;
  builder.MakeShell(shell);
  bool is_first = true;
  for (TopExp_Explorer face(cube, TopAbs_FACE); face.More(); face.Next()) {
    TopTools_IndexedMapOfShape edges;
    TopExp::MapShapes(face.Current(), TopAbs_EDGE, edges);
    const Handle(BRepTools_ReShape) change = new BRepTools_ReShape;
    if (edges.Contains(edge) && std::exchange(is_first, false)) change->Replace(edge, twin);
    builder.Add(shell, change->Apply(face.Current()));
  }
  gp_Pnt place;
  gp_Vec along;
  curve->D1(low, place, along);
  TopoDS_Wire wire;
  builder.MakeWire(wire);
  builder.Add(wire, edge);
  builder.Add(wire, twin.Reversed());
  const gp_Dir across = gp_Dir(gp_Vec(place, gp_Pnt(0.5, 0.5, 0.5)).Crossed(along));
  builder.Add(shell, BRepBuilderAPI_MakeFace(gp_Pln(place, across), wire, true).Face());
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return solid;
}

TEST(Repair, AFaceWithoutAreaIsLeftOut) {
  const TopoDS_Shape beside = BRepPrimAPI_MakeBox(gp_Pnt(3, 0, 0), 1, 1, 1).Shape();
  const Result<Model> model = convert(compound_of({cube_with_empty_face(), beside}));
  ASSERT_TRUE(model) << model.error().message;
  test::expect_sound(model.value(), "cube with an empty face");
  EXPECT_EQ(model.value().faces.size(), 12U);
  EXPECT_EQ(model.value().edges.size(), 24U);
  EXPECT_EQ(model.value().solids.size(), 2U);
  EXPECT_NEAR(test::total_volume(model.value()), 2, 1e-9);
  ASSERT_EQ(model.value().suppressed.size(), 1U);
  EXPECT_EQ(model.value().suppressed[0].kind, SuppressedDetail::Kind::face);
  EXPECT_EQ(model.value().suppressed[0].label.cad_id, 7U);
  EXPECT_TRUE(has_note(model.value(), "has no area"));
}

/// The same, where the two edges have vertices of their own, which edges without length join.
TEST(Repair, AFaceWithoutAreaBetweenEdgesWithoutLengthIsLeftOut) {
  Polyhedron cube(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {0, 0, 1}, {1, 0, 1}});
  cube.add_face({3, 2, 1, 0});
  cube.add_face({4, 5, 6, 7});
  cube.add_face({0, 1, 9, 8});
  cube.add_face({8, 9, 5, 4}, gp_Pln({0, 0, 1}, {0, -1, 1}));
  cube.add_face({1, 2, 6, 5, 9}, gp_Pln({1, 0, 0}, {1, 0, 0}));
  cube.add_face({2, 3, 7, 6});
  cube.add_face({3, 0, 8, 4, 7}, gp_Pln({0, 0, 0}, {-1, 0, 0}));
  const Result<Model> model = convert(cube.solid());
  ASSERT_TRUE(model) << model.error().message;
  test::expect_sound(model.value(), "cube with edges without length");
  EXPECT_EQ(model.value().faces.size(), 6U);
  EXPECT_EQ(used_edges(model.value()), 12U);
  EXPECT_NEAR(test::total_volume(model.value()), 1, 1e-9);
  // What is left keeps its id.
  for (const ModelEdge& edge : model.value().edges) EXPECT_TRUE(edge.faces.empty() || edge.label.cad_id <= 15);
  for (const ModelVertex& vertex : model.value().vertices) EXPECT_LE(vertex.label.cad_id, 10U);
}

/// A solid that lacks a face, beside a sound one: repairs make a loose shell of it, which has no faults.
TEST(Repair, ASolidThatCannotBeClosedIsAnErrorThoughAnotherIsSound) {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  TopoDS_Shell shell;
  TopoDS_Solid solid;
  const BRep_Builder builder;
  builder.MakeShell(shell);
  TopExp_Explorer faces(box, TopAbs_FACE);
  for (faces.Next(); faces.More(); faces.Next()) builder.Add(shell, faces.Current());
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  const Result<Model> model = convert(compound_of({solid, BRepPrimAPI_MakeBox(gp_Pnt(3, 0, 0), 1, 1, 1).Shape()}));
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::open_shell) << model.error().message;
}

TEST(Repair, ABodyThatTouchesItselfAlongAnEdgeIsSewn) {
  const Result<Model> model = convert(bar_that_touches_itself());
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model.value().solids.size(), 1U);
  EXPECT_NEAR(test::total_volume(model.value()), 7, 1e-9);
  test::expect_sound(model.value(), "bar that touches itself");
}

/// A box, and solids that cross a corner of it, run through it, and lie in it.
const TopoDS_Shape& box() {
  static const TopoDS_Shape shape = BRepPrimAPI_MakeBox(4, 4, 4).Shape();
  return shape;
}
std::vector<TopoDS_Shape> intruders() {
  return {BRepPrimAPI_MakeBox(gp_Pnt(3, 3, 3), 4, 4, 4).Shape(), BRepPrimAPI_MakeBox(gp_Pnt(1, 1, -1), 1, 1, 6).Shape(),
          BRepPrimAPI_MakeBox(gp_Pnt(1, 1, 1), 2, 2, 2).Shape()};
}

TEST(Repair, OverlappingSolidsAreSplitOnRequest) {
  const std::vector<double> common{1, 4, 8}, all{127, 66, 64};
  const std::vector<std::size_t> solids{3, 4, 2};
  for (std::size_t i = 0; i < common.size(); ++i) {
    const Result<Model> result = convert(compound_of({box(), intruders()[i]}), Overlaps::split);
    ASSERT_TRUE(result) << i << ": " << result.error().message;
    const Model& model = result.value();
    test::expect_sound(model, "overlapping solids");
    EXPECT_EQ(model.solids.size(), solids[i]);
    EXPECT_NEAR(test::total_volume(model), all[i], 1e-6);
    std::size_t shared = 0;
    for (const ModelSolid& solid : model.solids) {
      if (solid.label.name != "solid_1 & solid_2") continue;
      ++shared;
      EXPECT_NEAR(solid.volume * std::pow(model.frame.length_to_cad(1), 3), common[i], 1e-6);
    }
    EXPECT_EQ(shared, 1U) << i;
  }
}

TEST(Repair, OverlappingSolidsAreRefused) {
  const auto error_of = [](const std::vector<TopoDS_Shape>& solids) {
    const Result<Model> model = convert(compound_of(solids));
    return model ? Error{} : model.error();
  };
  std::vector<TopoDS_Shape> all = intruders();
  all.push_back(BRepPrimAPI_MakeSphere(gp_Pnt(2, 2, 2), 1).Shape());
  for (const TopoDS_Shape& intruder : all) {
    const Error error = error_of({box(), intruder});
    EXPECT_EQ(error.code, ErrorCode::overlapping_solids) << error.message;
    EXPECT_EQ(error.entities, (std::vector<std::string>{"solid 1", "solid 2"}));
    ASSERT_TRUE(error.where.has_value());
  }
}

// No vertex of one bar, and no middle or quarter of an edge, is in the other: only the fuse finds what they have in
// common.
TEST(Repair, CrossedBarsAreRefusedByWhatTheFuseFinds) {
  const TopoDS_Shape one = BRepPrimAPI_MakeBox(10, 1, 1).Shape();
  const TopoDS_Shape two = BRepPrimAPI_MakeBox(gp_Pnt(2.8, 0.2, -3.3), 1, 0.6, 10).Shape();
  const Result<Model> model = convert(compound_of({one, two}));
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::overlapping_solids) << model.error().message;
  EXPECT_EQ(model.error().entities, (std::vector<std::string>{"solid 1", "solid 2"}));
  EXPECT_NE(model.error().message.find("0.6"), std::string::npos) << model.error().message;
  ASSERT_TRUE(model.error().where.has_value());
  EXPECT_NEAR(distance(*model.error().where, {3.3, 0.5, 0.5}), 0, 1e-6);
}

// More solids than are fused at once, in rows that touch on all sides.
TEST(Repair, ManySolidsThatTouchShareTheirContacts) {
  std::vector<TopoDS_Shape> boxes;
  for (int x = 0; x < 6; ++x)
    for (int y = 0; y < 5; ++y)
      for (int z = 0; z < 2; ++z) boxes.push_back(BRepPrimAPI_MakeBox(gp_Pnt(x, y, z), 1, 1, 1).Shape());
  const Result<Model> result = convert(compound_of(boxes));
  ASSERT_TRUE(result) << result.error().message;
  const Model& model = result.value();
  test::expect_sound(model, "boxes that touch");
  EXPECT_EQ(model.solids.size(), 60U);
  EXPECT_EQ(model.faces.size(), 7U * 5 * 2 + 6 * 6 * 2 + 6 * 5 * 3);
  EXPECT_EQ(model.vertices.size(), 7U * 6 * 3);
  EXPECT_NEAR(test::total_volume(model), 60, 1e-9);
}

// Shorter than the tolerances of the solids: the fuse would leave a sliver between them.
TEST(Repair, SolidsThatOverlapByAHairShareTheirContact) {
  for (const double hair : {2e-6, 2e-5, 2e-4}) {
    const TopoDS_Shape other = BRepPrimAPI_MakeBox(gp_Pnt(4 - hair, 1, 1), 2, 2, 2).Shape();
    const Result<Model> result = convert(compound_of({box(), other}));
    ASSERT_TRUE(result) << result.error().message;
    const Model& model = result.value();
    EXPECT_EQ(model.solids.size(), 2U);
    EXPECT_EQ(model.faces.size(), 12U) << "one face is shared, and one of the larger box is split in two";
    EXPECT_NEAR(test::total_volume(model), 72, 1e-2);
  }
}

TEST(Repair, SolidsStayApartOnRequest) {
  Context context;
  ShapeOptions options;
  options.joining.conformal = Conformal::off;
  for (const TopoDS_Shape& other : {BRepPrimAPI_MakeBox(gp_Pnt(4, 1, 1), 2, 2, 2).Shape(), intruders()[0]}) {
    const Result<Model> result = model_from_shape(compound_of({box(), other}), options, context);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result.value().faces.size(), 12U);
  }
}

TEST(Repair, SolidsApartAreNot) {
  EXPECT_TRUE(convert(compound_of({box(), BRepPrimAPI_MakeBox(gp_Pnt(5, 3, 3), 4, 4, 4).Shape()})));
  EXPECT_TRUE(convert(compound_of({box(), BRepPrimAPI_MakeBox(gp_Pnt(4, 1, 1), 2, 2, 2).Shape()}))) << "they touch";
}

}  // namespace
}  // namespace curvetet
