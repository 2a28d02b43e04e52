// Operations that the stages repeat most: evaluating and projecting on surfaces by kind, box trees, smoothing a star,
// looking for swaps.
#include <benchmark/benchmark.h>

#include <GeomAPI_PointsToBSplineSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "base/box_tree.h"
#include "cad/occt_geometry.h"
#include "geometry/analytic.h"
#include "geometry/frame.h"
#include "point_clouds.h"
#include "spatial/flips.h"
#include "spatial/tetrahedralization.h"
#include "volume/improve.h"
#include "volume/shape.h"

namespace curvetet::bench {
namespace {

// --- surfaces ---

/// A surface and the part of it that is evaluated.
struct Patch {
  std::unique_ptr<Surface> surface;
  Vec2 low, high;
};

/// Through a wavy grid of 20 x 20 points, 100 by 100 units of the CAD; cubic.
Patch make_bspline() {
  TColgp_Array2OfPnt points(1, 20, 1, 20);
  Box3 box;
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) {
      const Vec3 p{100.0 / 19 * i, 100.0 / 19 * j, 8 * std::sin(0.5 * i) * std::cos(0.4 * j)};
      points.SetValue(i + 1, j + 1, gp_Pnt(p.x, p.y, p.z));
      box.extend(p);
    }
  }
  GeomAPI_PointsToBSplineSurface interpolation;
  interpolation.Interpolate(points);
  Patch patch;
  interpolation.Surface()->Bounds(patch.low.x, patch.high.x, patch.low.y, patch.high.y);
  patch.surface = make_surface(interpolation.Surface(), Frame::of(box));
  return patch;
}

Patch make_patch(SurfaceKind kind) {
  constexpr double kThird = 1.0 / 3, kTurn = 2 * std::numbers::pi;
  const Placement at{{0.1, -0.05, 0.02},
                     {2 * kThird, 2 * kThird, kThird},
                     {-2 * kThird, kThird, 2 * kThird},
                     {kThird, -2 * kThird, 2 * kThird},
                     1};
  switch (kind) {
    case SurfaceKind::plane:
      return {make_plane(at), {-0.3, -0.3}, {0.3, 0.3}};
    case SurfaceKind::cylinder:
      return {make_cylinder(at, 0.2), {0, -0.3}, {kTurn, 0.3}};
    case SurfaceKind::cone:
      return {make_cone(at, 0.2, 0.4), {0, -0.3}, {kTurn, 0.3}};
    case SurfaceKind::sphere:
      return {make_sphere(at, 0.3), {0, -1.4}, {kTurn, 1.4}};
    case SurfaceKind::torus:
      return {make_torus(at, 0.25, 0.1), {0, 0}, {kTurn, kTurn}};
    default:
      return make_bspline();
  }
}

/// Parameters of 64 x 64 places, row by row or shuffled: OpenCASCADE caches the span of a B-spline it was last in.
std::vector<Vec2> parameters(const Patch& patch, bool shuffled) {
  std::vector<Vec2> out;
  const Vec2 step = 1.0 / 64 * (patch.high - patch.low);
  out.reserve(64 * 64);
  for (int j = 0; j < 64; ++j)
    for (int i = 0; i < 64; ++i) out.push_back(patch.low + Vec2{(i + 0.5) * step.x, (j + 0.5) * step.y});
  if (shuffled) std::shuffle(out.begin(), out.end(), std::mt19937(1));
  return out;
}

void second(benchmark::State& state) {
  const auto kind = static_cast<SurfaceKind>(state.range(0));
  const Patch patch = make_patch(kind);
  const std::vector<Vec2> at = parameters(patch, state.range(1) != 0);
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(patch.surface->second(at[k]));
    k = (k + 1) % at.size();
  }
  state.SetItemsProcessed(state.iterations());
  state.SetLabel(name(patch.surface->kind()));
}

