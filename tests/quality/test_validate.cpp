// A good mesh of each body passes with the model and without; each mutation makes the finding that names it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>

#include "quality/measures.h"
#include "quality/model_checks.h"
#include "quality/validate.h"
#include "sample_meshes.h"
#include "support/bodies.h"

namespace curvetet {
namespace {

std::string words(const ValidationReport& report) {
  std::string text;
  for (const Finding& f : report.findings) {
    text += f.check + (f.severity == Severity::error ? " E " : " W ") + std::to_string(f.count);
    for (const std::string& example : f.examples) text += "\n    " + example;
    text += "\n";
  }
  return text;
}

const Finding* find(const ValidationReport& report, const std::string& check) {
  for (const Finding& f : report.findings) {
    if (f.check == check) return &f;
  }
  return nullptr;
}

struct Sample {
  Model model;
  Mesh mesh;
};

Sample box(int n = 2) {
  Model model = test::make_boxes({2}, 3, 1);
  Mesh mesh = test::mesh_boxes(model, {2}, 3, 1, n);
  return {std::move(model), std::move(mesh)};
}

Sample cylinder(int sectors = 12) {
  Model model = test::make_cylinder(2, 3);
  Mesh mesh = test::mesh_cylinder(model, 2, 3, sectors);
  return {std::move(model), std::move(mesh)};
}

Sample ball(int levels = 2) {
  Model model = test::make_ball(2);
  Mesh mesh = test::mesh_balls(model, {2}, true, {0}, levels);
  return {std::move(model), std::move(mesh)};
}

ValidationReport check(const Sample& sample, bool with_model, double unit_scale = 1) {
  Context context;
  return validate(sample.mesh, with_model ? &sample.model : nullptr, unit_scale, context);
}

void expect_clean(const Sample& sample) {
  for (const bool with_model : {false, true}) {
    const ValidationReport report = check(sample, with_model);
    EXPECT_TRUE(report.findings.empty()) << (with_model ? "with model\n" : "alone\n") << words(report);
    EXPECT_TRUE(report.valid());
  }
}

TEST(Validate, GoodMeshesPass) {
  expect_clean(box());
  expect_clean(cylinder());
  expect_clean(cylinder(3));
  expect_clean(ball(0));
  expect_clean(ball());
  Model boxes = test::make_boxes({1, 2, 0.5}, 3, 1);
  Mesh mesh = test::mesh_boxes(boxes, {1, 2, 0.5}, 3, 1, 2);
  expect_clean({std::move(boxes), std::move(mesh)});
  Model shell = test::make_shell(3, 2);
  mesh = test::mesh_balls(shell, {2, 3}, false, {0}, 3);
  expect_clean({std::move(shell), std::move(mesh)});
  Model nested = test::make_nested_balls(3, 1);
  mesh = test::mesh_balls(nested, {1, 3}, true, {1, 0}, 2);
  expect_clean({std::move(nested), std::move(mesh)});
}

TEST(Validate, VolumesAndQuality) {
  const Sample sample = box();
  const ValidationReport report = check(sample, true);
  ASSERT_EQ(report.solid_volumes.size(), 1U);
  EXPECT_NEAR(report.solid_volumes[0], 6, 1e-12);
  std::size_t tets = 0;
  for (const std::size_t n : report.quality.radius_ratio.bins) tets += n;
  EXPECT_EQ(tets, sample.mesh.tets.size());
  EXPECT_GT(report.quality.worst_dihedral, 0);
  EXPECT_LE(report.quality.radius_ratio.largest, 1);
  EXPECT_LE(report.quality.dihedral.smallest, report.quality.dihedral.mean);
}

TEST(Validate, OtherUnit) {
  Sample sample = cylinder();
  for (Point& p : sample.mesh.points) {
    for (double& x : p) x /= 1000;
  }
  EXPECT_TRUE(check(sample, true, 0.001).valid());
  EXPECT_FALSE(check(sample, true, 1).valid());
}

struct Mutation {
  const char* check;
  bool needs_model;
  Severity severity;
  std::function<Sample()> make;
};

template <class Change>
std::function<Sample()> spoil(Sample (*base)(), Change change) {
  return [base, change] {
    Sample sample = base();
    change(sample);
    return sample;
  };
}

Sample small_box() { return box(2); }
Sample small_cylinder() { return cylinder(12); }
Sample small_ball() { return ball(2); }
Sample two_boxes() {
  Model model = test::make_boxes({1, 1}, 1, 1);
  Mesh mesh = test::mesh_boxes(model, {1, 1}, 1, 1, 2);
  return {std::move(model), std::move(mesh)};
}

void move(Sample& s, std::size_t node, Vec3 by) {
  s.mesh.points[node][0] += by.x;
  s.mesh.points[node][1] += by.y;
  s.mesh.points[node][2] += by.z;
}

/// First node that is in no boundary triangle.
std::size_t interior_node(const Mesh& mesh) {
  std::vector<bool> boundary(mesh.points.size(), false);
  for (const auto& t : mesh.triangles) {
    for (const std::uint32_t v : t) boundary[v] = true;
  }
  return static_cast<std::size_t>(std::find(boundary.begin(), boundary.end(), false) - boundary.begin());
}

void remove_triangle(Mesh& mesh, std::size_t i) {
  mesh.triangles.erase(mesh.triangles.begin() + static_cast<std::ptrdiff_t>(i));
  mesh.triangle_face.erase(mesh.triangle_face.begin() + static_cast<std::ptrdiff_t>(i));
}

void remove_tet(Mesh& mesh, std::size_t i) {
  mesh.tets.erase(mesh.tets.begin() + static_cast<std::ptrdiff_t>(i));
  mesh.tet_solid.erase(mesh.tet_solid.begin() + static_cast<std::ptrdiff_t>(i));
}

/// A second copy of all tets, moved; its nodes are new, its triangles labelled likewise.
void add_copy(Mesh& mesh, double scale, Vec3 by) {
  const auto shift = static_cast<std::uint32_t>(mesh.points.size());
  const std::size_t tets = mesh.tets.size(), triangles = mesh.triangles.size();
  for (std::uint32_t i = 0; i < shift; ++i) {
    const Point p = mesh.points[i];
    mesh.points.push_back({scale * p[0] + by.x, scale * p[1] + by.y, scale * p[2] + by.z});
    mesh.nodes.push_back(mesh.nodes[i]);
  }
  for (std::size_t i = 0; i < tets; ++i) {
    auto t = mesh.tets[i];
    for (std::uint32_t& v : t) v += shift;
    mesh.tets.push_back(t);
    mesh.tet_solid.push_back(mesh.tet_solid[i]);
  }
  for (std::size_t i = 0; i < triangles; ++i) {
    auto t = mesh.triangles[i];
    for (std::uint32_t& v : t) v += shift;
    mesh.triangles.push_back(t);
    mesh.triangle_face.push_back(mesh.triangle_face[i]);
  }
}

/// Four more tets in the place of one that stays, around a vertex of their own: none of their outer vertices is
/// foreign.
void add_star_in(Mesh& mesh, std::size_t tet) {
  const auto corners = mesh.tets[tet];
  const auto middle = static_cast<std::uint32_t>(mesh.points.size());
  Point p{};
  for (const std::uint32_t v : corners)
    for (std::size_t i = 0; i < 3; ++i) p[i] += 0.25 * mesh.points[v][i];
  mesh.points.push_back(p);
  mesh.nodes.push_back(mesh.nodes[corners[0]]);
  for (std::size_t i = 0; i < 4; ++i) {
    auto part = corners;
    part[i] = middle;
    mesh.tets.push_back(part);
    mesh.tet_solid.push_back(mesh.tet_solid[tet]);
  }
}

std::vector<Mutation> mutations() {
  constexpr Severity error = Severity::error, warning = Severity::warning;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  return {
      {"no_tets", false, error, spoil(small_box, [](Sample& s) { s.mesh.tets.clear(), s.mesh.tet_solid.clear(); })},
      {"not_finite", false, error, spoil(small_box, [=](Sample& s) { s.mesh.points[3][1] = nan; })},
      {"bad_index", false, error, spoil(small_box, [](Sample& s) { s.mesh.tets[5][2] = 4000000000U; })},
      {"bad_label", false, error, spoil(small_box, [](Sample& s) { s.mesh.triangle_face[0] = 77; })},
      {"bad_arrays", false, error, spoil(small_box, [](Sample& s) { s.mesh.tet_solid.pop_back(); })},
      {"repeated_vertex", false, error, spoil(small_box, [](Sample& s) { s.mesh.tets[1][0] = s.mesh.tets[1][1]; })},
      {"negative_tet", false, error,
       spoil(small_box, [](Sample& s) { std::swap(s.mesh.tets[1][0], s.mesh.tets[1][1]); })},
      {"negative_tet", false, error,
       spoil(small_box,
             [](Sample& s) {
               move(s, interior_node(s.mesh), {1.5, 0.3, 0.1});
             })},
      {"flat_tet", false, error,
       spoil(small_box, [](Sample& s) { s.mesh.points[s.mesh.tets[0][0]] = s.mesh.points[s.mesh.tets[0][1]]; })},
      {"duplicate_node", false, error,
       spoil(small_box, [](Sample& s) { s.mesh.points[s.mesh.tets[0][0]] = s.mesh.points[s.mesh.tets[0][1]]; })},
      {"unused_node", false, warning,
       spoil(small_box,
             [](Sample& s) {
               s.mesh.points.push_back({9, 9, 9});
             })},
      {"facet_of_many_tets", false, error,
       spoil(small_box,
             [](Sample& s) {
               s.mesh.tets.push_back(s.mesh.tets[0]);
               s.mesh.tet_solid.push_back(0);
             })},
      {"tets_on_same_side", false, error,
       spoil(small_box,
             [](Sample& s) {
               s.mesh.points.push_back({0.1, 0.2, 0.3});
               auto t = s.mesh.tets[0];
               t[0] = static_cast<std::uint32_t>(s.mesh.points.size() - 1);
               s.mesh.tets = {s.mesh.tets[0], t};
               s.mesh.tet_solid = {0, 0};
             })},
      {"triangle_not_a_facet", false, error, spoil(small_box, [](Sample& s) { remove_tet(s.mesh, 0); })},
      {"unlabelled_boundary_facet", false, error, spoil(small_box, [](Sample& s) { remove_triangle(s.mesh, 4); })},
      {"unlabelled_boundary_facet", false, error, spoil(small_box, [](Sample& s) { remove_tet(s.mesh, 0); })},
      {"duplicate_triangle", false, error,
       spoil(small_box,
             [](Sample& s) {
               s.mesh.triangles.push_back(s.mesh.triangles[4]);
               s.mesh.triangle_face.push_back(s.mesh.triangle_face[4]);
             })},
      {"triangle_inside_a_region", false, warning,
       spoil(small_box,
             [](Sample& s) {
               const std::uint32_t inner = static_cast<std::uint32_t>(interior_node(s.mesh));
               for (const auto& t : s.mesh.tets) {
                 if (std::find(t.begin(), t.end(), inner) == t.end()) continue;
                 s.mesh.triangles.push_back({inner, t[0] == inner ? t[1] : t[0], t[3] == inner ? t[2] : t[3]});
                 break;
               }
               s.mesh.triangle_face.push_back(0);
             })},
      {"face_sides_vary", false, warning,
       spoil(small_box, [](Sample& s) { std::swap(s.mesh.triangles[0][0], s.mesh.triangles[0][1]); })},
      {"wrong_solid_beside_face", true, error,
       spoil(small_box, [](Sample& s) { std::swap(s.mesh.triangles[0][0], s.mesh.triangles[0][1]); })},
      {"wrong_solid_beside_face", true, error,
       spoil(two_boxes,
             [](Sample& s) {
               for (std::uint32_t& r : s.mesh.tet_solid) r = 1 - r;
             })},
      {"empty_solid", false, error,
       spoil(two_boxes,
             [](Sample& s) {
               for (std::uint32_t& r : s.mesh.tet_solid) r = 0;
             })},
      {"boundary_intersection", false, error,
       spoil(small_ball,
             [](Sample& s) {
               add_copy(s.mesh, 1, {3, 0.1, 0.2});
             })},
      {"boundary_intersection", false, error,
       spoil(small_box,
             [](Sample& s) {
               add_copy(s.mesh, 1, {1, 1, 1});
             })},
      {"vertex_in_foreign_tet", false, error,
       spoil(small_ball,
             [](Sample& s) {
               add_copy(s.mesh, 0.1, {0.3, 0, 0});
             })},
      {"vertex_in_foreign_tet", false, error,
       spoil(small_box,
             [](Sample& s) {
               add_copy(s.mesh, 1, {0, 3, 0.1});
             })},
      {"vertex_in_foreign_tet", false, error, spoil(small_ball, [](Sample& s) { add_star_in(s.mesh, 3); })},
      {"more_pieces_than_solids", true, error,
       spoil(small_ball,
             [](Sample& s) {
               add_copy(s.mesh, 1, {9, 0, 0});
             })},
      {"solid_in_pieces", true, warning,
       spoil(small_ball,
             [](Sample& s) {
               add_copy(s.mesh, 1, {9, 0, 0});
             })},
      {"euler_characteristic", true, warning,
       spoil(small_ball,
             [](Sample& s) {
               add_copy(s.mesh, 1, {9, 0, 0});
             })},
      {"vertex_off_face", true, error,
       spoil(small_ball,
             [](Sample& s) {
               for (double& x : s.mesh.points[7]) x *= 1.001;
             })},
      {"vertex_off_face", true, error,
       spoil(small_cylinder,
             [](Sample& s) {
               move(s, 0, {0, 0, -1e-3});
             })},
      {"vertex_off_edge", true, error,
       spoil(small_box,
             [](Sample& s) {
               move(s, s.mesh.segments[0][0], {1e-3, 1e-3, 1e-3});
             })},
      {"corner_off_vertex", true, error,
       spoil(small_box,
             [](Sample& s) {
               move(s, s.mesh.corner_nodes[0], {1e-3, 0, 0});
             })},
      {"fold", true, error,
       spoil(small_box,
             [](Sample& s) {
               const Point middle{1, 1.5, 0};
               const auto node = std::find(s.mesh.points.begin(), s.mesh.points.end(), middle) - s.mesh.points.begin();
               move(s, static_cast<std::size_t>(node), {1.2, 0.2, 0});
             })},
      {"uncovered_face", true, error, spoil(small_ball, [](Sample& s) { s.model = test::make_shell(2, 1); })},
      {"face_without_triangles", true, error, spoil(small_ball, [](Sample& s) { s.model = test::make_shell(2, 1); })},
      {"volume", true, error, spoil(small_ball, [](Sample& s) { s.model = test::make_shell(2, 1.7); })},
      {"volume", true, error,
       spoil(small_ball,
             [](Sample& s) {
               s.model = test::make_shell(2, 1.7);
               s.model.solids[SolidId(0U)].volume *= 1e6;  // what a kernel has wrong forgives nothing
             })},
      {"label_not_in_cad", true, error, spoil(small_ball, [](Sample& s) { s.mesh.faces[0].cad_id = 12; })},
      {"edge_without_segments", true, error,
       spoil(small_cylinder, [](Sample& s) { s.mesh.segments.clear(), s.mesh.segment_edge.clear(); })},
      {"edge_not_a_chain", true, error,
       spoil(small_cylinder,
             [](Sample& s) {
               s.mesh.segments.erase(s.mesh.segments.begin() + 3);
               s.mesh.segment_edge.erase(s.mesh.segment_edge.begin() + 3);
             })},
      {"segment_triangles", true, error,
       spoil(small_box,
             [](Sample& s) {
               s.mesh.segments[0] = {0, static_cast<std::uint32_t>(s.mesh.points.size() - 1)};
             })},
      {"unfair_chord", true, error,
       [] {
         Sample s = cylinder(3);
         for (const std::size_t i : {2U, 3U, 6U, 7U}) {
           const double angle = (i % 2 == 0 ? 60 : 120) * std::numbers::pi / 180;
           s.mesh.points[i] = {2 * std::cos(angle), 2 * std::sin(angle), s.mesh.points[i][2]};
         }
         return s;
       }},
      {"crowded_edge", false, warning,
       spoil(small_box,
             [](Sample& s) {
               // Two tets of the box that share no more than an edge.
               const auto shared = [](const auto& a, const auto& b) {
                 return std::count_if(a.begin(), a.end(),
                                      [&](auto v) { return std::find(b.begin(), b.end(), v) != b.end(); });
               };
               std::size_t other = 1;
               while (shared(s.mesh.tets[0], s.mesh.tets[other]) != 2) ++other;
               s.mesh.tets = {s.mesh.tets[0], s.mesh.tets[other]};
               s.mesh.tet_solid = {0, 0};
             })},
  };
}

TEST(Validate, EveryMutationIsNamed) {
  for (const Mutation& mutation : mutations()) {
    const Sample sample = mutation.make();
    const ValidationReport report = check(sample, mutation.needs_model);
    const Finding* finding = find(report, mutation.check);
    EXPECT_NE(finding, nullptr) << mutation.check << " not found; found:\n" << words(report);
    if (finding == nullptr) continue;
    EXPECT_EQ(finding->severity, mutation.severity) << mutation.check;
    EXPECT_GT(finding->count, 0U);
    EXPECT_FALSE(finding->examples.empty());
    EXPECT_LE(finding->examples.size(), 5U);
    if (mutation.severity == Severity::error) {
      EXPECT_FALSE(report.valid());
    }
  }
}

TEST(Validate, SameFindingsForAnyNumberOfThreads) {
  Sample sample = ball(3);
  add_copy(sample.mesh, 1, {1, 0.1, 0.2});
  Context one, two;
  one.threads = 1;
  two.threads = 2;
  EXPECT_EQ(words(validate(sample.mesh, &sample.model, 1, one)), words(validate(sample.mesh, &sample.model, 1, two)));
}

TEST(Validate, CancelledIsNotValid) {
  const Sample sample = box();
  Context context;
  context.cancel();
  EXPECT_FALSE(validate(sample.mesh, &sample.model, 1, context).valid());
}

/// One tet, two of whose facets are on two faces that meet at two degrees in its first edge.
Mesh thin_wedge() {
  const double angle = 2 * std::numbers::pi / 180;
  Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, std::cos(angle), std::sin(angle)}};
  mesh.nodes = {{0, 0, {}}, {0, 1, {}}, {2, 0, {}}, {2, 1, {}}};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.tet_solid = {0};
  mesh.triangles = {{1, 0, 2}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  mesh.triangle_face = {0, 1, 2, 2};
  mesh.segments = {{0, 1}};
  mesh.segment_edge = {0};
  mesh.corner_nodes = {0, 1};
  for (std::uint32_t id = 1; id <= 3; ++id) mesh.faces.push_back({id, "", {}, {}, {}});
  mesh.solids.push_back({1, "", {}, {}, {}});
  mesh.edges.push_back({1, "", {}, {}, {}});
  mesh.vertices = {{1, "", {}, {}, {}}, {2, "", {}, {}, {}}};
  return mesh;
}

/// A cylinder that finds feet from a guess hard by only, as threads of many turns do: there others are as good.
class Wound final : public Surface {
 public:
  explicit Wound(const Surface& real) : real_(real.clone()) {}
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 uv) const override { return real_->value(uv); }
  SurfaceFirst first(Vec2 uv) const override { return real_->first(uv); }
  SurfaceSecond second(Vec2 uv) const override { return real_->second(uv); }
  double period_u() const override { return real_->period_u(); }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Wound>(*real_); }
  std::optional<Vec2> project(Vec3 point, Vec2 guess) const override {
    const auto foot = real_->project(point, guess);
    return foot && std::abs(foot->x - guess.x) < 1e-3 ? foot : guess;
  }

 private:
  std::unique_ptr<Surface> real_;
};

