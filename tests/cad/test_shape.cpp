// Shapes in memory become sound models, with the kernel's own numbers.
#include <gtest/gtest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeHalfSpace.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_Surface.hxx>
#include <ShapeBuild_ReShape.hxx>
#include <ShapeCustom.hxx>
#include <Standard_Failure.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "cad/cells.h"
#include "cad/occt_geometry.h"
#include "cad/shape.h"
#include "shapes.h"
#include "support/occt_shapes.h"

namespace curvetet {
namespace {

constexpr double kPi = std::numbers::pi;

Result<Model> convert(const TopoDS_Shape& shape) {
  Context context;
  return model_from_shape(shape, ShapeOptions{}, context);
}

struct Named {
  const char* name;
  TopoDS_Shape shape;
};

std::vector<Named> shapes() {
  const gp_Ax2 tilted(gp_Pnt(3, -2, 7), gp_Dir(1, 2, 3));
  std::vector<Named> all{{"box", BRepPrimAPI_MakeBox(1, 2, 3).Shape()},
                         {"ball", BRepPrimAPI_MakeSphere(tilted, 5).Shape()},
                         {"half ball", BRepPrimAPI_MakeSphere(tilted, 5, 0, kPi / 2, kPi).Shape()},
                         {"cylinder", BRepPrimAPI_MakeCylinder(tilted, 2, 5).Shape()},
                         {"cone", BRepPrimAPI_MakeCone(tilted, 3, 0, 5).Shape()},
                         {"frustum", BRepPrimAPI_MakeCone(tilted, 3, 1, 5).Shape()},
                         {"torus", BRepPrimAPI_MakeTorus(tilted, 10, 3).Shape()},
                         {"piece of torus", BRepPrimAPI_MakeTorus(tilted, 10, 3, 1.5).Shape()},
                         {"bracket", test::make_bracket()},
                         {"box with core", test::make_box_with_core()}};
  const std::size_t analytic = all.size();
  for (std::size_t i = 0; i < analytic; ++i) {
    all.push_back({all[i].name, BRepBuilderAPI_NurbsConvert(all[i].shape).Shape()});
    gp_Trsf mirror;
    mirror.SetMirror(gp_Ax2(gp_Pnt(1, 1, 1), gp_Dir(3, 1, 1)));
    all.push_back({all[i].name, BRepBuilderAPI_Transform(all[i].shape, mirror).Shape()});
    gp_Trsf move;
    move.SetRotation(gp_Ax1(gp_Pnt(9, 0, 0), gp_Dir(1, 1, 0)), 0.7);
    all.push_back({all[i].name, all[i].shape.Moved(TopLoc_Location(move))});
  }
  return all;
}

TEST(Shapes, BecomeSoundModels) {
  for (const Named& named : shapes()) {
    const Result<Model> model = convert(named.shape);
    ASSERT_TRUE(model) << named.name << ": " << model.error().message;
    test::expect_sound(model.value(), named.name);
    GProp_GProps volume, area;
    BRepGProp::VolumeProperties(named.shape, volume, 1e-7);
    BRepGProp::SurfaceProperties(named.shape, area, true);
    EXPECT_NEAR(test::total_volume(model.value()), std::abs(volume.Mass()), 1e-4 * std::abs(volume.Mass()))
        << named.name;
    EXPECT_NEAR(test::total_area(model.value()), area.Mass(), 1e-4 * area.Mass()) << named.name;
  }
}

/// Every surface evaluates to the kernel's own values, parameter by parameter.
TEST(Shapes, KeepTheParametrisation) {
  std::mt19937 random(7);
  for (const Named& named : shapes()) {
    const Result<Model> result = convert(named.shape);
    ASSERT_TRUE(result);
    const Model& model = result.value();
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(named.shape, TopAbs_FACE, faces);
    for (const ModelFace& face : model.faces) {
      const Handle(Geom_Surface) surface = BRep_Tool::Surface(TopoDS::Face(faces(static_cast<int>(face.label.cad_id))));
      std::uniform_real_distribution<double> u(face.low.x, face.high.x), v(face.low.y, face.high.y);
      for (int i = 0; i < 5; ++i) {
        const Vec2 uv{u(random), v(random)};
        const gp_Pnt p = surface->Value(uv.x, uv.y);
        const Vec3 ours = model.frame.to_cad(face.surface->value(uv));
        EXPECT_LT(distance(ours, {p.X(), p.Y(), p.Z()}), 1e-9 * (1 + model.frame.length_to_cad(1))) << named.name;
        EXPECT_EQ(face.surface->value(uv), face.surface->clone()->value(uv));
      }
    }
  }
}

/// A bowl between two planes under r^2 = 36 + 7.2 z.
TopoDS_Shape make_paraboloid(double height) {
  const gp_Ax2 axes(gp_Pnt(0, 0, -5), gp_Dir(0, -1, 0), gp_Dir(0, 0, 1));
  const Handle(Geom_Parabola) profile = new Geom_Parabola(axes, 1.8);
  const double low = -6, high = -std::sqrt(36 + 7.2 * height);
  const gp_Pnt bottom = profile->Value(low), top = profile->Value(high);
  const gp_Pnt over(0, 0, top.Z()), under(0, 0, bottom.Z());
  BRepBuilderAPI_MakeWire wire;
  wire.Add(BRepBuilderAPI_MakeEdge(profile, high, low).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(top, over).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(over, under).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(under, bottom).Edge());
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(wire.Wire()).Face();
  return BRepPrimAPI_MakeRevol(face, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape();
}

// The kernel's plain rule gives 22814 for the second, as B-splines, and its adaptive one, less strict, 22606 for the
// first.
TEST(ModelFromShape, VolumesAreExactWhateverTheSurfaces) {
  const TopoDS_Shape paraboloid = make_paraboloid(40);
  for (const TopoDS_Shape& shape : {paraboloid, BRepBuilderAPI_NurbsConvert(paraboloid, true).Shape()}) {
    auto model = convert(shape);
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_NEAR(test::total_volume(model.value()), kPi / 2 * 40 * (36 + 324), 1);
  }
}

/// Closed, around the origin, through five points.
Handle(Geom_BSplineCurve) make_star() {
  std::vector<gp_Pnt> points;
  for (const double radius : {0.4, 0.9, 0.5, 1.0, 0.6}) {
    const double angle = 2 * kPi * static_cast<double>(points.size()) / 5;
    points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  return test::spline_through(points, true);
}

// The kernel's adaptive rule is off by a tenth.
TEST(ModelFromShape, VolumesOfPrismsOnSplinesAreExact) {
  const Handle(Geom_BSplineCurve) star = make_star();
  double twice_area = 0;
  constexpr int kSteps = 100000;
  const double step = (star->LastParameter() - star->FirstParameter()) / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const gp_Pnt p = star->Value(star->FirstParameter() + i * step),
                 q = star->Value(star->FirstParameter() + (i + 1) * step);
    twice_area += p.X() * q.Y() - p.Y() * q.X();
  }
  const TopoDS_Face base =
      BRepBuilderAPI_MakeFace(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(star)).Wire()).Face();
  auto model = convert(BRepPrimAPI_MakePrism(base, gp_Vec(0, 0, 2)).Shape());
  ASSERT_TRUE(model.ok()) << model.error().message;
  EXPECT_NEAR(test::total_volume(model.value()), twice_area, 1e-4 * twice_area);
}

// A projection on its way may come to where a spline's normal overflows; the kernel throws there.
TEST(MakeSurface, AnOffsetThatIsNotDefinedIsNoNumber) {
  const Handle(Geom_Surface) splines = GeomConvert::SurfaceToBSplineSurface(
      new Geom_RectangularTrimmedSurface(new Geom_ConicalSurface(gp_Ax3(), 0.4, 1), 0.0, 2.0, 0.0, 1.0));
  const Handle(Geom_Surface) offset = new Geom_OffsetSurface(splines, 0.1);
  const Vec2 far{-1e6, 0.5};
  EXPECT_THROW(offset->Value(far.x, far.y), Standard_Failure);
  const auto surface = make_surface(offset, Frame{});
  EXPECT_FALSE(finite(surface->value(far)));
  EXPECT_FALSE(finite(surface->first(far).value));
  EXPECT_FALSE(finite(surface->second(far).value));
  EXPECT_FALSE(surface->project({1, 1, 1}, far));
}

/// The outward normals, integrated over the trimmed faces, give each solid's volume: orientation and sides are right.
TEST(Shapes, SharedFacesHaveASolidOnEachSide) {
  const Result<Model> result = convert(test::make_box_with_core());
  ASSERT_TRUE(result);
  const Model& model = result.value();
  ASSERT_EQ(model.solids.size(), 2U);
  std::size_t shared = 0;
  for (const ModelFace& face : model.faces) {
    EXPECT_TRUE(face.back.valid());
    EXPECT_NE(face.back, face.front);
    shared += face.front.valid() ? 1 : 0;
  }
  EXPECT_EQ(shared, 1U);
  std::vector<double> volumes;
  for (const ModelSolid& solid : model.solids) volumes.push_back(solid.volume / std::pow(model.frame.scale, 3));
  std::sort(volumes.begin(), volumes.end());
  EXPECT_NEAR(volumes[0], 40 * kPi, 1e-3);
  EXPECT_NEAR(volumes[1], 1000 - 40 * kPi, 1e-3);
}

TEST(Shapes, InsideOutSolidsAreTurned) {
  TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 2, 3).Shape();
  box.Reverse();
  const Result<Model> model = convert(box);
  ASSERT_TRUE(model);
  test::expect_sound(model.value(), "reversed box");
  EXPECT_NEAR(test::total_volume(model.value()), 6, 1e-9);
  ASSERT_FALSE(model.value().healing.empty());
  EXPECT_NE(model.value().healing.front().what.find("inside out"), std::string::npos);
  for (const ModelFace& face : model.value().faces) {
    const Vec2 middle = 0.5 * (face.low + face.high);
    const Vec3 outward = (face.reversed ? -1.0 : 1.0) * face.surface->normal(middle);
    EXPECT_GT(dot(outward, face.surface->value(middle)), 0) << "the box is centred on the origin of its frame";
  }
}

TEST(Shapes, InstancesAreDistinct) {
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(1).Shape();
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (int i = 0; i < 3; ++i) {
    gp_Trsf move;
    move.SetTranslation(gp_Vec(3.0 * i, 0, 0));
    builder.Add(compound, ball.Moved(TopLoc_Location(move)));
  }
  const Result<Model> model = convert(compound);
  ASSERT_TRUE(model);
  EXPECT_EQ(model.value().solids.size(), 3U);
  EXPECT_EQ(model.value().faces.size(), 3U);
  test::expect_sound(model.value(), "three balls");
}

TopoDS_Compound loose_faces(const TopoDS_Shape& shape, int without) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  int i = 0;
  for (TopExp_Explorer face(BRepBuilderAPI_NurbsConvert(shape, true).Shape(), TopAbs_FACE); face.More(); face.Next()) {
    if (++i != without) builder.Add(compound, face.Current());
  }
  return compound;
}

