// Face meshes: insertion of points in random and in local order, location, construction from loops, splits.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "planar/face_mesh.h"
#include "predicates/predicates.h"

namespace curvetet::bench {
namespace {

Vec2 on_grid(Vec2 q) { return {std::nearbyint(q.x * 0x1p42) * 0x1p-42, std::nearbyint(q.y * 0x1p42) * 0x1p-42}; }

LoopInput circle(Vec2 centre, double radius, std::uint32_t n, std::uint32_t first, std::int32_t use) {
  ChainInput chain;
  chain.use = use;
  for (std::uint32_t i = 0; i <= n; ++i) {
    const double t = 2 * std::numbers::pi * (i % n) / n;
    chain.vertices.push_back(VertexId(first + i % n));
    chain.q.push_back(on_grid(centre + std::abs(radius) * Vec2{std::cos(t), std::sin(t)}));
  }
  if (radius < 0) {
    std::reverse(chain.vertices.begin(), chain.vertices.end());
    std::reverse(chain.q.begin(), chain.q.end());
  }
  return {{chain}, false};
}

/// A disc of n segments with fifty holes of n / 50.
FaceInput sieve(std::uint32_t n) {
  FaceInput input{{circle({0, 0}, 0.5, n, 0, 0)}, {}};
  for (std::uint32_t k = 0; k < 50; ++k) {
    const Vec2 centre{-0.3 + 0.06 * (k % 10), -0.3 + 0.1 * (k / 10)};
    input.loops.push_back(circle(centre, -0.02, n / 50, (k + 1) * n, static_cast<std::int32_t>(k + 1)));
  }
  return input;
}

FaceMesh square() {
  ChainInput chain;
  for (const std::uint32_t k : {0U, 1U, 2U, 3U, 0U}) {
    chain.vertices.push_back(VertexId(k));
    chain.q.push_back({k == 1 || k == 2 ? 0.5 : -0.5, k >= 2 ? 0.5 : -0.5});
  }
  FaceMesh mesh;
  mesh.build({{{{chain}, false}}, {}});
  return mesh;
}

std::vector<Vec2> points(std::size_t n, bool local) {
  std::mt19937 random(1);
  std::vector<Vec2> out;
  for (std::size_t i = 0; i < n; ++i) {
    const auto draw = [&random] { return static_cast<double>(random()) * 0x1p-32 - 0.5; };
    const double x = draw();
    out.push_back(on_grid({x, draw()}));
  }
  if (!local) return out;
  const double rows = std::sqrt(static_cast<double>(n) / 4);  // back and forth, row by row
  std::sort(out.begin(), out.end(), [rows](Vec2 a, Vec2 b) {
    const auto row = [rows](Vec2 q) { return static_cast<int>((q.x + 0.5) * rows); };
    if (row(a) != row(b)) return row(a) < row(b);
    return row(a) % 2 == 0 ? a.y < b.y : a.y > b.y;
  });
  return out;
}

FaceMesh::FlipWanted delaunay(const FaceMesh& mesh) {
  return [&mesh](NodeId a, NodeId b, NodeId c, NodeId d) {
    return incircle(mesh.node(a).q, mesh.node(b).q, mesh.node(c).q, mesh.node(d).q) > 0;
  };
}

void insert_all(FaceMesh& mesh, const std::vector<Vec2>& at) {
  const auto wanted = delaunay(mesh);
  std::vector<TriangleId> changed;
  TriangleId hint;
  std::uint32_t vertex = 10;
  for (const Vec2 q : at) {
    if (const auto t = mesh.locate(q, hint)) mesh.insert(VertexId(vertex++), q, *t, wanted, changed);
    if (!changed.empty()) hint = changed.front();
  }
}

void insert(benchmark::State& state) {
  const std::vector<Vec2> at = points(static_cast<std::size_t>(state.range(0)), state.range(1) != 0);
  for (auto _ : state) {
    FaceMesh mesh = square();
    insert_all(mesh, at);
    benchmark::DoNotOptimize(mesh.triangle_count());
  }
  state.SetItemsProcessed(state.iterations() * state.range(0));
}
BENCHMARK(insert)->ArgNames({"points", "local"})->Args({100000, 1})->Args({100000, 0})->Unit(benchmark::kMillisecond);

void locate(benchmark::State& state) {
  FaceMesh mesh = square();
  insert_all(mesh, points(100000, true));
  const std::vector<Vec2> at = points(1000, false);
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(mesh.locate(static_cast<double>(state.range(0)) * at[k]));
    k = (k + 1) % at.size();
  }
}
BENCHMARK(locate)->ArgName("spread")->Arg(1)->Arg(2);

void build(benchmark::State& state) {
  const FaceInput input = sieve(static_cast<std::uint32_t>(state.range(0)));
  for (auto _ : state) {
    FaceMesh mesh;
    benchmark::DoNotOptimize(mesh.build(input));
  }
  state.SetItemsProcessed(2 * state.iterations() * state.range(0));
}
BENCHMARK(build)->ArgName("rim")->Arg(1000)->Arg(5000)->Arg(50000)->Unit(benchmark::kMillisecond);

void split(benchmark::State& state) {
  FaceMesh start;
  start.build(sieve(10000));
  for (auto _ : state) {
    FaceMesh mesh = start;
    const auto wanted = delaunay(mesh);
    std::vector<TriangleId> changed;
    for (std::uint32_t k = 0; k < 10000; ++k) {
      const NodeId a = mesh.nodes_of(VertexId(k)).front(), b = mesh.nodes_of(VertexId((k + 1) % 10000)).front();
      const Vec2 middle = mesh.node(a).q + mesh.node(b).q;
      mesh.split(*mesh.find_edge(a, b), VertexId(1000000 + k), on_grid((0.5 / norm(middle)) * middle), wanted, changed);
    }
    benchmark::DoNotOptimize(mesh.triangle_count());
  }
  state.SetItemsProcessed(state.iterations() * 10000);
}
BENCHMARK(split)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace curvetet::bench

BENCHMARK_MAIN();
