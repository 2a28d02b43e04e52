// What a failed run leaves, and that the state in it fails again in the same way.
#include "pipeline/dossier.h"

#include <gtest/gtest.h>

#include <BRepBuilderAPI_MakeVertex.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Solid.hxx>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "boundary/boundary_mesh.h"
#include "curvetet/formats.h"
#include "curvetet/occt.h"
#include "pipeline/replay.h"
#include "pipeline/spot.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

namespace fs = std::filesystem;

/// A folder that is removed with its contents; the dossier's is in it, and not made yet.
class DossierTest : public testing::Test {
 protected:
  DossierTest()
      : root_(fs::temp_directory_path() /
              (std::string("curvetet_dossier_") + testing::UnitTest::GetInstance()->current_test_info()->name())) {
    fs::remove_all(root_);
    fs::create_directories(root_);
  }
  ~DossierTest() override { fs::remove_all(root_); }
  DossierTest(const DossierTest&) = delete;
  DossierTest& operator=(const DossierTest&) = delete;

  std::string folder() const { return (root_ / "why").string(); }
  std::string file(const char* name) const { return (root_ / "why" / name).string(); }
  std::string text(const char* name) const {
    std::ifstream in(file(name), std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return std::move(out).str();
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    if (fs::exists(folder()))
      for (const auto& entry : fs::directory_iterator(folder())) names.insert(entry.path().filename());
    return names;
  }

  /// The error of a run that is to fail.
  Error fail(const TopoDS_Shape& shape, Options options) {
    options.dossier = folder();
    const Result<MeshOutput> made = mesh(shape, options, context_, &report_);
    EXPECT_FALSE(made);
    return made ? Error{} : made.error();
  }

  fs::path root_;
  Context context_;
  Report report_;
};

const std::set<std::string> kAll{"summary.txt", "report.json", "faces.brep", "spot.vtu", "replay.bin"};

TopoDS_Shape box() { return BRepPrimAPI_MakeBox(10, 10, 10).Shape(); }

/// A box with a hollow that sticks out of it: their faces cross, and no size helps.
TopoDS_Shape box_with_hollow(const TopoDS_Shape& hollow) {
  TopoDS_Solid solid;
  BRep_Builder builder;
  builder.MakeSolid(solid);
  builder.Add(solid, TopExp_Explorer(box(), TopAbs_SHELL).Current());
  builder.Add(solid, TopExp_Explorer(hollow, TopAbs_SHELL).Current().Reversed());
  return solid;
}

TopoDS_Shape crossed_by_a_cylinder() {
  return box_with_hollow(BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(5, 5, 4), gp_Dir(1, 0.2, 0.1)), 2, 7).Shape());
}

TopoDS_Shape crossed_by_a_box() { return box_with_hollow(BRepPrimAPI_MakeBox(gp_Pnt(4, 4, 4), 8, 2, 2).Shape()); }

/// One face that crosses itself, which only smaller and smaller sizes tell.
TopoDS_Shape spindle_torus() { return BRepPrimAPI_MakeTorus(5, 5.5).Shape(); }

Options coarse() {
  Options options;
  options.size = 16;
  options.curvature = 0;
  return options;
}

TEST_F(DossierTest, HasAllThatAFailureInTheSurfacesLeaves) {
  const Error error = fail(crossed_by_a_cylinder(), {});
  ASSERT_EQ(error.entities.size(), 2U) << error.message;
  EXPECT_EQ(files(), kAll);

  const std::string summary = text("summary.txt");
  for (const std::string& word : {error.message, error.hint, error.entities[0] + " (", error.entities[1] + " (",
                                  std::string("curvetet replay "), std::string(version())})
    EXPECT_NE(summary.find(word), std::string::npos) << word << "\n" << summary;
  EXPECT_EQ(nlohmann::json::parse(text("report.json"))["errors"][0]["message"], error.message);

  TopoDS_Shape faces;
  ASSERT_TRUE(BRepTools::Read(faces, file("faces.brep").c_str(), BRep_Builder()));
  TopTools_IndexedMapOfShape map;
  TopExp::MapShapes(faces, TopAbs_FACE, map);
  EXPECT_EQ(map.Extent(), 2);

  const Result<Mesh> spot = read_mesh(file("spot.vtu"));
  ASSERT_TRUE(spot) << spot.error().message;
  std::set<std::string> shown;
  for (const std::uint32_t f : spot.value().triangle_face)
    shown.insert("face " + std::to_string(spot.value().faces[f].cad_id));
  for (const std::string& entity : error.entities) EXPECT_TRUE(shown.contains(entity)) << entity;
  EXPECT_FALSE(spot.value().segments.empty());
  for (const Point& p : spot.value().points) {
    EXPECT_GT(p[0], -1e-6);
    EXPECT_LT(p[0], 13);
  }
}