Vec3 centre_of(const TopoDS_Shape& face) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  const gp_Pnt centre = properties.CentreOfMass();
  return {centre.X(), centre.Y(), centre.Z()};
}

TEST(Shapes, LooseFacesAreSewn) {
  const TopoDS_Compound faces = loose_faces(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), 0);
  const Result<Model> model = convert(faces);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model.value().solids.size(), 1U);
  EXPECT_NEAR(test::total_volume(model.value()), 6, 1e-9);
  test::expect_sound(model.value(), "sewn box");
  TopTools_IndexedMapOfShape input;
  TopExp::MapShapes(faces, TopAbs_FACE, input);
  for (const ModelFace& face : model.value().faces) {
    const Vec3 here = model.value().frame.to_cad(face.surface->value(0.5 * (face.low + face.high)));
    EXPECT_LT(distance(here, centre_of(input(static_cast<int>(face.label.cad_id)))), 1e-6) << "ids follow the faces";
  }
}

TEST(Shapes, AnOpenShellIsAnError) {
  const Result<Model> model = convert(loose_faces(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), 2));
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::open_shell);
  EXPECT_NE(model.error().message.find("4 free edges"), std::string::npos) << model.error().message;
  EXPECT_TRUE(model.error().where.has_value());
  EXPECT_FALSE(model.error().entities.empty());
}

