// Runs the stages and draws what each of them does: the pictures of docs/algorithms.
//   stage_pictures VALVE_BODY.step FOLDER
// Red is what is wrong before a stage, green what the stage put in its place, yellow what a cut lays open.
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopoDS_Compound.hxx>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <set>
#include <string>

#include "boundary/boundary_mesh.h"
#include "boundary/classify.h"
#include "boundary/edge_recovery.h"
#include "boundary/face_recovery.h"
#include "cad/load.h"
#include "cad/shape.h"
#include "io/drawing.h"
#include "quality/measures.h"
#include "volume/improve.h"
#include "volume/refine.h"

namespace {

using namespace curvetet;

constexpr Rgb kPlain{0.80F, 0.85F, 0.91F}, kRed{0.90F, 0.25F, 0.20F}, kGreen{0.35F, 0.75F, 0.40F},
    kCut{1.0F, 0.84F, 0.3F};

Rgb colour_of_index(std::size_t index) {
  constexpr Rgb kColours[] = {{0.62F, 0.79F, 0.94F}, {0.98F, 0.75F, 0.55F}, {0.70F, 0.87F, 0.66F},
                              {0.86F, 0.72F, 0.90F}, {0.96F, 0.88F, 0.60F}, {0.65F, 0.87F, 0.85F},
                              {0.95F, 0.70F, 0.72F}, {0.78F, 0.80F, 0.82F}};
  return kColours[index % std::size(kColours)];
}

struct Shown {
  std::array<Vec3, 3> corner;
  Rgb colour = kPlain;
  std::array<double, 3> line{0.5, 0.5, 0.5};  ///< half widths in pixels, of the edge opposite each corner
};
using Shape = std::vector<Shown>;

// --- drawing ---

struct Panel {
  double left = 0, width = 0, height = 0;
};

void draw(Canvas& canvas, const Shape& shape, const Panel& panel, Vec3 towards, bool flat) {
  const Vec3 out = normalized(towards);
  const Vec3 right = flat ? Vec3{1, 0, 0} : normalized(cross({0, 0, 1}, out));
  const Vec3 up = flat ? Vec3{0, 1, 0} : cross(out, right);
  Vec2 low{HUGE_VAL, HUGE_VAL}, high{-HUGE_VAL, -HUGE_VAL};
  for (const Shown& s : shape)
    for (const Vec3& p : s.corner) {
      low = {std::min(low.x, dot(p, right)), std::min(low.y, dot(p, up))};
      high = {std::max(high.x, dot(p, right)), std::max(high.y, dot(p, up))};
    }
  const double scale = 0.92 * std::min(panel.width / (high.x - low.x), panel.height / (high.y - low.y));
  const auto place = [&](const Vec3& p) {
    return Vec3{panel.left + panel.width / 2 + scale * (dot(p, right) - (low.x + high.x) / 2),
                panel.height / 2 - scale * (dot(p, up) - (low.y + high.y) / 2), -scale * dot(p, out)};
  };
  for (const Shown& s : shape) {
    DrawnTriangle t;
    for (std::size_t k = 0; k < 3; ++k) t.corner[k] = place(s.corner[k]);
    const Vec3 normal = normalized(cross(s.corner[1] - s.corner[0], s.corner[2] - s.corner[0]));
    const double facing = std::abs(dot(normal, out)), lamp = std::abs(dot(normal, normalized(out + 0.7 * up)));
    const double light = flat ? 1 : 0.55 + 0.25 * facing + 0.2 * lamp;
    for (std::size_t k = 0; k < 3; ++k) {
      t.fill[k] = static_cast<float>(light) * s.colour[k];
      t.line[k] = 0.3F * t.fill[k];
    }
    t.half_width = s.line;
    canvas.draw(t);
  }
}

constexpr int kHeight = 460;

void save(const std::string& path, const std::vector<Shape>& shapes, Vec3 towards = {0.85, -1.4, 0.95},
          const std::set<std::size_t>& flat = {}) {
  const int width = shapes.size() == 1 ? 640 : 480 * static_cast<int>(shapes.size());
  Canvas canvas(width, kHeight, 3);
  const double each = static_cast<double>(width) / static_cast<double>(shapes.size());
  for (std::size_t i = 0; i < shapes.size(); ++i)
    draw(canvas, shapes[i], {each * static_cast<double>(i), each, kHeight}, towards, flat.contains(i));
  const Status done = write_png(path, canvas.pixels(), width, kHeight);
  std::printf("%s %s\n", path.c_str(), done ? "written" : done.error().message.c_str());
}

// --- the stages, as the pipeline runs them ---

struct Run {
  Model model;
  SizeField sizes;
  VertexStore vertices;
  BoundaryMesh boundary;
  std::unique_ptr<Conjoint> conjoint;
  std::unique_ptr<Tetrahedralization> tets;
  Context context;
  double floor = 0;
};

template <class T>
T value_of(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message);
  return std::move(result.value());
}