TEST_F(DossierTest, TheStateOfAFreeFormFailsAgain) {
  const Error error = fail(BRepBuilderAPI_NurbsConvert(crossed_by_a_cylinder(), true).Shape(), {});
  const Result<State> state = read_state(file("replay.bin"));
  ASSERT_TRUE(state) << state.error().message;
  const Result<MeshOutput> made = replay(state.value(), context_, nullptr);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, error.message);
  EXPECT_EQ(made.error().hint, error.hint);
}

TEST_F(DossierTest, TheStateFailsAgainAtItsLastAttempt) {
  const Error error = fail(spindle_torus(), coarse());
  const Result<State> state = read_state(file("replay.bin"));
  ASSERT_TRUE(state) << state.error().message;
  EXPECT_EQ(state.value().failure.message, error.message);
  EXPECT_FALSE(state.value().loop.asked.empty()) << "sizes of earlier attempts";
  for (int i = 0; i < 2; ++i) {
    Context context;
    Report report;
    const Result<MeshOutput> made = replay(state.value(), context, &report);
    ASSERT_FALSE(made);
    EXPECT_TRUE(recurs(state.value(), made.error())) << made.error().message;
    EXPECT_EQ(made.error().message, error.message);
    EXPECT_EQ(report.errors.size(), report_.errors.size());
  }
}

TEST_F(DossierTest, AnotherFailureDoesNotCountAsTheSame) {
  const Error error = fail(crossed_by_a_box(), {});
  const Result<State> state = read_state(file("replay.bin"));
  ASSERT_TRUE(state) << state.error().message;
  EXPECT_TRUE(recurs(state.value(), error));
  Error other = error;
  other.code = ErrorCode::time_limit;
  EXPECT_FALSE(recurs(state.value(), other));
  other = error;
  other.entities.front() = "face 99";
  EXPECT_FALSE(recurs(state.value(), other));
  other = error;
  ASSERT_TRUE(error.where);
  other.where = *error.where + Vec3{100, 0, 0};
  EXPECT_FALSE(recurs(state.value(), other));
}

TEST_F(DossierTest, OfAPartMeshedApartIsThatParts) {
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, BRepPrimAPI_MakeBox(gp_Pnt(-30, 0, 0), 10, 10, 10).Shape());
  builder.Add(both, crossed_by_a_cylinder());
  Options options;
  options.conformal = Conformal::off;
  const Error error = fail(both, options);
  EXPECT_EQ(files(), kAll);
  const Result<State> state = read_state(file("replay.bin"));
  ASSERT_TRUE(state) << state.error().message;
  EXPECT_EQ(state.value().loop.part, 1U);
  const Result<MeshOutput> made = replay(state.value(), context_, nullptr);
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().message, error.message);
}

TEST_F(DossierTest, IsNotWrittenWhereNothingFailed) {
  Options options;
  options.dossier = folder();
  ASSERT_TRUE(mesh(box(), options, context_));
  EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(DossierTest, IsNotWrittenForARunThatWasCancelled) {
  context_.on_progress = [&](std::string_view stage, double) {
    if (stage == "recovery") context_.cancel();
  };
  EXPECT_EQ(fail(box(), {}).code, ErrorCode::cancelled);
  EXPECT_FALSE(fs::exists(folder()));
}

TEST_F(DossierTest, OfABodyThatCannotBeReadHasNoState) {
  fs::create_directories(folder());
  std::ofstream(file("replay.bin")) << "of an earlier run";
  EXPECT_EQ(fail(BRepBuilderAPI_MakeVertex(gp_Pnt(1, 2, 3)).Shape(), {}).code, ErrorCode::no_faces);
  EXPECT_EQ(files(), (std::set<std::string>{"summary.txt", "report.json"}));
  for (const char* name : {"replay.bin", "faces.brep", "spot.vtu"})
    EXPECT_NE(text("summary.txt").find(name), std::string::npos) << "why there is no " << name;
}

TEST_F(DossierTest, HasNoStateWhereSizesComeFromTheCaller) {
  Options options;
  options.size_callback = [](Point) { return 2.0; };
  fail(crossed_by_a_box(), options);
  EXPECT_FALSE(fs::exists(file("replay.bin")));
  EXPECT_NE(text("summary.txt").find("function of the caller"), std::string::npos);
}

TEST_F(DossierTest, IsLeftByAnExceptionToo) {
  Options options;
  options.dossier = folder();
  options.size_callback = [](Point) -> double { throw std::runtime_error("no size here"); };
  EXPECT_THROW((void)mesh(box(), options, context_), std::runtime_error);
  EXPECT_NE(text("summary.txt").find("internal: no size here"), std::string::npos) << text("summary.txt");
}

TEST_F(DossierTest, ThatCannotBeWrittenIsAWarning) {
  std::ofstream(folder()) << "no folder";
  std::vector<std::string> warnings;
  context_.on_log = [&](LogLevel level, std::string_view message) {
    if (level == LogLevel::warning) warnings.emplace_back(message);
  };
  const Error error = fail(crossed_by_a_box(), {});
  EXPECT_EQ(error.code, ErrorCode::self_intersection) << error.message;
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings.front().find("[output_unwritable]"), std::string::npos) << warnings.front();
  EXPECT_EQ(report_.warnings, warnings);
}