/// Says of every node of a segment where on its edge it is, and of every corner which vertex it is.
void locate_on_edges(const Model& model, Mesh& mesh) {
  mesh.nodes.assign(mesh.points.size(), {});
  for (std::size_t i = 0; i < mesh.segments.size(); ++i) {
    const ModelEdge& edge = model.edges[EdgeId(mesh.segment_edge[i])];
    for (const std::uint32_t v : mesh.segments[i]) {
      double best = 1, t = edge.low;  // from every side: a projection is local
      const Vec3 p = model.frame.to_working({mesh.points[v][0], mesh.points[v][1], mesh.points[v][2]});
      for (int k = 0; k <= 8; ++k) {
        const double found = edge.curve->project(p, edge.low + 0.125 * k * (edge.high - edge.low), edge.low, edge.high);
        const double d = distance(p, edge.curve->value(found));
        if (d < best) best = d, t = found;
      }
      mesh.nodes[v] = {1, mesh.segment_edge[i], {t, 0}};
    }
  }
  for (std::uint32_t v = 0; v < mesh.corner_nodes.size(); ++v) mesh.nodes[mesh.corner_nodes[v]] = {0, v, {}};
}

TEST(Validate, FeetOfNodesOnEdgesAreFoundFromTheirParameterCurves) {
  Sample s = cylinder(13);
  for (std::size_t f = 0; f < s.model.faces.size(); ++f) {
    ModelFace& face = s.model.faces[FaceId(f)];
    if (face.surface->kind() == SurfaceKind::cylinder) face.surface = std::make_shared<Wound>(*face.surface);
  }
  EXPECT_NE(find(check(s, true), "vertex_off_face"), nullptr);
  locate_on_edges(s.model, s.mesh);
  const ValidationReport report = check(s, true);
  EXPECT_EQ(find(report, "vertex_off_face"), nullptr) << words(report);
}

