// The Delaunay kernel on random points, uniform in a cube and graded towards its centre as around a small
// body; beside CGAL's where that is installed. Items are tets. Each measures from the points to the finished
// triangulation.

#include "generate/generate.h"

#include "base/random.h"

#include <benchmark/benchmark.h>

#ifdef KROPLA_BENCH_CGAL
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#endif

namespace kropla {
namespace {

std::vector<Vec3> uniform_points(std::int64_t n) {
    Random random{1};
    std::vector<Vec3> points(static_cast<std::size_t>(n));
    for (Vec3& p : points) p = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    return points;
}

/// Distances from the centre are the cubes of those of uniform points: the spacing there is a thousandth and
/// less.
std::vector<Vec3> graded_points(std::int64_t n) {
    std::vector<Vec3> points = uniform_points(n);
    for (Vec3& p : points) p *= squared_norm(p);
    return points;
}

void sizes(benchmark::internal::Benchmark* b) { b->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond); }

void measure_kropla(benchmark::State& state, std::vector<Vec3> (*make)(std::int64_t)) {
    const std::vector<Vec3> points = make(state.range(0));
    std::size_t tets = 0;
    for (auto _ : state) {
        const Triangulation t = triangulate(points);
        tets += t.tets.size();
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(tets));
}
BENCHMARK_CAPTURE(measure_kropla, uniform, uniform_points)->Apply(sizes);
BENCHMARK_CAPTURE(measure_kropla, graded, graded_points)->Apply(sizes);

#ifdef KROPLA_BENCH_CGAL
void measure_cgal(benchmark::State& state, std::vector<Vec3> (*make)(std::int64_t)) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::vector<Kernel::Point_3> points;
    for (const Vec3& p : make(state.range(0))) points.emplace_back(p.x, p.y, p.z);
    std::size_t tets = 0;
    for (auto _ : state) {
        const CGAL::Delaunay_triangulation_3<Kernel> t(points.begin(), points.end());
        tets += t.number_of_finite_cells();
    }
    state.SetItemsProcessed(static_cast<std::int64_t>(tets));
}
BENCHMARK_CAPTURE(measure_cgal, uniform, uniform_points)->Apply(sizes);
BENCHMARK_CAPTURE(measure_cgal, graded, graded_points)->Apply(sizes);
#endif

}  // namespace
}  // namespace kropla