/// Of points a little off the surface, from a guess as good as a neighbour in the mesh gives.
void project(benchmark::State& state) {
  const auto kind = static_cast<SurfaceKind>(state.range(0));
  const Patch patch = make_patch(kind);
  const std::vector<Vec2> at = parameters(patch, state.range(1) != 0);
  const Vec2 aside = 0.02 * (patch.high - patch.low);
  std::vector<Vec3> points;
  points.reserve(at.size());
  for (const Vec2 uv : at) points.push_back(patch.surface->value(uv) + 0.002 * patch.surface->normal(uv));
  std::size_t k = 0;
  double found = 0;
  for (auto _ : state) {
    const std::optional<Vec2> uv = patch.surface->project(points[k], at[k] + aside);
    found += uv && distance(*uv, at[k]) < 1e-9 ? 1 : 0;
    k = (k + 1) % at.size();
  }
  state.SetItemsProcessed(state.iterations());
  state.SetLabel(name(patch.surface->kind()));
  state.counters["found"] = found / static_cast<double>(state.iterations());
}

void each_kind(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"kind", "shuffled"});
  for (const SurfaceKind kind : {SurfaceKind::plane, SurfaceKind::cylinder, SurfaceKind::cone, SurfaceKind::sphere,
                                 SurfaceKind::torus, SurfaceKind::bspline})
    benchmark->Args({static_cast<std::int64_t>(kind), 0});
  benchmark->Args({static_cast<std::int64_t>(SurfaceKind::bspline), 1});
}
BENCHMARK(second)->Apply(each_kind);
BENCHMARK(project)->Apply(each_kind);

// --- box trees ---

using Triangle = std::array<Vec3, 3>;

/// 100000 of a sphere without its poles, in rows, as a face mesh lists them.
std::vector<Triangle> sphere_triangles() {
  const Patch patch = make_patch(SurfaceKind::sphere);
  const Vec2 step{(patch.high.x - patch.low.x) / 250, (patch.high.y - patch.low.y) / 200};
  const auto corner = [&](int i, int j) { return patch.surface->value(patch.low + Vec2{i * step.x, j * step.y}); };
  std::vector<Triangle> triangles;
  for (int j = 0; j < 200; ++j) {
    for (int i = 0; i < 250; ++i) {
      triangles.push_back({corner(i, j), corner(i + 1, j), corner(i, j + 1)});
      triangles.push_back({corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)});
    }
  }
  return triangles;
}

std::vector<Box3> boxes_of(const std::vector<Triangle>& triangles) {
  std::vector<Box3> boxes(triangles.size());
  for (std::size_t k = 0; k < boxes.size(); ++k)
    for (const Vec3 p : triangles[k]) boxes[k].extend(p);
  return boxes;
}