/// A nose that turns back at u = 0, where a face may end.
class Nose final : public Surface {
 public:
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 uv) const override { return {uv.x * uv.x, uv.x, uv.y}; }
  SurfaceFirst first(Vec2 uv) const override { return {value(uv), {2 * uv.x, 1, 0}, {0, 0, 1}}; }
  SurfaceSecond second(Vec2 uv) const override {
    const SurfaceFirst at = first(uv);
    return {at.value, at.du, at.dv, {2, 0, 0}, {}, {}};
  }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Nose>(*this); }
};

TEST(FaceProjector, FindsTheClosestPointOfTheFaceThoughTheSurfaceBeyondIsCloser) {
  ModelFace face;
  face.surface = std::make_shared<Nose>();
  face.low = {0, 0};
  face.high = {1, 1};
  checks::FaceProjector projector(face);
  const Vec3 point{1, -0.05, 0.5};
  for (const Vec2 guess : {Vec2{-0.7, 0.5}, Vec2{-0.005, 0.5}, Vec2{0.7, 0.5}, Vec2{5, 5}}) {
    const Vec2 found = projector.closest(point, guess);
    EXPECT_NEAR(found.x, 0.681, 2e-3);
    EXPECT_NEAR(found.y, 0.5, 1e-6);
  }
}

