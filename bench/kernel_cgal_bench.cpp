// Building, next to CGAL's Delaunay_triangulation_3 on the same points in the same process: only the ratio means
// anything on a shared machine.
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <benchmark/benchmark.h>

#include "point_clouds.h"
#include "spatial/tetrahedralization.h"

namespace curvetet::bench {
namespace {

void curvetet_build(benchmark::State& state) {
  const auto cloud = static_cast<Cloud>(state.range(0));
  const VertexStore store = make_store(make_cloud(cloud, static_cast<std::size_t>(state.range(1))));
  const std::vector<VertexId> ids = all_vertices(store);
  const Context context;
  for (auto _ : state) {
    Tetrahedralization mesh(store, 1);
    if (!mesh.build(ids, context).ok()) state.SkipWithError("no tetrahedralization");
  }
  state.SetLabel(name(cloud));
}

void cgal_build(benchmark::State& state) {
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  const auto cloud = static_cast<Cloud>(state.range(0));
  std::vector<Kernel::Point_3> points;
  for (const Vec3 p : make_cloud(cloud, static_cast<std::size_t>(state.range(1)))) points.emplace_back(p.x, p.y, p.z);
  for (auto _ : state) {
    const CGAL::Delaunay_triangulation_3<Kernel> mesh(points.begin(), points.end());
    benchmark::DoNotOptimize(mesh.number_of_cells());
  }
  state.SetLabel(name(cloud));
}

void register_pair(Cloud cloud, std::int64_t n) {
  const std::int64_t index = static_cast<std::int64_t>(cloud);
  benchmark::RegisterBenchmark("curvetet", curvetet_build)->Args({index, n})->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark("cgal", cgal_build)->Args({index, n})->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace curvetet::bench

int main(int argc, char** argv) {
  using curvetet::bench::Cloud;
  for (const Cloud cloud :
       {Cloud::cube, Cloud::sphere, Cloud::cylinder, Cloud::torus, Cloud::lattice, Cloud::plane_grids}) {
    curvetet::bench::register_pair(cloud, 100000);
  }
  curvetet::bench::register_pair(Cloud::cube, 1000000);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
