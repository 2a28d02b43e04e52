// Predicates by rung, building by point cloud, location, cavities, single insertion, memory per tet.
#include <benchmark/benchmark.h>

#include <boost/multiprecision/cpp_int.hpp>

#include "point_clouds.h"
#include "predicates/predicates.h"
#include "spatial/tetrahedralization.h"

namespace curvetet::bench {
namespace {

/// Five points as the kernel meets them: of a cluster in the cloud.
std::vector<Vec3> clusters(Cloud cloud) {
  const std::vector<Vec3> points = make_cloud(cloud, 4096);
  std::vector<Vec3> out;
  for (std::size_t k = 0; k < 1024; ++k) {
    for (std::size_t j = 0; j < 5; ++j) out.push_back(points[(k * 37 + j * (1 + k % 17)) % points.size()]);
  }
  return out;
}

template <class Predicate>
void over_fives(benchmark::State& state, Cloud cloud, Predicate predicate) {
  const std::vector<Vec3> p = clusters(cloud);
  std::size_t k = 0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(predicate(p[k], p[k + 1], p[k + 2], p[k + 3], p[k + 4]));
    k = k + 5 < p.size() ? k + 5 : 0;
  }
}

void orient3d_filter(benchmark::State& state) {
  over_fives(state, Cloud::cube,
             [](Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3) { return rungs::orient3d_filter(a, b, c, d); });
}
void orient3d_exact(benchmark::State& state) {
  over_fives(state, Cloud::cube,
             [](Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3) { return rungs::orient3d_exact(a, b, c, d); });
}
void insphere_filter(benchmark::State& state) { over_fives(state, Cloud::cube, rungs::insphere_filter); }
void insphere_extended(benchmark::State& state) { over_fives(state, Cloud::lattice, rungs::insphere_extended); }
void insphere_exact(benchmark::State& state) { over_fives(state, Cloud::cube, rungs::insphere_exact); }

/// What the columns replace: the same cofactors in a fixed-width integer of a library.
int insphere_boost(Vec3 a, Vec3 b, Vec3 c, Vec3 d, Vec3 e) {
  using Integer = boost::multiprecision::int256_t;
  const auto row = [&](Vec3 p) {
    const auto step = [](double x) { return Integer(static_cast<std::int64_t>(x * 0x1p42)); };
    return std::array<Integer, 3>{step(p.x - e.x), step(p.y - e.y), step(p.z - e.z)};
  };
  const auto p = row(a), q = row(b), r = row(c), s = row(d);
  const auto minor = [](const auto& u, const auto& v) { return Integer(u[0] * v[1] - u[1] * v[0]); };
  const auto lift = [](const auto& u) { return Integer(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]); };
  const Integer pq = minor(p, q), qr = minor(q, r), rs = minor(r, s), sp = minor(s, p), pr = minor(p, r),
                qs = minor(q, s);
  const Integer det = lift(p) * (q[2] * rs - r[2] * qs + s[2] * qr) - lift(q) * (r[2] * sp + s[2] * pr + p[2] * rs) +
                      lift(r) * (s[2] * pq + p[2] * qs + q[2] * sp) - lift(s) * (p[2] * qr - q[2] * pr + r[2] * pq);
  return det.sign();
}
void insphere_boost_int256(benchmark::State& state) { over_fives(state, Cloud::cube, insphere_boost); }

BENCHMARK(orient3d_filter);
BENCHMARK(orient3d_exact);
BENCHMARK(insphere_filter);
BENCHMARK(insphere_extended);
BENCHMARK(insphere_exact);
BENCHMARK(insphere_boost_int256);

