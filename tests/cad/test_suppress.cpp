// Details below a length go on request, and nothing else does.
#include <gtest/gtest.h>

#include <BOPAlgo_Builder.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepFilletAPI_MakeChamfer.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeWedge.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Vertex.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Ax2.hxx>
#include <limits>
#include <set>

#include "cad/body.h"
#include "cad/shape.h"
#include "curvetet/occt.h"
#include "pipeline/pipeline.h"
#include "shapes.h"

namespace curvetet {
namespace {

using Ids = std::set<std::uint32_t>;
using Kind = SuppressedDetail::Kind;

constexpr double kLength = 0.05;

Result<Model> convert(const TopoDS_Shape& shape, Length min_feature) {
  Context context;
  ShapeOptions options;
  options.min_feature = std::move(min_feature);
  return model_from_shape(shape, options, context);
}

Model sound_model(const TopoDS_Shape& shape, double min_feature) {
  Result<Model> model = convert(shape, {min_feature, {}});
  if (!model) {
    ADD_FAILURE() << model.error().message;
    return {};
  }
  test::expect_sound(model.value(), "suppressed below " + std::to_string(min_feature));
  return std::move(model.value());
}

template <class Parts>
Ids ids_of(const Parts& parts) {
  Ids ids;
  for (const auto& part : parts) ids.insert(part.label.cad_id);
  return ids;
}

Ids suppressed(const Model& model, Kind kind) {
  Ids ids;
  for (const SuppressedDetail& detail : model.suppressed)
    if (detail.kind == kind) ids.insert(detail.label.cad_id);
  return ids;
}

bool has_note(const Model& model, const std::string& entity, const std::string& words) {
  return std::any_of(model.healing.begin(), model.healing.end(), [&](const HealingNote& note) {
    return note.entity == entity && note.what.find(words) != std::string::npos;
  });
}

/// A face with this id lies on the same surface before and after.
void expect_same_surfaces(const Model& before, const Model& after) {
  for (const ModelFace& face : after.faces) {
    const auto old = std::find_if(before.faces.begin(), before.faces.end(),
                                  [&](const ModelFace& f) { return f.label.cad_id == face.label.cad_id; });
    ASSERT_NE(old, before.faces.end()) << "face " << face.label.cad_id << " comes from nowhere";
    const Vec2 uv = 0.5 * (old->low + old->high);
    const Vec3 a = before.frame.to_cad(old->surface->value(uv)), b = after.frame.to_cad(face.surface->value(uv));
    EXPECT_LT(distance(a, b), 1e-9) << "face " << face.label.cad_id;
  }
}

/// An edge with this id lies where it lay, or beyond by the length.
void expect_same_curves(const Model& before, const Model& after) {
  constexpr int kSamples = 1000;
  for (const ModelEdge& edge : after.edges) {
    const auto old = std::find_if(before.edges.begin(), before.edges.end(),
                                  [&](const ModelEdge& e) { return e.label.cad_id == edge.label.cad_id; });
    if (old == before.edges.end() || edge.degenerate) continue;
    const Vec3 middle = after.frame.to_cad(edge.curve->value(0.5 * (edge.low + edge.high)));
    double away = std::numeric_limits<double>::infinity();
    for (int i = 0; i <= kSamples; ++i) {
      const double t = old->low + (old->high - old->low) * i / kSamples;
      away = std::min(away, distance(before.frame.to_cad(old->curve->value(t)), middle));
    }
    EXPECT_LT(away, 1e-3) << "edge " << edge.label.cad_id;
  }
}

/// What must hold of every body whose details went: the model, and the mesh, checked against it.
void expect_suppressed(const TopoDS_Shape& shape, const Ids& faces, const Ids& edges, double volume) {
  const Model before = sound_model(shape, 0), after = sound_model(shape, kLength);
  EXPECT_TRUE(before.suppressed.empty());
  EXPECT_EQ(suppressed(after, Kind::face), faces);
  EXPECT_EQ(suppressed(after, Kind::edge), edges);
  Ids left = ids_of(before.faces);
  for (const std::uint32_t id : faces) EXPECT_EQ(left.erase(id), 1U) << "face " << id << " is not there without it";
  EXPECT_EQ(ids_of(after.faces), left);
  for (const std::uint32_t id : edges) {
    EXPECT_TRUE(ids_of(before.edges).contains(id));
    EXPECT_FALSE(ids_of(after.edges).contains(id));
  }
  expect_same_surfaces(before, after);
  expect_same_curves(before, after);
  EXPECT_NEAR(test::total_volume(after), volume, 1e-9);

  Options options;
  options.min_feature = kLength;
  Context context;
  const Result<MeshOutput> made = mesh(shape, options, context);
  ASSERT_TRUE(made) << made.error().message;
  EXPECT_TRUE(made.value().report.valid);
  EXPECT_EQ(made.value().report.suppressed.size(), faces.size() + edges.size());
  EXPECT_NEAR(made.value().report.solids.at(0).volume, volume, 2e-3 * volume);
  Ids meshed;
  for (const Entity& face : made.value().mesh.faces) meshed.insert(face.cad_id);
  EXPECT_EQ(meshed, left);
  for (const Entity& edge : made.value().mesh.edges) EXPECT_FALSE(edges.contains(edge.cad_id));
}

// --- bodies ---

TopoDS_Shape cube() { return BRepPrimAPI_MakeBox(1, 1, 1).Shape(); }

TopoDS_Shape chamfered_cube(double side) {
  const TopoDS_Shape body = cube();
  BRepFilletAPI_MakeChamfer chamfer(body);
  chamfer.Add(side, TopoDS::Edge(TopExp_Explorer(body, TopAbs_EDGE).Current()));
  return chamfer.Shape();
}

TopoDS_Shape cube_with_chamfers_along_z(double side) {
  const TopoDS_Shape body = cube();
  BRepFilletAPI_MakeChamfer chamfer(body);
  for (TopExp_Explorer it(body, TopAbs_EDGE); it.More(); it.Next()) {
    const TopoDS_Edge edge = TopoDS::Edge(it.Current());
    const gp_Pnt a = BRep_Tool::Pnt(TopExp::FirstVertex(edge)), b = BRep_Tool::Pnt(TopExp::LastVertex(edge));
    if (std::abs(a.Z() - b.Z()) > 0.5 && chamfer.Contour(edge) == 0) chamfer.Add(side, edge);
  }
  return chamfer.Shape();
}

/// A cube whose edge along x at y = 0, z = 1 has more vertices.
TopoDS_Shape cube_with_split_edge(const std::vector<double>& at) {
  BOPAlgo_Builder builder;
  builder.AddArgument(cube());
  for (const double x : at) builder.AddArgument(BRepBuilderAPI_MakeVertex(gp_Pnt(x, 0, 1)).Vertex());
  builder.Perform();
  return TopExp_Explorer(builder.Shape(), TopAbs_SOLID).Current();
}

TopoDS_Shape cube_with_bore(double radius, double depth) {
  const gp_Ax2 axis(gp_Pnt(0.4, 0.6, 1 - depth), gp_Dir(0, 0, 1));
  return BRepAlgoAPI_Cut(cube(), BRepPrimAPI_MakeCylinder(axis, radius, depth + 1).Shape()).Shape();
}

TopoDS_Shape cube_with_bump(double side) {
  return BRepAlgoAPI_Fuse(cube(), BRepPrimAPI_MakeBox(gp_Pnt(0.4, 0.6, 0.9), side, side, 0.1 + side).Shape()).Shape();
}

TopoDS_Shape cube_with_groove(double width) {
  return BRepAlgoAPI_Cut(cube(), BRepPrimAPI_MakeBox(gp_Pnt(0.5, -1, 0.7), width, 3, 1).Shape()).Shape();
}

Ids edges_shorter(const TopoDS_Shape& shape, double length) {
  const Model model = sound_model(shape, 0);
  Ids ids;
  for (const ModelEdge& edge : model.edges) {
    if (edge.degenerate) continue;
    const double own = distance(edge.curve->value(edge.low), edge.curve->value(edge.high));
    if (model.frame.length_to_cad(own) < length) ids.insert(edge.label.cad_id);
  }
  return ids;
}

Ids faces_smaller(const TopoDS_Shape& shape, double area) {
  const Model model = sound_model(shape, 0);
  Ids ids;
  for (const ModelFace& face : model.faces)
    if (face.area / std::pow(model.frame.scale, 2) < area) ids.insert(face.label.cad_id);
  return ids;
}

// --- tests ---

TEST(Suppress, AStripGoesAndItsNeighboursMeet) {
  const TopoDS_Shape body = chamfered_cube(0.01);
  const Ids strip = faces_smaller(body, 0.1);
  ASSERT_EQ(strip.size(), 1U);
  expect_suppressed(body, strip, {}, 1);
  const Model after = sound_model(body, kLength);
  EXPECT_EQ(after.vertices.size(), 8U);
  EXPECT_NEAR(after.suppressed.at(0).size, 0.01 * std::sqrt(2), 1e-9);
}

// The edges that take the place of strips get no id that the input gave to another edge.
TEST(Suppress, NoIdIsGivenTwice) {
  const TopoDS_Shape body = cube_with_chamfers_along_z(0.01);
  const Ids strips = faces_smaller(body, 0.1);
  ASSERT_EQ(strips.size(), 4U);
  expect_suppressed(body, strips, {}, 1);
  const Ids before = ids_of(sound_model(body, 0).edges);
  Ids made;
  for (const std::uint32_t id : ids_of(sound_model(body, kLength).edges))
    if (!before.contains(id)) made.insert(id);
  EXPECT_EQ(made.size(), 4U);
  EXPECT_GT(*made.begin(), *before.rbegin());
}

TEST(Suppress, TheIdOfWhatWentIsNotGivenAgain) {
  CadBody body;
  body.shape = test::make_box_with_core();
  label_all(body);
  const TopTools_IndexedMapOfShape solids = sub_shapes(body.shape, TopAbs_SOLID);
  const auto itself = [](const TopoDS_Shape& part) { return part; };
  replace_shape(body, solids(1), itself);
  replace_shape(body, cube(), itself);
  ASSERT_EQ(body.solids.size(), 1U);
  EXPECT_EQ(body.solids.front().cad_id, 3U);
}

TEST(Suppress, AShortEdgeBecomesAVertex) {
  const TopoDS_Shape body = cube_with_split_edge({0.5, 0.505});
  const Ids edge = edges_shorter(body, kLength);
  ASSERT_EQ(edge.size(), 1U);
  expect_suppressed(body, {}, edge, 1);
  const Model after = sound_model(body, kLength);
  EXPECT_EQ(after.vertices.size(), 9U);
  EXPECT_NEAR(after.suppressed.at(0).size, 0.005, 1e-9);
}

// The corner must stay where three faces meet.
TEST(Suppress, AShortEdgeAtACornerLeavesTheCorner) {
  const TopoDS_Shape body = cube_with_split_edge({0.005});
  expect_suppressed(body, {}, edges_shorter(body, kLength), 1);
  const Model after = sound_model(body, kLength);
  EXPECT_TRUE(std::any_of(after.vertices.begin(), after.vertices.end(), [&](const ModelVertex& vertex) {
    return distance(after.frame.to_cad(vertex.point), {0, 0, 1}) < 1e-9;
  }));
}

// As a whole they are no detail: what goes stays below the length.
TEST(Suppress, AChainOfShortEdgesDoesNotVanish) {
  std::vector<double> at;
  for (int i = 1; i < 10; ++i) at.push_back(0.1 + 0.01 * i);
  const TopoDS_Shape body = cube_with_split_edge(at);
  const Model after = sound_model(body, kLength);
  EXPECT_FALSE(after.suppressed.empty());
  EXPECT_LT(suppressed(after, Kind::edge).size(), edges_shorter(body, kLength).size());
  EXPECT_NEAR(test::total_volume(after), 1, 1e-9);
  for (const ModelVertex& vertex : after.vertices) EXPECT_LE(after.frame.length_to_cad(vertex.tolerance), kLength);
}

TEST(Suppress, ABlindBoreIsFilled) {
  const TopoDS_Shape body = cube_with_bore(0.01, 0.02);
  const Ids bore = faces_smaller(body, 0.1);
  ASSERT_EQ(bore.size(), 2U);
  expect_suppressed(body, bore, {}, 1);
}

TEST(Suppress, ABoreThroughIsFilled) {
  const TopoDS_Shape body = cube_with_bore(0.01, 2);
  const Ids bore = faces_smaller(body, 0.1);
  ASSERT_EQ(bore.size(), 1U);
  expect_suppressed(body, bore, {}, 1);
}

TEST(Suppress, ABumpIsTakenOff) {
  const TopoDS_Shape body = cube_with_bump(0.02);
  const Ids bump = faces_smaller(body, 0.1);
  ASSERT_EQ(bump.size(), 5U);
  expect_suppressed(body, bump, {}, 1);
}

TEST(Suppress, WhatIsLargerStays) {
  for (const TopoDS_Shape& body : {chamfered_cube(0.1), cube_with_split_edge({0.3, 0.4}), cube_with_bore(0.1, 0.2),
                                   cube_with_bump(0.1), test::make_bracket()}) {
    const Model before = sound_model(body, 0), after = sound_model(body, kLength);
    EXPECT_TRUE(after.suppressed.empty());
    EXPECT_EQ(after.healing.size(), before.healing.size());
  }
}

// The walls of a groove are parallel: they meet nowhere without its ground.
TEST(Suppress, WhatCannotGoStaysAsItWasAndIsTold) {
  const TopoDS_Shape body = cube_with_groove(0.02);
  const Model before = sound_model(body, 0), after = sound_model(body, kLength);
  EXPECT_TRUE(after.suppressed.empty());
  EXPECT_EQ(ids_of(after.faces), ids_of(before.faces));
  EXPECT_EQ(ids_of(after.edges), ids_of(before.edges));
  const Ids ground = faces_smaller(body, 0.1);
  ASSERT_EQ(ground.size(), 1U);
  EXPECT_TRUE(has_note(after, "face " + std::to_string(*ground.begin()), "left"));
  for (const std::uint32_t id : edges_shorter(body, kLength))
    EXPECT_TRUE(has_note(after, "edge " + std::to_string(id), "left")) << id;
  EXPECT_NEAR(test::total_volume(after), 1 - 0.02 * 0.3, 1e-9);
}

// Its sides would meet two tenths farther out.
TEST(Suppress, ABluntTipThatWouldGrowStays) {
  const TopoDS_Shape body = BRepPrimAPI_MakeWedge(1, 10, 1, 0.02).Shape();
  const Model before = sound_model(body, 0), after = sound_model(body, kLength);
  EXPECT_TRUE(after.suppressed.empty());
  const Ids tip = faces_smaller(body, 0.1);
  ASSERT_EQ(tip.size(), 1U);
  EXPECT_TRUE(has_note(after, "face " + std::to_string(*tip.begin()), "more than the length"));
  EXPECT_EQ(test::total_volume(after), test::total_volume(before));
}

// One detail that stays must not keep others.
TEST(Suppress, DetailsAreJudgedOneByOne) {
  const gp_Ax2 axis(gp_Pnt(0.2, 0.6, 0.98), gp_Dir(0, 0, 1));
  const TopoDS_Shape body =
      BRepAlgoAPI_Cut(cube_with_groove(0.02), BRepPrimAPI_MakeCylinder(axis, 0.01, 1).Shape()).Shape();
  const Model after = sound_model(body, kLength);
  EXPECT_EQ(suppressed(after, Kind::face).size(), 2U);
  EXPECT_NEAR(test::total_volume(after), 1 - 0.02 * 0.3, 1e-9);
}

TEST(Suppress, PartsThatArePlacedKeepTheirPlace) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  gp_Trsf there;
  there.SetTranslation(gp_Vec(5, 6, 7));
  const TopoDS_Shape part = cube_with_split_edge({0.5, 0.505});
  builder.Add(compound, part);
  builder.Add(compound, part.Moved(TopLoc_Location(there)));
  builder.Add(compound, chamfered_cube(0.01).Moved(TopLoc_Location(there * there)));
  const Model before = sound_model(compound, 0), after = sound_model(compound, kLength);
  EXPECT_EQ(suppressed(after, Kind::edge).size(), 2U);
  EXPECT_EQ(suppressed(after, Kind::face).size(), 1U);
  EXPECT_EQ(ids_of(after.solids), ids_of(before.solids));
  EXPECT_NEAR(test::total_volume(after), 3, 1e-9);
  EXPECT_LT(distance(before.frame.to_cad(before.box.low), after.frame.to_cad(after.box.low)), 1e-9);
  EXPECT_LT(distance(before.frame.to_cad(before.box.high), after.frame.to_cad(after.box.high)), 1e-9);
}

TEST(Suppress, NothingChangesWhereNothingIsSuppressed) {
  struct Asked {
    TopoDS_Shape body;
    double length = 1e-3;
  };
  for (const auto& [body, length] : {Asked{test::make_bracket()}, Asked{test::make_box_with_core()},
                                     Asked{chamfered_cube(0.01)}, Asked{cube_with_groove(0.02), kLength}}) {
    Options plain, asked;
    asked.min_feature = length;
    Context context;
    const Result<MeshOutput> one = mesh(body, plain, context), other = mesh(body, asked, context);
    ASSERT_TRUE(one && other);
    EXPECT_TRUE(other.value().report.suppressed.empty());
    EXPECT_EQ(one.value().report.mesh_hash, other.value().report.mesh_hash);
    EXPECT_EQ(one.value().mesh.points, other.value().mesh.points);
  }
}

TEST(Suppress, TheLengthIsInItsOwnUnit) {
  const TopoDS_Shape body = chamfered_cube(0.01);  // in mm, and 14 um wide
  EXPECT_TRUE(sound_model(body, 0.014).suppressed.empty());
  const Result<Model> below = convert(body, {14, "um"}), above = convert(body, {15, "um"});
  ASSERT_TRUE(below && above);
  EXPECT_TRUE(below.value().suppressed.empty());
  EXPECT_EQ(above.value().suppressed.size(), 1U);
}

TEST(Suppress, AbsurdLengthsAreRefused) {
  for (const double length :
       {-1.0, 0.2, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    const Result<Model> model = convert(cube(), {length, {}});
    ASSERT_FALSE(model) << length;
    EXPECT_EQ(model.error().code, ErrorCode::bad_option) << model.error().message;
  }
}

}  // namespace
}  // namespace curvetet