TEST_F(DossierTest, DamagedStatesAreRefused) {
  fail(crossed_by_a_box(), {});
  const std::string whole = text("replay.bin");
  ASSERT_GT(whole.size(), 1000U);
  const auto code_of = [&](const std::string& bytes) {
    std::ofstream(file("damaged.bin"), std::ios::binary) << bytes;
    const Result<State> state = read_state(file("damaged.bin"));
    return state ? ErrorCode::internal : state.error().code;
  };
  EXPECT_EQ(code_of(whole), ErrorCode::internal) << "that is, none";
  for (std::size_t length = 0; length < whole.size(); length += length < 64 ? 1 : 997)
    EXPECT_EQ(code_of(whole.substr(0, length)), ErrorCode::file_unreadable) << length;
  for (std::size_t at = 0; at < whole.size(); at += at < 64 ? 1 : 499) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0x41);
    const bool is_layout = at >= 16 && at < 20;
    EXPECT_EQ(code_of(bytes), is_layout ? ErrorCode::unknown_format : ErrorCode::file_unreadable) << at;
  }
  EXPECT_EQ(code_of(whole + "x"), ErrorCode::file_unreadable);
  EXPECT_EQ(code_of(whole.substr(0, 16) + std::string(28, '\xff')), ErrorCode::unknown_format);
  EXPECT_EQ(read_state(folder()).error().code, ErrorCode::file_unreadable) << "a folder";
  EXPECT_EQ(read_state(file("none.bin")).error().code, ErrorCode::file_not_found);
}

TEST_F(DossierTest, StatesWithSoundHashesAndWrongContentsAreRefused) {
  fail(spindle_torus(), coarse());
  const Result<State> good = read_state(file("replay.bin"));
  ASSERT_TRUE(good);
  ASSERT_FALSE(good.value().loop.asked.empty());
  const auto error_of = [&](const State& state) {
    Context context;
    const Result<MeshOutput> made = replay(state, context, nullptr);
    return made ? ErrorCode::internal : made.error().code;
  };
  State wrong = good.value();
  wrong.body = "something else";
  EXPECT_EQ(error_of(wrong), ErrorCode::file_unreadable);
  wrong = good.value();
  wrong.body.resize(wrong.body.size() / 2);
  EXPECT_EQ(error_of(wrong), ErrorCode::file_unreadable);
  wrong = good.value();
  wrong.loop.asked.front().front().face = FaceId(1000);
  EXPECT_EQ(error_of(wrong), ErrorCode::file_unreadable);
}

TEST(FaceGaps, AreMeasuredOnTheSurfaces) {
  const Model model = test::make_shell(10, 9);
  SizingOptions sizing;
  sizing.size = model.frame.length_to_working(4);
  Context context;
  auto sizes = make_size_field(model, sizing, context);
  ASSERT_TRUE(sizes);
  BodyMesh body;
  auto boundary = mesh_boundary(model, sizes.value(), body.vertices, {}, context);
  ASSERT_TRUE(boundary);
  body.boundary = std::move(boundary.value().mesh);
  RecoveryFailure failure;
  failure.faces = {FaceId(0), FaceId(1)};
  failure.where = model.frame.to_working({6, 6, 4.5});
  const double reach = 4 * sizing.size;
  const auto gap = gap_between(model, body, failure, reach);
  ASSERT_TRUE(gap);
  EXPECT_NEAR(model.frame.length_to_cad(gap->length), 1, 1e-6);
  EXPECT_NEAR(norm(model.frame.to_cad(gap->where)), 9.5, 1e-3);
  EXPECT_FALSE(gap_between(model, body, failure, 0.1 * gap->length)) << "out of reach";
  failure.faces = {FaceId(0), FaceId(0)};
  EXPECT_FALSE(gap_between(model, body, failure, reach)) << "one face";
}

TEST(FaceGaps, AreNotThoseOfNeighbours) {
  const Model model = test::make_box(10, 10, 10);
  BodyMesh body;
  RecoveryFailure failure;
  failure.faces = {model.edges[EdgeId(0)].faces[0], model.edges[EdgeId(0)].faces[1]};
  EXPECT_FALSE(gap_between(model, body, failure, 1));
}

}  // namespace
}  // namespace curvetet