/// The outside of a thin ring, over half a turn of its section, that does not know of its period.
class Rim final : public Surface {
 public:
  explicit Rim(double radius) : radius_(radius) {}
  SurfaceKind kind() const override { return SurfaceKind::revolution; }
  Vec3 value(Vec2 uv) const override {
    const double r = 1 + radius_ * std::sin(uv.y);
    return {r * std::cos(uv.x), r * std::sin(uv.x), -radius_ * std::cos(uv.y)};
  }
  SurfaceFirst first(Vec2 uv) const override {
    const double r = 1 + radius_ * std::sin(uv.y), c = radius_ * std::cos(uv.y);
    return {value(uv),
            {-r * std::sin(uv.x), r * std::cos(uv.x), 0},
            {c * std::cos(uv.x), c * std::sin(uv.x), radius_ * std::sin(uv.y)}};
  }
  SurfaceSecond second(Vec2 uv) const override {
    const SurfaceFirst at = first(uv);
    return {at.value, at.du, at.dv, {}, {}, {}};
  }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<Rim>(*this); }

 private:
  double radius_;
};

TEST(FaceProjector, FindsTheClosestPointOfAThinRoundFromInside) {
  constexpr double kRadius = 0.003;
  ModelFace face;
  face.surface = std::make_shared<Rim>(kRadius);
  face.low = {0, 0};
  face.high = {2 * std::numbers::pi, std::numbers::pi};
  checks::FaceProjector projector(face);
  for (int i = 0; i < 100; ++i) {
    const double u = 0.06 * i, v = 0.02 + 0.031 * i, depth = (0.1 + 0.008 * i) * kRadius;
    const Vec3 point = face.surface->value({u, v}) - depth * face.surface->normal({u, v});
    for (const Vec2 guess : {Vec2{u + 0.05, 0.5}, Vec2{u, -110.7}, Vec2{u, 9}})
      EXPECT_LT(distance(face.surface->value(projector.closest(point, guess)), point), depth * (1 + 1e-3)) << i;
  }
}