void box_tree_build(benchmark::State& state) {
  const std::vector<Box3> boxes = boxes_of(sphere_triangles());
  for (auto _ : state) {
    const BoxTree tree(boxes);
    benchmark::DoNotOptimize(tree.items().data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(boxes.size()));
}
BENCHMARK(box_tree_build)->Unit(benchmark::kMillisecond);

/// Each triangle's box, as the search for crossings asks.
void box_tree_overlaps(benchmark::State& state) {
  const std::vector<Box3> boxes = boxes_of(sphere_triangles());
  const BoxTree tree(boxes);
  std::vector<std::uint32_t> near;
  std::size_t k = 0, met = 0;
  for (auto _ : state) {
    near.clear();
    tree.overlaps(boxes[k], near);
    met += near.size();
    k = (k + 1) % boxes.size();
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["met"] = static_cast<double>(met) / static_cast<double>(state.iterations());
}
BENCHMARK(box_tree_overlaps);

/// The triangle whose middle is nearest to a point: beside the sphere, or nearer to its centre than to it.
void box_tree_nearest(benchmark::State& state) {
  const std::vector<Triangle> triangles = sphere_triangles();
  const BoxTree tree(boxes_of(triangles));
  const Patch patch = make_patch(SurfaceKind::sphere);
  const double off = state.range(0) != 0 ? -0.2 : 0.001;
  std::vector<Vec3> points, middles;
  for (const Vec2 uv : parameters(patch, true))
    points.push_back(patch.surface->value(uv) + off * patch.surface->normal(uv));
  for (const Triangle& t : triangles) middles.push_back(1.0 / 3 * (t[0] + t[1] + t[2]));
  std::size_t k = 0, asked = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(tree.nearest(points[k], [&](std::uint32_t i) {
      ++asked;
      return norm2(middles[i] - points[k]);
    }));
    k = (k + 1) % points.size();
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["asked"] = static_cast<double>(asked) / static_cast<double>(state.iterations());
}
BENCHMARK(box_tree_nearest)->ArgName("far")->Arg(0)->Arg(1);

// --- improvement ---

/// Delaunay, of random points: many of its tets are bad.
struct RandomTets {
  RandomTets() { CURVETET_CHECK(mesh.build(all_vertices(store), Context()).ok()); }
  double quality(TetId t) const {
    const auto& v = mesh.complex().vertices(t);
    return least_sine(store.position(v[0]), store.position(v[1]), store.position(v[2]), store.position(v[3]));
  }
  /// What improvement works on, with their quality.
  std::vector<std::pair<TetId, double>> bad_tets() const {
    const double goal = std::sin(ImproveOptions().goal * std::numbers::pi / 180);
    const TetComplex& complex = mesh.complex();
    std::vector<std::pair<TetId, double>> tets;
    for (TetId t(0U); t.value() < complex.slots(); t = TetId(t.value() + 1))
      if (complex.is_alive(t) && !complex.is_ghost(t) && quality(t) < goal) tets.emplace_back(t, quality(t));
    return tets;
  }

  VertexStore store = make_store(make_cloud(Cloud::cube, 20000));
  Tetrahedralization mesh{store, 1};
};

/// The facets that a vertex sees; none for one on the hull.
StarFacets facets_of_star(const RandomTets& tets, VertexId v) {
  const TetComplex& complex = tets.mesh.complex();
  std::vector<TetId> star;
  tets.mesh.star(v, star);
  StarFacets facets;
  for (const TetId t : star) {
    if (complex.is_ghost(t)) return {};
    const auto f = complex.facet_vertices({t, complex.local(t, v)});
    facets.push_back({tets.store.position(f[0]), tets.store.position(f[1]), tets.store.position(f[2])});
  }
  return facets;
}

void optimise_star(benchmark::State& state) {
  const RandomTets tets;
  std::vector<std::pair<StarFacets, Vec3>> stars;
  for (VertexId v(0U); stars.size() < 1000; v = VertexId(v.value() + 1)) {
    StarFacets facets = facets_of_star(tets, v);
    if (!facets.empty()) stars.emplace_back(std::move(facets), tets.store.position(v));
  }
  StarOptimiser optimiser;
  std::size_t k = 0;
  double moved = 0;
  for (auto _ : state) {
    moved += optimiser.optimise(stars[k].first, stars[k].second) == stars[k].second ? 0 : 1;
    k = (k + 1) % stars.size();
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["moved"] = moved / static_cast<double>(state.iterations());
}
BENCHMARK(optimise_star)->Unit(benchmark::kMicrosecond);

/// find(mesh, tet, k, quality of the tet) for the edges or facets k < places of each bad tet.
template <class Find>
void over_bad_tets(benchmark::State& state, std::size_t places, const Find& find) {
  const RandomTets tets;
  const std::vector<std::pair<TetId, double>> bad = tets.bad_tets();
  std::size_t k = 0;
  double found = 0;
  for (auto _ : state) {
    const auto& [t, quality] = bad[k / places];
    found += find(tets.mesh, t, k % places, quality) ? 1 : 0;
    k = (k + 1) % (places * bad.size());
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["found"] = found / static_cast<double>(state.iterations());
}

void edge_removal(benchmark::State& state) {
  over_bad_tets(state, 6, [](const Tetrahedralization& mesh, TetId t, std::size_t edge, double quality) {
    return find_edge_removal(mesh, {t, kEdge[edge][0], kEdge[edge][1]}, least_sine, quality).has_value();
  });
}
void faces_removal(benchmark::State& state) {
  over_bad_tets(state, 4, [](const Tetrahedralization& mesh, TetId t, std::size_t facet, double quality) {
    return find_faces_removal(mesh, {t, static_cast<int>(facet)}, least_sine, quality).has_value();
  });
}
BENCHMARK(edge_removal);
BENCHMARK(faces_removal);

}  // namespace
}  // namespace curvetet::bench

BENCHMARK_MAIN();