Model model_of(const TopoDS_Shape& shape) {
  Context context;
  return value_of(model_from_shape(shape, {}, context));
}

/// As far as the face meshes.
std::unique_ptr<Run> start(Model model, double size, double curvature, bool gaps = true) {
  auto run = std::make_unique<Run>();
  run->model = std::move(model);
  SizingOptions sizing;
  sizing.size = run->model.frame.length_to_working(size);
  sizing.min_size = sizing.size / 1000;
  sizing.curvature = curvature;
  sizing.gaps = gaps;
  run->floor = sizing.size / 256;
  run->sizes = value_of(make_size_field(run->model, sizing, run->context));
  BoundaryResult front = value_of(mesh_boundary(run->model, run->sizes, run->vertices, {}, run->context));
  if (!front.failures.empty()) throw std::runtime_error(front.failures.front().detail);
  run->boundary = std::move(front.mesh);
  Run& r = *run;
  run->conjoint = std::make_unique<Conjoint>(r.model, r.vertices, r.boundary, [&r](FaceId f) {
    return spatial_criterion(r.boundary.faces[f], r.vertices, r.model.faces[f]);
  });
  return run;
}

void tetrahedralize(Run& run) {
  std::set<VertexId> used;
  for (const SurfaceTriangle& t : surface_triangles(run.boundary)) used.insert(t.vertices.begin(), t.vertices.end());
  const std::vector<VertexId> list(used.begin(), used.end());
  run.tets = std::make_unique<Tetrahedralization>(run.vertices, 1);
  value_of(run.tets->build(list, run.context));
  run.conjoint->attach(run.tets.get());
}

void recover(Run& run) {
  if (!value_of(recover_faces(*run.conjoint, {run.floor}, run.context)).failures.empty())
    throw std::runtime_error("recovery failed");
  if (!classify(*run.conjoint).failures.empty()) throw std::runtime_error("classification failed");
}

// --- from meshes to shapes ---

using ColourOfTriangle = std::function<Rgb(std::size_t index, const SurfaceTriangle&)>;

Shape surface(const Run& run, const ColourOfTriangle& colour, double line = 0.5) {
  Shape shape;
  const std::vector<SurfaceTriangle> triangles = surface_triangles(run.boundary);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    Shown shown;
    for (std::size_t k = 0; k < 3; ++k) {
      shown.corner[k] = run.vertices.position(triangles[i].vertices[k]);
      const VertexId a = triangles[i].vertices[(k + 1) % 3], b = triangles[i].vertices[(k + 2) % 3];
      shown.line[k] = run.conjoint->segment_edge(a, b).valid() ? 1.3 : line;
    }
    shown.colour = colour(i, triangles[i]);
    shape.push_back(shown);
  }
  return shape;
}

/// The visible facets of the tets that `colour` gives a colour to: those of exactly one of them.
Shape solid(const Run& run, const std::function<std::optional<Rgb>(TetId)>& colour) {
  std::map<FacetKey, std::pair<int, Shown>> seen;
  const TetComplex& complex = run.tets->complex();
  for (std::size_t t = 0; t < complex.slots(); ++t) {
    if (!complex.is_alive(TetId(t)) || complex.is_ghost(TetId(t))) continue;
    const auto shown = colour(TetId(t));
    if (!shown) continue;
    for (int i = 0; i < 4; ++i) {
      const auto v = complex.facet_vertices({TetId(t), i});
      auto& [count, facet] = seen[facet_key(v[0], v[1], v[2])];
      ++count;
      for (std::size_t k = 0; k < 3; ++k) facet.corner[k] = run.vertices.position(v[k]);
      facet.colour = complex.is_locked({TetId(t), i}) ? kPlain : *shown;
    }
  }
  Shape shape;
  for (const auto& [key, entry] : seen)
    if (entry.first == 1) shape.push_back(entry.second);
  return shape;
}

