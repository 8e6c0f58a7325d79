// Smoothing: the paper's weighted Laplacian (section 1.1, Fig. 4) here in 3D over the vertices joined to P0
// by an edge; guarded by the worst aspect ratio of the ball; and optimisation of the worst (star.cpp).

#include <kropla/adapt/adapt.h>
#include "adapt/constants.h"
#include "adapt/star.h"
#include <kropla/mesh/quality.h>

#include <algorithm>

namespace kropla {
Vec3 laplacian_place(std::span<const Vec3> neighbours, const LaplaceWeights& weights) {
    std::vector<double> reach;  // per neighbour: the sum of its distances to the others
    double sum = 0;
    for (const Vec3& p : neighbours) {
        double r = 0;
        for (const Vec3& q : neighbours) r += distance(p, q);
        reach.push_back(r);
        sum += r;
    }
    const double mean = sum / static_cast<double>(neighbours.size());

    Vec3 place;
    double total = 0;
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
        const double w = weights.x1 + weights.x2 * reach[i] / mean;
        place += w * neighbours[i];
        total += w;
    }
    return place / total;
}

Vec3 laplacian_place(const Mesh& mesh, Vertex v, const LaplaceWeights& weights) {
    const Vec3 here = mesh.position[v];
    const Freedom f = freedom(constraint(mesh, v, ball(mesh, v)));
    if (f.none()) return here;
    std::vector<Vec3> neighbours;
    for (Vertex p : adjacent_vertices(mesh, v)) neighbours.push_back(mesh.position[p]);
    return here + restricted(laplacian_place(neighbours, weights) - here, f);
}

void smooth_laplacian(Mesh& mesh, std::span<const Vertex> vertices, const LaplaceWeights& weights) {
    for (Vertex v : vertices) mesh.position[v] = laplacian_place(mesh, v, weights);
}

std::vector<Vertex> smooth_guarded(Mesh& mesh, std::span<const Vertex> vertices, const LaplaceWeights& weights) {
    std::vector<Vertex> moved;
    std::vector<Tet> around;
    std::vector<StarFacet> star;
    for (Vertex v : vertices) {
        const Vec3 place = laplacian_place(mesh, v, weights);
        if (place == mesh.position[v]) continue;
        ball(mesh, v, around);
        star_of_ball(mesh, mesh.position, v, around, star);
        const double worst = worst_in_star(star, mesh.position[v], infinity);
        if (worst_in_star(star, place, worst) > worst) continue;
        mesh.position[v] = place;
        moved.push_back(v);
    }
    return moved;
}

bool optimise_vertex(Mesh& mesh, Vertex v, double good_enough) {
    const Place best = better_place(mesh, v, ball(mesh, v), good_enough);
    if (best.x == mesh.position[v]) return false;
    mesh.position[v] = best.x;
    return true;
}

}  // namespace kropla