TEST(Shapes, FacesOutsideOfSolidsAreLeftOut) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  const TopoDS_Shape loose = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  builder.Add(compound, TopExp_Explorer(loose, TopAbs_FACE).Current());
  builder.Add(compound, BRepPrimAPI_MakeBox(gp_Pnt(5, 5, 5), 1, 2, 3).Shape());
  const Result<Model> model = convert(compound);
  ASSERT_TRUE(model);
  EXPECT_EQ(model.value().faces.size(), 6U);
  EXPECT_EQ(model.value().faces[FaceId(0)].label.cad_id, 2U) << "ids are those of the input shape";
  EXPECT_TRUE(std::any_of(model.value().healing.begin(), model.value().healing.end(),
                          [](const HealingNote& note) { return note.is_warning; }));
}

TEST(Shapes, VoidsAndNestedShells) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const double radius : {3.0, 1.0, 2.0}) {
    const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(radius).Shape();
    builder.Add(compound, TopExp_Explorer(ball, TopAbs_FACE).Current());
  }
  const Result<Model> model = convert(compound);
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model.value().solids.size(), 2U) << "a ball in a hollow ball";
  EXPECT_NEAR(test::total_volume(model.value()), 4.0 / 3 * kPi * (27 - 8 + 1), 1e-3);
}

