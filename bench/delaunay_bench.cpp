// The Delaunay kernel on random points, uniform in a cube and graded towards its centre as around a small
// body; beside CGAL's where that is installed. Items are tets. Each measures from the points to the finished
// triangulation; bytes_per_tet is the most that the heap holds on the way, the given points left out.

#include <kropla/generate/generate.h>

#include "base/random.h"
#include "heap.h"

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

/// The tets of all repetitions, and what the heap held before the first.
struct Made {
    std::size_t tets = 0, heap_before = heap::bytes();
    Made() { heap::reset_peak(); }
};

void tell(benchmark::State& state, const Made& made) {
    state.SetItemsProcessed(static_cast<std::int64_t>(made.tets));
    const double tets = static_cast<double>(made.tets) / static_cast<double>(state.iterations());
    state.counters["bytes_per_tet"] = static_cast<double>(heap::peak_bytes() - made.heap_before) / tets;
}

void sizes(benchmark::internal::Benchmark* b) { b->Arg(100000)->Arg(1000000)->Unit(benchmark::kMillisecond); }

void measure_kropla(benchmark::State& state, std::vector<Vec3> (*make)(std::int64_t)) {
    const std::vector<Vec3> points = make(state.range(0));
    Made made;
    for (auto _ : state) {
        const Triangulation t = triangulate(points);
        made.tets += t.tets.size();
    }
    tell(state, made);
}
BENCHMARK_CAPTURE(measure_kropla, uniform, uniform_points)->Apply(sizes);
BENCHMARK_CAPTURE(measure_kropla, graded, graded_points)->Apply(sizes);

#ifdef KROPLA_BENCH_CGAL
void measure_cgal(benchmark::State& state, std::vector<Vec3> (*make)(std::int64_t)) {
    using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
    std::vector<Kernel::Point_3> points;
    for (const Vec3& p : make(state.range(0))) points.emplace_back(p.x, p.y, p.z);
    Made made;
    for (auto _ : state) {
        const CGAL::Delaunay_triangulation_3<Kernel> t(points.begin(), points.end());
        made.tets += t.number_of_finite_cells();
    }
    tell(state, made);
}
BENCHMARK_CAPTURE(measure_cgal, uniform, uniform_points)->Apply(sizes);
BENCHMARK_CAPTURE(measure_cgal, graded, graded_points)->Apply(sizes);
#endif

}  // namespace
}  // namespace kropla