/// A flat face whose surface turns back beyond the border, and finds all its feet there.
class TurnedBack final : public Surface {
 public:
  TurnedBack(const Surface& flat, double border) : flat_(flat.clone()), border_(border) {}
  SurfaceKind kind() const override { return SurfaceKind::other; }
  Vec3 value(Vec2 uv) const override { return flat_->value({std::min(uv.x, mirrored(uv.x)), uv.y}); }
  SurfaceFirst first(Vec2 uv) const override {
    SurfaceFirst at = flat_->first({std::min(uv.x, mirrored(uv.x)), uv.y});
    if (uv.x > border_) at.du = -at.du;
    return at;
  }
  SurfaceSecond second(Vec2 uv) const override {
    const SurfaceFirst at = first(uv);
    return {at.value, at.du, at.dv, {}, {}, {}};
  }
  std::unique_ptr<Surface> clone() const override { return std::make_unique<TurnedBack>(*flat_, border_); }
  std::optional<Vec2> project(Vec3 point, Vec2 guess) const override {
    const auto foot = flat_->project(point, guess);
    return foot ? std::optional(Vec2{mirrored(foot->x), foot->y}) : foot;
  }

 private:
  double mirrored(double u) const { return 2 * border_ - u; }

  std::unique_ptr<Surface> flat_;
  double border_;
};

