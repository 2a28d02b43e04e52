#include "support/run_boundary.h"

#include <gtest/gtest.h>

#include <map>

#include "boundary/cure_crossings.h"
#include "boundary/surface_triangles.h"
#include "boundary/surround.h"

namespace curvetet::test {

namespace {

std::vector<VertexId> surface_vertices(const BoundaryRun& run) {
  std::vector<char> used(run.vertices.size(), 0);
  for (const SurfaceTriangle& t : surface_triangles(run.boundary))
    for (VertexId v : t.vertices) used[v.value()] = 1;
  std::vector<VertexId> list;
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v]) list.push_back(VertexId(v));
  return list;
}

void recover(BoundaryRun& run, bool as_paper, const FaceRecoveryOptions& options, Context& context) {
  if (as_paper) {
    auto r = recover_faces_as_paper(*run.conjoint, options, context);
    ASSERT_TRUE(r.ok());
    run.recovery = std::move(r.value().recovery);
    run.paper = r.value().counts;
  } else {
    auto r = recover_faces(*run.conjoint, options, context);
    ASSERT_TRUE(r.ok());
    run.recovery = std::move(r.value());
  }
}

void run_stages(const Model& model, const BoundaryRunOptions& options, BoundaryRun& run, Context& context) {
  SizingOptions sizing;
  sizing.size = model.frame.length_to_working(options.size);
  sizing.curvature = options.curvature;
  sizing.gaps = options.gaps;
  auto sizes = make_size_field(model, sizing, context);
  ASSERT_TRUE(sizes.ok()) << sizes.error().message;
  run.sizes = std::move(sizes.value());
  BoundaryOptions front_options;
  front_options.smooth_faces = options.smooth;
  auto front = mesh_boundary(model, run.sizes, run.vertices, front_options, context);
  ASSERT_TRUE(front.ok()) << front.error().message;
  for (const FaceFailure& f : front.value().failures) ADD_FAILURE() << f.cause << ": " << f.detail;
  run.boundary = std::move(front.value().mesh);
  run.conjoint = std::make_unique<Conjoint>(model, run.vertices, run.boundary, [&](FaceId f) {
    return spatial_criterion(run.boundary.faces[f], run.vertices, model.faces[f]);
  });
  if (options.until == Until::faces) return;
  const double floor = sizing.size / 256;
  if (!options.as_paper) {
    auto crossings = cure_crossings(*run.conjoint, {floor}, context);
    ASSERT_TRUE(crossings.ok());
    run.crossings = crossings.value();
  }
  if (options.until == Until::crossings) return;
  run.tets = std::make_unique<Tetrahedralization>(run.vertices, 1);
  std::vector<VertexId> vertices = surface_vertices(run);
  add_surrounding(run.vertices, vertices);
  const Status built = run.tets->build(vertices, context);
  ASSERT_TRUE(built.ok()) << built.error().message;
  run.conjoint->attach(run.tets.get());
  if (options.until == Until::tets) return;
  FaceRecoveryOptions recovery = options.recovery;
  recovery.floor = floor;
  recover(run, options.as_paper, recovery, context);
  if (options.until == Until::recovery || !run.recovery.failures.empty()) return;
  run.classified = classify(*run.conjoint);
}

}  // namespace

std::unique_ptr<BoundaryRun> run_boundary(const Model& model, const BoundaryRunOptions& options) {
  auto run = std::make_unique<BoundaryRun>();
  Context context;
  context.threads = options.threads;
  run_stages(model, options, *run, context);
  return run;
}

std::vector<std::string> check_recovered(const Model& model, const BoundaryRun& run) {
  std::vector<std::string> broken;
  std::map<FacetKey, FaceId> claimed;
  for (const SurfaceTriangle& t : surface_triangles(run.boundary)) {
    const auto facet = run.tets->find_facet(t.vertices[0], t.vertices[1], t.vertices[2]);
    if (!facet) {
      broken.push_back("a triangle of T is no facet");
    } else if (run.tets->complex().locked_face(*facet) != t.face) {
      broken.push_back("a facet is not locked for its face");
    }
    if (!claimed.emplace(facet_key(t.vertices[0], t.vertices[1], t.vertices[2]), t.face).second)
      broken.push_back("two triangles claim one facet");
    for (VertexId v : t.vertices) {
      const auto& faces = run.conjoint->faces_of(v);
      if (std::find(faces.begin(), faces.end(), t.face) == faces.end())
        broken.push_back("a vertex is not on its face (I)");
    }
  }
  // IV and V over vertex ids: an edge of one face has two triangles, or as many as the face uses its curve.
  for (std::size_t f = 0; f < model.faces.size(); ++f) {
    std::map<std::uint64_t, int> count, uses;
    for (const UseRef& use : run.boundary.uses[FaceId(f)]) {
      const auto& chain = run.boundary.curves[use.edge].vertices;
      for (std::size_t i = 0; i + 1 < chain.size(); ++i) ++uses[edge_key(chain[i], chain[i + 1])];
    }
    for (const SurfaceTriangle& t : surface_triangles(run.boundary.faces[FaceId(f)], FaceId(f)))
      for (std::size_t k = 0; k < 3; ++k) ++count[edge_key(t.vertices[k], t.vertices[(k + 1) % 3])];
    for (const auto& [edge, n] : count)
      if (n != (uses.count(edge) ? uses[edge] : 2)) broken.push_back("an edge has a wrong number of triangles (IV, V)");
  }
  const auto locked = locked_facets(*run.tets, model.faces.size());
  for (std::size_t f = 0; f < model.faces.size(); ++f)
    if (locked[FaceId(f)] != facets_of(run.boundary.faces[FaceId(f)], FaceId(f)))
      broken.push_back("facets are locked for a face that are not in its T");
  return broken;
}

}  // namespace curvetet::test