TopoDS_Compound compound_of(std::initializer_list<TopoDS_Shape> shapes) {
  TopoDS_Compound compound;
  BRep_Builder builder;
  builder.MakeCompound(compound);
  for (const TopoDS_Shape& shape : shapes) builder.Add(compound, shape);
  return compound;
}

std::size_t shared_faces(const Model& model) {
  return static_cast<std::size_t>(std::count_if(model.faces.begin(), model.faces.end(), [](const ModelFace& face) {
    return face.front.valid() && face.back.valid() && face.front != face.back;
  }));
}

bool has_note(const Model& model, const std::string& words) {
  return std::any_of(model.healing.begin(), model.healing.end(),
                     [&](const HealingNote& note) { return note.what.find(words) != std::string::npos; });
}

TEST(Shapes, SolidsThatTouchShareFaces) {
  const TopoDS_Shape below = BRepPrimAPI_MakeBox(10, 10, 10).Shape();
  const TopoDS_Shape above = BRepPrimAPI_MakeBox(gp_Pnt(2, 2, 10), 6, 6, 5).Shape();
  const Result<Model> result = convert(compound_of({below, above}));
  ASSERT_TRUE(result) << result.error().message;
  const Model& model = result.value();
  test::expect_sound(model, "box on a box");
  EXPECT_EQ(model.solids.size(), 2U);
  EXPECT_EQ(model.faces.size(), 12U);
  EXPECT_EQ(shared_faces(model), 1U);
  EXPECT_NEAR(test::total_volume(model), 1180, 1e-9);
  std::set<std::uint32_t> faces, edges;
  for (const ModelFace& face : model.faces) faces.insert(face.label.cad_id);
  for (const ModelEdge& edge : model.edges) edges.insert(edge.label.cad_id);
  EXPECT_EQ(faces.size(), model.faces.size()) << "an id names one face";
  EXPECT_EQ(edges.size(), model.edges.size()) << "an id names one edge";
  EXPECT_TRUE(has_note(model, "coincides with face"));
  EXPECT_TRUE(has_note(model, "is split in 2"));
}

