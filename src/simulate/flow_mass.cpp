#include "simulate/flow_mass.h"

#include "simulate/elements.h"

#include <utility>

namespace kropla {

VertexMasses::VertexMasses(const Mesh& before, const Mesh& current, Cells cells, Array<Vertex, double> begin,
                           Array<Vertex, double> end, double dt)
    : before_(before), current_(current), cells_(std::move(cells)), begin_(std::move(begin)), end_(std::move(end)),
      dt_(dt) {}

Array<Vertex, double> VertexMasses::densities(double share) const {
    Array<Vertex, double> now = end_;
    for (Vertex v : now.indices()) now[v] = (1 - share) * begin_[v] + share * end_[v];
    return now;
}

Array<Vertex, double> VertexMasses::density_rate() const {
    Array<Vertex, double> rate = end_;
    for (Vertex v : rate.indices()) rate[v] = (end_[v] - begin_[v]) / dt_;
    return rate;
}

/// Calls `visit(vertex, volume, expansion, share)` for each corner and point: the volume the point stands for [m^3], its
/// rate [m^3/s], and a function that takes values at vertices to the mean of phi_i times them.
template <class Visit>
void VertexMasses::for_each_corner(double share, const Visit& visit) const {
    for_each_cell(cells_, [&](const auto& cell) {
        const auto vertices = cell_vertices(current_, cell);
        constexpr std::size_t n = std::tuple_size_v<std::remove_cvref_t<decltype(vertices)>>;
        const Corners<n> x0 = corners(before_, cell), x1 = corners(current_, cell);
        Corners<n> x, moved;
        for (std::size_t i = 0; i < n; ++i) {
            x[i] = (1 - share) * x0[i] + share * x1[i];
            moved[i] = x1[i] - x0[i];
        }
        const CellPoints<n> points = cell_points(x);
        for (std::size_t k = 0; k < points.size(); ++k) {
            double grown = 0;
            for (std::size_t i = 0; i < n; ++i) grown += dot(points[k].volume_gradient[i], moved[i]);
            for (std::size_t i = 0; i < n; ++i)
                visit(vertices[i], points[k].volume, grown / dt_, [&](const Array<Vertex, double>& values) {
                    return mean_product(k, i, at_corners(values, vertices));
                });
        }
    });
}

Array<Vertex, double> VertexMasses::masses(double share) const {
    const Array<Vertex, double> density = densities(share);
    Array<Vertex, double> mass(density.size(), 0.0);
    for_each_corner(share, [&](Vertex v, double volume, double, const auto& mean) { mass[v] += volume * mean(density); });
    return mass;
}

Array<Vertex, double> VertexMasses::rates(double share) const {
    const Array<Vertex, double> density = densities(share), change = density_rate();
    Array<Vertex, double> rate(density.size(), 0.0);
    for_each_corner(share, [&](Vertex v, double volume, double expansion, const auto& mean) {
        rate[v] += expansion * mean(density) + volume * mean(change);
    });
    return rate;
}

}  // namespace kropla