bool behind_cut(const Run& run, TetId t, double at_x = 0) {
  double x = 0;
  for (VertexId v : run.tets->complex().vertices(t)) x += run.vertices.position(v).x / 4;
  return x < at_x;
}

double worst_angle(const Run& run, TetId t) {
  const auto& v = run.tets->complex().vertices(t);
  const auto p = [&](std::size_t i) { return run.vertices.position(v[i]); };
  return smallest_dihedral(p(0), p(1), p(2), p(3));
}

Shape chart(const Run& run, FaceId face) {
  Shape shape;
  const FaceMesh& mesh = run.boundary.faces[face];
  for (std::size_t t = 0; t < mesh.triangle_slots(); ++t) {
    const FaceTriangle& triangle = mesh.triangle(TriangleId(t));
    if (!triangle.alive()) continue;
    Shown shown;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec2 q = mesh.node(triangle.node[k]).q;
      shown.corner[k] = {q.x, q.y, 0};
      shown.line[k] = triangle.use[k] >= 0 ? 1.3 : 0.5;
    }
    shape.push_back(shown);
  }
  return shape;
}

// --- the pictures ---

TopoDS_Shape cylinder_with_hole() {
  const TopoDS_Shape cylinder = BRepPrimAPI_MakeCylinder(4, 10).Shape();
  return BRepAlgoAPI_Cut(cylinder,
                         BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0, 0, 5), gp_Dir(1, -0.4, 0.2)), 1.8, 9).Shape())
      .Shape();
}

TopoDS_Shape shell(double outer, double inner) {
  return BRepAlgoAPI_Cut(BRepPrimAPI_MakeSphere(outer).Shape(), BRepPrimAPI_MakeSphere(inner).Shape()).Shape();
}

void draw_loading(const std::string& file, const std::string& folder) {
  Context context;
  LoadOptions load;
  load.isolate = false;
  const auto run = start(value_of(load_model(file, load, context)), 4, 40);
  const Shape faces = surface(
      *run, [](std::size_t, const SurfaceTriangle& t) { return colour_of_index(t.face.value()); }, 0);
  save(folder + "/loading.png", {faces});
}

void draw_sizes(const std::string& file, const std::string& folder) {
  Context context;
  LoadOptions load;
  load.isolate = false;
  const auto run = start(value_of(load_model(file, load, context)), 12, 12);
  const auto of_size = [&](std::size_t, const SurfaceTriangle& t) {
    Vec3 p{};
    for (VertexId v : t.vertices) p = p + (1.0 / 3) * run->vertices.position(v);
    const double share = std::clamp(std::log2(run->sizes.largest() / run->sizes.at_face(t.face, p)) / 3, 0.0, 1.0);
    return Rgb{static_cast<float>(0.55 + 0.4 * share), static_cast<float>(0.8 - 0.45 * share),
               static_cast<float>(0.95 - 0.7 * share)};
  };
  save(folder + "/sizes.png", {surface(*run, of_size)});
}

void draw_faces(const std::string& folder) {
  const auto run = start(model_of(cylinder_with_hole()), 2, 16);
  FaceId round;
  for (std::size_t f = 0; f < run->model.faces.size(); ++f)
    if (run->model.faces[FaceId(f)].loops.size() + run->boundary.faces[FaceId(f)].triangle_count() > 100 &&
        run->model.faces[FaceId(f)].surface->kind() == SurfaceKind::cylinder &&
        (!round.valid() ||
         run->boundary.faces[FaceId(f)].triangle_count() > run->boundary.faces[round].triangle_count()))
      round = FaceId(f);
  const auto colour = [&](std::size_t, const SurfaceTriangle& t) {
    return t.face == round ? kPlain : Rgb{0.93F, 0.93F, 0.9F};
  };
  save(folder + "/faces.png", {chart(*run, round), surface(*run, colour)}, {0.95, -0.8, 0.45}, {0});
}