/// As some exporters write cylinders; their seams do not match either.
TEST(Shapes, SolidsThatTouchInSweptCylindersShareThem) {
  const gp_Ax2 axis(gp_Pnt(-5, 0, 0), gp_Dir(1, 0, 0), gp_Dir(0, 1, 0));
  const gp_Ax2 turned(gp_Pnt(-5, 0, 0), gp_Dir(1, 0, 0), gp_Dir(0, 0, 1));
  const TopoDS_Shape rod = BRepPrimAPI_MakeCylinder(axis, 1, 10).Shape();
  const TopoDS_Shape bore = BRepPrimAPI_MakeCylinder(turned, 1, 10).Shape();
  const TopoDS_Shape nut = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(0, -2, -2), 1, 4, 4).Shape(), bore).Shape();
  const Result<Model> result =
      convert(compound_of({ShapeCustom::ConvertToRevolution(rod), ShapeCustom::ConvertToRevolution(nut)}));
  ASSERT_TRUE(result) << result.error().message;
  const Model& model = result.value();
  test::expect_sound(model, "rod in a nut");
  ASSERT_EQ(model.solids.size(), 2U);
  EXPECT_GE(shared_faces(model), 1U);
  EXPECT_NEAR(test::total_volume(model), 10 * kPi + 16 - kPi, 1e-3);
  double shared = 0;
  for (const ModelFace& face : model.faces) shared += face.front.valid() ? face.area : 0;
  EXPECT_NEAR(shared / std::pow(model.frame.scale, 2), 2 * kPi, 1e-3);
}

CadBody body_of(const TopoDS_Shape& shape) {
  CadBody body;
  body.shape = shape;
  label_all(body);
  return body;
}

std::size_t faces_used_twice(const TopoDS_Shape& shape) {
  TopTools_IndexedMapOfShape faces;
  std::size_t twice = 0;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
    for (TopExp_Explorer face(solid.Current(), TopAbs_FACE); face.More(); face.Next()) {
      const int known = faces.Extent();
      twice += faces.Add(face.Current()) <= known ? 1 : 0;
    }
  }
  return twice;
}

/// Four faces meet where the bores of two plates meet, and nothing says which two are of one plate.
TEST(Shapes, LooseFacesOfSolidsThatTouch) {
  const TopoDS_Shape bore = BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 5, -5), gp_Dir(0, 0, 1)), 1, 20).Shape();
  const TopoDS_Shape below = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(10, 10, 2).Shape(), bore).Shape();
  const TopoDS_Shape above = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 2), 10, 10, 1).Shape(), bore).Shape();
  const TopoDS_Compound faces = loose_faces(compound_of({below, above}), 0);
  CadBody body = body_of(faces);
  ASSERT_TRUE(enclose_solids(body));
  EXPECT_EQ(body.solids.size(), 2U);
  EXPECT_EQ(body.faces.size(), 13U);
  EXPECT_EQ(faces_used_twice(body.shape), 1U);
  const Result<Model> result = convert(faces);
  ASSERT_TRUE(result) << result.error().message;
  test::expect_sound(result.value(), "loose plates");
  EXPECT_EQ(result.value().solids.size(), 2U);
  EXPECT_EQ(shared_faces(result.value()), 1U);
}

TEST(Shapes, AVoidBetweenSolidsThatTouchIsNoSolid) {
  const TopoDS_Shape hollow = BRepPrimAPI_MakeBox(gp_Pnt(3, 3, 5), 4, 4, 5).Shape();
  const TopoDS_Shape below = BRepAlgoAPI_Cut(BRepPrimAPI_MakeBox(10, 10, 10).Shape(), hollow).Shape();
  const TopoDS_Shape lid = BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 10), 10, 10, 5).Shape();
  CadBody body = body_of(loose_faces(compound_of({below, lid}), 0));
  ASSERT_TRUE(enclose_solids(body));
  EXPECT_EQ(body.solids.size(), 2U);
  EXPECT_EQ(faces_used_twice(body.shape), 1U);
  const Result<Model> result = convert(body.shape);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_NEAR(test::total_volume(result.value()), 1500 - 80, 1e-6);
}

TEST(Shapes, LooseFacesWithAGapEncloseNothing) {
  CadBody body = body_of(loose_faces(BRepPrimAPI_MakeBox(1, 2, 3).Shape(), 2));
  EXPECT_FALSE(enclose_solids(body));
  EXPECT_EQ(body.faces.size(), 5U) << "the body is left as it was";
}

/// By more they are refused.
TEST(Shapes, SolidsThatOverlapByAHairAreJoined) {
  const TopoDS_Shape one = BRepPrimAPI_MakeBox(10, 10, 10).Shape();
  const TopoDS_Shape two = BRepPrimAPI_MakeBox(gp_Pnt(5, 5, 9.999), 10, 10, 10).Shape();
  const Result<Model> model = convert(compound_of({one, two}));
  ASSERT_TRUE(model) << model.error().message;
  EXPECT_EQ(model.value().solids.size(), 2U);
  EXPECT_EQ(shared_faces(model.value()), 1U);
  EXPECT_TRUE(has_note(model.value(), "overlap by a hair"));
}

