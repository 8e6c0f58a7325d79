#include "transfer/adapted.h"

#include "adapt/cases.h"
#include "base/random.h"
#include <kropla/generate/generate.h>
#include <kropla/mesh/cavity.h>
#include "mesh/proposals.h"
#include <kropla/mesh/quality.h>
#include <kropla/mesh/topology.h>

#include <algorithm>

namespace kropla {

AdaptedMesh adapted_mesh(std::uint64_t seed) {
    Domain domain = sphere_in_box();
    domain.size.surface = 0.25;
    AdaptedMesh a;
    a.before = improved_mesh(domain, seed);
    spoil(a.before, surroundings, 5, seed);
    spoil(a.before, Region(1), 2, seed);
    a.after = a.before;
    Snapshot at = snapshot(domain, 0);
    const double factor = seed % 2 == 0 ? 1.3 : 0.8;
    at.size.surface *= factor;
    at.size.far *= factor;
    a.changes = repair(a.after, all_tets(a.after), at);
    a.changes += adapt_to_size(a.after, all_tets(a.after), at);
    a.changes += improve(a.after, all_tets(a.after), at);
    a.changes += optimise_places(a.after, all_tets(a.after));
    return a;
}

AdaptedMesh swapped_mesh(Mesh mesh) {
    AdaptedMesh a{mesh, std::move(mesh), {}};
    std::vector<Region> done;
    for (Tet t : all_tets(a.before)) {
        const Region region = a.before.region[t];
        for (int corner = 0; corner < 4 && std::ranges::find(done, region) == done.end(); ++corner) {
            const Tet n = a.before.neighbour[t][static_cast<std::size_t>(corner)];
            if (!n.exists() || a.before.region[n] != region) continue;
            const Cavity cavity = facet_removal(a.after, {t, corner});
            if (!all_positive(a.after, cavity)) continue;
            const auto added = replace_cells(a.after, cavity).cells;
            a.changes.cells.insert(a.changes.cells.end(), added.begin(), added.end());
            done.push_back(region);
        }
    }
    return a;
}

Mesh jittered_cube(int n, std::uint64_t seed) {
    Random random{seed};
    std::vector<Vec3> points;
    const auto coordinate = [&](int i) {
        const double jitter = i == 0 || i == n ? 0 : random.uniform(-0.3, 0.3);
        return (i + jitter) / n;
    };
    for (int k = 0; k <= n; ++k)
        for (int j = 0; j <= n; ++j)
            for (int i = 0; i <= n; ++i) {
                const double x = coordinate(i), y = coordinate(j), z = coordinate(k);
                points.push_back({x, y, z});
            }
    Array<Vertex, Vec3> position;
    for (const Vec3& p : points) position.push_back(p);
    Triangulation t = triangulate(points);
    Array<Tet, Region> region(t.tets.size(), surroundings);
    return make_mesh(std::move(position), std::move(t.tets), std::move(region));
}

NodalValues nodal_values(const Mesh& mesh, const std::function<double(Vertex)>& value) {
    NodalValues field(mesh.position.size());
    for (Vertex v : all_vertices(mesh)) field[v] = value(v);
    return field;
}

double field_integral(const Mesh& mesh, const NodalValues& values, Region only) {
    double sum = 0;
    for (Tet t : all_tets(mesh, only)) {
        double mean = 0;
        for (Vertex v : mesh.tets[t]) mean += values[v] / 4;
        sum += mean * volume(mesh, t);
    }
    return sum;
}

bool at_region(const Mesh& mesh, Vertex v, Region region) {
    return std::ranges::any_of(ball(mesh, v), [&](Tet t) { return mesh.region[t] == region; });
}

}  // namespace kropla