void draw_tetrahedralization(const std::string& folder) {
  const auto run = start(model_of(BRepPrimAPI_MakeTorus(5, 2).Shape()), 1.5, 12);
  tetrahedralize(*run);
  const Shape before = surface(*run, [](std::size_t, const SurfaceTriangle&) { return kPlain; });
  save(folder + "/tetrahedralization.png", {before, solid(*run, [](TetId) { return kCut; })}, {1.2, -0.8, 0.9});
}

void draw_crossings(const std::string& folder) {
  const auto run = start(model_of(shell(10, 9.4)), 9, 0, false);
  const auto marked = [&] {
    std::set<std::size_t> crossing;
    for (const auto& [a, b] : crossing_pairs(run->vertices, surface_triangles(run->boundary), Context()))
      crossing.insert({a, b});
    return surface(*run, [&](std::size_t i, const SurfaceTriangle& t) {
      return crossing.contains(i) ? kRed : t.face == FaceId(0) ? kPlain : colour_of_index(1);
    });
  };
  const Shape before = marked();
  const CrossingResult cured = value_of(cure_crossings(*run->conjoint, {run->floor}, run->context));
  std::printf("crossings: %zu pairs, %zu points\n", cured.first_pairs, cured.points);
  save(folder + "/crossings.png", {before, marked()});
}

/// Thin bars that cross over each other: their long segments are missing from the Delaunay tetrahedralization.
TopoDS_Shape crossed_bars() {
  TopoDS_Compound bars;
  BRep_Builder builder;
  builder.MakeCompound(bars);
  for (int i = 0; i < 3; ++i) {
    builder.Add(bars, BRepPrimAPI_MakeBox(gp_Pnt(3.0 * i, 0, 0), 0.8, 10, 0.4).Shape());
    builder.Add(bars, BRepPrimAPI_MakeBox(gp_Pnt(-2, 2 + 3.0 * i, 0.6), 10.8, 0.8, 0.4).Shape());
  }
  return bars;
}

void draw_edges(const std::string& folder) {
  const auto run = start(model_of(crossed_bars()), 12, 0);
  value_of(cure_crossings(*run->conjoint, {run->floor}, run->context));
  tetrahedralize(*run);
  const auto missing = [&] {
    Shape shape = surface(*run, [](std::size_t, const SurfaceTriangle&) { return kPlain; });
    const std::vector<SurfaceTriangle> triangles = surface_triangles(run->boundary);
    std::size_t count = 0;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
      bool whole = true;
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId a = triangles[i].vertices[(k + 1) % 3], b = triangles[i].vertices[(k + 2) % 3];
        if (run->conjoint->segment_edge(a, b).valid() && !run->tets->find_edge(a, b)) whole = false;
      }
      if (!whole) shape[i].colour = kRed;
      count += whole ? 0 : 1;
    }
    std::printf("triangles at missing segments: %zu\n", count);
    return shape;
  };
  const Shape before = missing();
  EdgeRecoveryOptions options;
  options.floor = run->floor;
  const EdgeRecoveryResult done = value_of(recover_edges(*run->conjoint, options, run->context));
  std::printf("segments: %zu by flips, %zu split\n", done.flipped, done.splits);
  save(folder + "/edges.png", {before, missing()});
}

void draw_march(const std::string& folder) {
  const TopoDS_Shape tube =
      BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(3, 4).Shape(), BRepPrimAPI_MakeCylinder(2.5, 4).Shape());
  const auto run = start(model_of(tube), 3, 12);
  tetrahedralize(*run);
  const Shape before = surface(*run, [&](std::size_t, const SurfaceTriangle& t) {
    return run->tets->find_facet(t.vertices[0], t.vertices[1], t.vertices[2]) ? kPlain : kRed;
  });
  const FaceRecoveryResult done = value_of(recover_faces(*run->conjoint, {run->floor}, run->context));
  const Shape after = surface(*run, [&](std::size_t, const SurfaceTriangle& t) {
    const FacetKey key = facet_key(t.vertices[0], t.vertices[1], t.vertices[2]);
    return done.faces[t.face].marched.contains(key) ? kGreen : kPlain;
  });
  std::size_t brought_in = 0;
  for (std::size_t f = 0; f < run->model.faces.size(); ++f) brought_in += done.faces[FaceId(f)].marched.size();
  std::printf("march: %zu points, %zu facets brought in\n", done.points, brought_in);
  save(folder + "/march.png", {before, after}, {0.95, -0.8, 0.45});
}