TEST(Validate, AFoldIsOneThoughTheSurfaceBeyondTheBorderFacesIt) {
  for (const bool folded : {false, true}) {
    Sample s = box();
    for (std::size_t f = 0; f < s.model.faces.size(); ++f) {
      ModelFace& face = s.model.faces[FaceId(f)];
      face.surface = std::make_shared<TurnedBack>(*face.surface, face.high.x);
    }
    const Point middle{1, 1.5, 0};
    const auto node = std::find(s.mesh.points.begin(), s.mesh.points.end(), middle) - s.mesh.points.begin();
    if (folded) move(s, static_cast<std::size_t>(node), {1.2, 0.2, 0});
    const ValidationReport report = check(s, true);
    const Finding* fold = find(report, "fold");
    EXPECT_EQ(fold == nullptr ? 0 : fold->count, folded ? 2 : 0) << words(report);
  }
}

TEST(ForcedAngles, ThinWedgeOfTwoFacesIsTheBodysOwn) {
  Context context;
  const QualitySummary quality = validate(thin_wedge(), nullptr, 1, context).quality;
  EXPECT_EQ(quality.below_five_degrees, 1u);
  EXPECT_EQ(quality.forced_below_five, 1u);
  EXPECT_EQ(quality.forced_below_half, 0u);
  ASSERT_EQ(quality.forced.size(), 1u);
  EXPECT_EQ(quality.forced[0].faces, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(quality.forced[0].edges, std::vector<std::uint32_t>{0});
  EXPECT_NEAR(quality.forced[0].angle, 2, 1e-9);
}

/// The thin wedge without its edge: what is thin is the face across, between two curves.
Mesh narrow_face(std::uint32_t first_curve, std::uint32_t second_curve) {
  Mesh mesh = thin_wedge();
  mesh.segments.clear();
  mesh.segment_edge.clear();
  mesh.nodes[2] = {1, first_curve, {}};
  mesh.nodes[3] = {1, second_curve, {}};
  mesh.edges.push_back({2, "", {}, {}, {}});
  return mesh;
}

TEST(ForcedAngles, AFaceNarrowerThanItsNeighboursTetsIsTheBodysOwn) {
  Context context;
  const QualitySummary quality = validate(narrow_face(0, 1), nullptr, 1, context).quality;
  EXPECT_EQ(quality.forced_below_five, 1u);
  EXPECT_EQ(quality.forced_below_half, 0u);
  ASSERT_EQ(quality.forced.size(), 1u);
  EXPECT_EQ(quality.forced[0].faces, std::vector<std::uint32_t>{2});
  EXPECT_EQ(quality.forced[0].edges, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_FALSE(quality.forced[0].vertex);
  EXPECT_NEAR(quality.forced[0].angle, 2, 1e-3);
}

TEST(ForcedAngles, ACadEdgeShorterThanItsNeighboursTetsIsTheBodysOwn) {
  Mesh mesh = narrow_face(0, 1);
  mesh.nodes[2] = {0, 2, {}};
  mesh.nodes[3] = {0, 3, {}};
  mesh.segments = {{2, 3}};
  mesh.segment_edge = {1};
  mesh.vertices.insert(mesh.vertices.end(), {{3, "", {}, {}, {}}, {4, "", {}, {}, {}}});
  mesh.corner_nodes = {0, 1, 2, 3};
  Context context;
  const QualitySummary quality = validate(mesh, nullptr, 1, context).quality;
  EXPECT_EQ(quality.forced_below_five, 1u);
  ASSERT_EQ(quality.forced.size(), 1u);
  EXPECT_EQ(quality.forced[0].edges, std::vector<std::uint32_t>{1});
}

TEST(ForcedAngles, AShortEdgeAlongOneCurveIsTheMeshsFault) {
  Context context;
  EXPECT_TRUE(validate(narrow_face(1, 1), nullptr, 1, context).quality.forced.empty());
}

/// A flat tet over a strip 0.2 wide between two curves: its edge from one to the other runs along the strip, beside the
/// segment from vertex 0 to vertex 4. Vertex 4 is on the first curve, or within the face.
Mesh over_a_strip(std::uint8_t dimension) {
  Mesh mesh = thin_wedge();
  mesh.points = {{0, 0, 0}, {8, 0, 0.2}, {2, 10, 0}, {12, 9, 0}, {10, 0, 0}};
  mesh.nodes = {{1, 0, {}}, {1, 1, {}}, {2, 0, {}}, {2, 0, {}}, {dimension, 0, {}}};
  mesh.tets = {{0, 3, 2, 1}};
  mesh.triangles = {{0, 2, 3}, {0, 4, 1}};
  mesh.triangle_face = {0, 2};
  mesh.segments = {{0, 4}};
  mesh.segment_edge = {0};
  mesh.corner_nodes.clear();
  mesh.vertices.clear();
  mesh.edges.push_back({2, "", {}, {}, {}});
  return mesh;
}

TEST(ForcedAngles, AStripIsTheBodysOwnAlsoWhereTheMeshCrossesItSlanted) {
  Context context;
  const QualitySummary quality = validate(over_a_strip(1), nullptr, 1, context).quality;
  EXPECT_EQ(quality.below_five_degrees, 1u);
  EXPECT_EQ(quality.forced_below_five, 1u);
  ASSERT_EQ(quality.forced.size(), 1u);
  EXPECT_EQ(quality.forced[0].faces, std::vector<std::uint32_t>{2});
  EXPECT_EQ(quality.forced[0].edges, (std::vector<std::uint32_t>{0, 1}));
  EXPECT_NEAR(quality.forced[0].angle, quality.worst_dihedral, 1e-3);
  EXPECT_TRUE(validate(over_a_strip(2), nullptr, 1, context).quality.forced.empty());
  // The apex beyond the segment's end: the curves may part at any angle there, and the tet be flat for no reason.
  Mesh beyond = over_a_strip(1);
  beyond.points[4] = {7, 0, 0};
  EXPECT_TRUE(validate(beyond, nullptr, 1, context).quality.forced.empty());
}

// The strip leaves the facet's plane at a slant, so that the tet is flat however wide the strip is.
TEST(ForcedAngles, AFlatTetOverAWideFaceIsTheMeshsFault) {
  Mesh wide = over_a_strip(1);
  wide.points[1] = {8, -6, 0.2};
  Context context;
  EXPECT_TRUE(validate(wide, nullptr, 1, context).quality.forced.empty());
}

TEST(ForcedAngles, FlatTetOffTheEdgesIsTheMeshsFault) {
  Mesh mesh = thin_wedge();
  mesh.segments.clear();
  mesh.segment_edge.clear();
  Context context;
  const QualitySummary quality = validate(mesh, nullptr, 1, context).quality;
  EXPECT_EQ(quality.below_five_degrees, 1u);
  EXPECT_EQ(quality.forced_below_five, 0u);
  EXPECT_TRUE(quality.forced.empty());
}

TEST(Validate, EmptyMesh) {
  Context context;
  EXPECT_FALSE(validate(Mesh{}, nullptr, 1, context).valid());
}

TEST(Validate, ChordsWithinTheToleranceOfTheirEdgeAreFair) {
  Sample s = cylinder(3);
  for (const std::size_t i : {2U, 3U, 6U, 7U}) {
    const double angle = (i % 2 == 0 ? 60 : 120) * std::numbers::pi / 180;
    s.mesh.points[i] = {2 * std::cos(angle), 2 * std::sin(angle), s.mesh.points[i][2]};
  }
  EXPECT_NE(find(check(s, true), "unfair_chord"), nullptr);
  for (ModelEdge& edge : s.model.edges) edge.tolerance = s.model.frame.length_to_working(3.5);
  EXPECT_EQ(find(check(s, true), "unfair_chord"), nullptr);
}

/// A parameter curve that lies beside its edge by so much in u.
class Beside final : public ParameterCurve {
 public:
  Beside(std::shared_ptr<const ParameterCurve> base, double by) : base_(std::move(base)), by_(by) {}
  Vec2 value(double t) const override { return base_->value(t) + Vec2{by_, 0}; }
  std::unique_ptr<ParameterCurve> clone() const override { return std::make_unique<Beside>(base_, by_); }

 private:
  std::shared_ptr<const ParameterCurve> base_;
  double by_;
};

// The volume of a kernel whose faces do not reach their edges is wrong by what passes through the gaps, and no more.
TEST(Validate, VolumesAreExplainedByGapsAsFarAsTheyReach) {
  for (const double gap : {0.0, 0.01}) {
    for (const double factor : {1.02, 2.0}) {
      Sample sample = box();
      sample.model.solids[SolidId(0U)].volume *= factor;
      const double by = sample.model.frame.length_to_working(gap);
      for (ModelFace& face : sample.model.faces)
        for (Loop& loop : face.loops)
          for (EdgeUse& use : loop.uses) use.curve = std::make_shared<Beside>(use.curve, by);
      const ValidationReport report = check(sample, true);
      const bool found = find(report, "volume") != nullptr || find(report, "cad_volume") != nullptr;
      EXPECT_EQ(found, gap == 0 || factor == 2) << gap << " " << factor;
    }
  }
}

// A kernel's volume may be wrong though the faces are not: offset surfaces, parameter curves that jump by a period.
TEST(Validate, WrongVolumeOfTheKernelAloneIsAWarning) {
  for (const double factor : {0.5, 1.02, 2.0}) {
    Sample sample = box();
    sample.model.solids[SolidId(0U)].volume *= factor;
    const ValidationReport report = check(sample, true);
    EXPECT_TRUE(report.valid());
    EXPECT_EQ(find(report, "volume"), nullptr);
    const Finding* found = find(report, "cad_volume");
    ASSERT_NE(found, nullptr) << factor;
    EXPECT_EQ(found->severity, Severity::warning);
  }
}

}  // namespace
}  // namespace curvetet