/// One solid of two boxes that touch along an edge: its ends are shared, the edge itself is not.
TopoDS_Shape boxes_edge_to_edge() {
  const TopoDS_Shape one = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  const TopoDS_Shape two = BRepPrimAPI_MakeBox(gp_Pnt(1, 1, 0), 1, 1, 1).Shape();
  TopTools_IndexedMapOfShape ours, theirs;
  TopExp::MapShapes(one, TopAbs_VERTEX, ours);
  TopExp::MapShapes(two, TopAbs_VERTEX, theirs);
  const Handle(ShapeBuild_ReShape) join = new ShapeBuild_ReShape();
  for (int i = 1; i <= ours.Extent(); ++i) {
    for (int k = 1; k <= theirs.Extent(); ++k) {
      const TopoDS_Vertex &a = TopoDS::Vertex(ours(i)), &b = TopoDS::Vertex(theirs(k));
      if (BRep_Tool::Pnt(a).Distance(BRep_Tool::Pnt(b)) < 1e-9) {
        join->Replace(b.Oriented(TopAbs_FORWARD), a.Oriented(TopAbs_FORWARD));
      }
    }
  }
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  for (const TopoDS_Shape& box : {one, join->Apply(two)}) {
    for (TopExp_Explorer face(box, TopAbs_FACE); face.More(); face.Next()) builder.Add(shell, face.Current());
  }
  TopoDS_Solid solid;
  builder.MakeSolid(solid);
  builder.Add(solid, shell);
  return solid;
}

TEST(Shapes, EdgesInOnePlaceAreKeptApartByAHair) {
  const Result<Model> result = convert(boxes_edge_to_edge());
  ASSERT_TRUE(result) << result.error().message;
  const Model& model = result.value();
  test::expect_sound(model, "boxes edge to edge");
  EXPECT_TRUE(has_note(model, "without sharing it"));
  std::size_t twins = 0;
  for (const ModelEdge& edge : model.edges) {
    if (!edge.twin.valid()) continue;
    ++twins;
    const ModelEdge& other = model.edges[edge.twin];
    for (const double s : {0.0, 0.3, 0.5, 1.0}) {
      const double t = other.low + s * (other.high - other.low);
      const Vec3 aside = edge.curve->value(edge.twin_shift + edge.twin_scale * t) - other.curve->value(t);
      EXPECT_LT(norm(aside), 1e-6 * model.diagonal());
      EXPECT_EQ(norm(aside) > 1e-8 * model.diagonal(), s > 0 && s < 1) << "the ends are shared";
      // Into its own box, which is above the other one in x and y, or below.
      EXPECT_GE(aside.x * aside.y, -1e-20);
    }
  }
  EXPECT_EQ(twins, 1U);
}

TEST(Shapes, WhatCannotBeMeshedIsAnError) {
  const auto code = [](const TopoDS_Shape& shape) {
    const Result<Model> model = convert(shape);
    return model ? ErrorCode::internal : model.error().code;
  };
  EXPECT_EQ(code(TopoDS_Shape()), ErrorCode::no_faces);
  EXPECT_EQ(code(TopExp_Explorer(BRepPrimAPI_MakeBox(1, 1, 1).Shape(), TopAbs_EDGE).Current()), ErrorCode::no_faces);
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(1, 1, 1).Shape();
  const TopoDS_Face face = TopoDS::Face(TopExp_Explorer(box, TopAbs_FACE).Current());
  EXPECT_EQ(code(face), ErrorCode::open_shell);
  const ErrorCode half_space = code(BRepPrimAPI_MakeHalfSpace(face, gp_Pnt(9, 9, 9)).Shape());
  EXPECT_EQ(exit_code(half_space), 3) << name(half_space);
}

TEST(Shapes, CancelledBeforeItBegins) {
  Context context;
  context.cancel();
  const Result<Model> model = model_from_shape(test::make_bracket(), ShapeOptions{}, context);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::cancelled);
}

}  // namespace
}  // namespace curvetet