TopoDS_Shape core_in_box() {
  const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-5, -5, -5), 10, 10, 10).Shape();
  const TopoDS_Shape core = BRepPrimAPI_MakeSphere(3.5).Shape();
  TopoDS_Compound both;
  BRep_Builder builder;
  builder.MakeCompound(both);
  builder.Add(both, BRepAlgoAPI_Cut(box, core).Shape());
  builder.Add(both, BRepPrimAPI_MakeTorus(gp_Ax2(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)), 1.8, 0.8).Shape());
  return both;
}

void draw_classification(const std::string& folder) {
  const auto run = start(model_of(core_in_box()), 2, 12);
  value_of(cure_crossings(*run->conjoint, {run->floor}, run->context));
  tetrahedralize(*run);
  recover(*run);
  const auto cut = [&](bool outside) {
    return solid(*run, [&, outside](TetId t) -> std::optional<Rgb> {
      const std::uint32_t region = run->tets->complex().region(t);
      if (!behind_cut(*run, t) || (region == 0 && !outside)) return std::nullopt;
      return region == 0 ? Rgb{0.95F, 0.95F, 0.95F} : colour_of_index(region);
    });
  };
  save(folder + "/classification.png", {cut(true), cut(false)}, {1.4, -0.7, 0.6});
}

/// Moves the vertex inside that is nearest to the middle out of its star.
void displace_a_vertex(Run& run) {
  VertexId nearest;
  for (std::size_t v = 0; v < run.vertices.size(); ++v)
    if (run.tets->contains(VertexId(v)) && run.vertices.owner(VertexId(v)).kind == OwnerKind::interior &&
        (!nearest.valid() || norm(run.vertices.position(VertexId(v))) < norm(run.vertices.position(nearest))))
      nearest = VertexId(v);
  run.vertices.move(nearest, snap(run.vertices.position(nearest) + Vec3{0.05, 0.1, 0.15}));
}

void draw_volume(const std::string& folder) {
  const auto run = start(model_of(cylinder_with_hole()), 1.6, 12);
  value_of(cure_crossings(*run->conjoint, {run->floor}, run->context));
  tetrahedralize(*run);
  recover(*run);
  const auto inside = [&](TetId t) { return run->tets->complex().region(t) > 0; };
  const auto half = [&] {
    return solid(*run,
                 [&](TetId t) { return inside(t) && behind_cut(*run, t) ? std::optional<Rgb>(kCut) : std::nullopt; });
  };
  const auto flat = [&] {
    return solid(*run, [&](TetId t) {
      return inside(t) && worst_angle(*run, t) < 18 ? std::optional<Rgb>(kRed) : std::nullopt;
    });
  };
  const Shape empty = half();
  value_of(refine_interior(*run->tets, run->vertices, run->sizes, {}, run->context));
  save(folder + "/refinement.png", {empty, half()}, {1.4, -0.7, 0.6});
  const Shape bad = flat();
  const ImproveResult done = value_of(improve(*run->tets, run->vertices, {}, run->context));
  std::printf("improvement: worst %.2f to %.2f degrees; flat facets %zu to %zu\n", done.worst_before, done.worst_after,
              bad.size(), flat().size());
  save(folder + "/improvement.png", {bad, half()}, {1.4, -0.7, 0.6});
  displace_a_vertex(*run);
  const Shape inverted = solid(
      *run, [&](TetId t) { return inside(t) && worst_angle(*run, t) <= 0 ? std::optional<Rgb>(kRed) : std::nullopt; });
  save(folder + "/validation.png", {half(), inverted}, {1.4, -0.7, 0.6});
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: stage_pictures VALVE_BODY.step FOLDER\n", stderr);
    return 2;
  }
  const std::string file = argv[1], folder = argv[2];
  draw_loading(file, folder);
  draw_sizes(file, folder);
  draw_faces(folder);
  draw_tetrahedralization(folder);
  draw_crossings(folder);
  draw_edges(folder);
  draw_march(folder);
  draw_classification(folder);
  draw_volume(folder);
  return 0;
}