void build(benchmark::State& state) {
  const auto cloud = static_cast<Cloud>(state.range(0));
  const VertexStore store = make_store(make_cloud(cloud, static_cast<std::size_t>(state.range(1))));
  const std::vector<VertexId> ids = all_vertices(store);
  const Context context;
  double tets = 0, bytes = 0;
  predicate_counts() = {};
  for (auto _ : state) {
    Tetrahedralization mesh(store, 1);
    if (!mesh.build(ids, context).ok()) state.SkipWithError("no tetrahedralization");
    tets = static_cast<double>(mesh.complex().alive());
    bytes = static_cast<double>(mesh.bytes());
  }
  const auto runs = static_cast<double>(state.iterations());
  state.SetLabel(name(cloud));
  state.counters["points/s"] = benchmark::Counter(runs * static_cast<double>(ids.size()), benchmark::Counter::kIsRate);
  state.counters["tets/s"] = benchmark::Counter(runs * tets, benchmark::Counter::kIsRate);
  state.counters["bytes/tet"] = bytes / tets;
  const PredicateCounts& counts = predicate_counts();
  state.counters["exact/tet"] = static_cast<double>(counts.extended + counts.exact) / (runs * tets);
}
BENCHMARK(build)->ArgsProduct({{0, 1, 2, 3, 4, 5}, {100000}})->Unit(benchmark::kMillisecond);
BENCHMARK(build)->ArgsProduct({{0, 1, 2, 3, 4}, {1000000}})->Unit(benchmark::kMillisecond);
BENCHMARK(build)->Args({0, 4000000})->Unit(benchmark::kMillisecond);

VertexId near_vertex(const Tetrahedralization& mesh, Vec3 p) {
  const TetId t = mesh.locate(p);
  return mesh.complex().vertex(t, mesh.complex().vertex(t, 0) == kInfinite ? 1 : 0);
}

/// Random points in a cube, the first 100000 of them in a tetrahedralization, with a vertex near each of the others.
struct Waiting {
  static constexpr std::size_t kInserted = 100000, kWaiting = 10000;
  Waiting() {
    const std::vector<VertexId> ids = all_vertices(store);
    CURVETET_CHECK(mesh.build(std::span(ids).first(kInserted), Context()).ok());
    for (std::size_t k = 0; k < kWaiting; ++k) near.push_back(near_vertex(mesh, store.position(vertex(k))));
  }
  static VertexId vertex(std::size_t k) { return VertexId(kInserted + k); }

  VertexStore store = make_store(make_cloud(Cloud::cube, kInserted + kWaiting));
  Tetrahedralization mesh{store, 1};
  std::vector<VertexId> near;
};

void locate(benchmark::State& state) {
  const Waiting waiting;
  const bool hint = state.range(0) != 0;
  std::size_t k = 0;
  for (auto _ : state) {
    const Vec3 p = waiting.store.position(Waiting::vertex(k));
    benchmark::DoNotOptimize(waiting.mesh.locate(p, hint ? waiting.mesh.tet_of(waiting.near[k]) : TetId()));
    k = (k + 1) % Waiting::kWaiting;
  }
  state.SetItemsProcessed(state.iterations());
}
BENCHMARK(locate)->ArgName("hint")->Arg(1)->Arg(0);

void find_cavity(benchmark::State& state) {
  const Waiting waiting;
  std::size_t k = 0, tets = 0;
  for (auto _ : state) {
    const Cavity cavity = waiting.mesh.find_cavity(Waiting::vertex(k), waiting.mesh.tet_of(waiting.near[k]));
    tets += cavity.tets.size();
    k = (k + 1) % Waiting::kWaiting;
  }
  state.SetItemsProcessed(state.iterations());
  state.counters["tets/cavity"] = static_cast<double>(tets) / static_cast<double>(state.iterations());
}
BENCHMARK(find_cavity);

/// find_cavity and commit with all their judging, as refinement uses them: the hint is a tet at a near vertex.
void insert_one_by_one(benchmark::State& state) {
  const std::vector<Vec3> points = make_cloud(Cloud::cube, 40000);
  const VertexStore store = make_store(points);
  const std::vector<VertexId> ids = all_vertices(store);
  const Context context;
  for (auto _ : state) {
    state.PauseTiming();
    Tetrahedralization mesh(store, 1);
    if (!mesh.build(std::span(ids).first(20000), context).ok()) state.SkipWithError("no tetrahedralization");
    std::vector<VertexId> near(ids.size());
    for (std::size_t k = 20000; k < ids.size(); ++k) near[k] = near_vertex(mesh, points[k]);
    state.ResumeTiming();
    for (std::size_t k = 20000; k < ids.size(); ++k) mesh.insert(ids[k], mesh.tet_of(near[k]));
  }
  state.counters["points/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * 20000, benchmark::Counter::kIsRate);
}
BENCHMARK(insert_one_by_one)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace curvetet::bench

BENCHMARK_MAIN();
