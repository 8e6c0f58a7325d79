#pragma once

#include "simulate/cells.h"

#include <array>
#include <cstddef>
#include <numbers>

namespace kropla {

// Shape functions of tets (linear) and prisms (linear in the triangle, linear along the column), by points of
// quadrature. A tet has a single point, as its gradients are constant. A prism has 3 x 2 Gauss points, which
// make the integrals of phi_i, of grad phi_i and of w.grad phi_i (w a velocity given at the corners) exact:
// in the coordinates of the reference prism their integrands are polynomials, at most quadratic in the
// triangle and cubic along the column. (det J is of the degrees (1, 2), its cofactors are of (1, 1) and
// (0, 2), phi_i and w of (1, 1).) Products phi_i phi_j are exact on prisms that are not distorted; elsewhere
// their sums over j are.

/// The places of the corners of a cell [m], numbered as in mesh/cells.h.
template <std::size_t n, class Number = double>
using Corners = std::array<Vector3<Number>, n>;

template <class Cell>
[[nodiscard]] auto corners(const Array<Vertex, Vec3>& position, const Mesh& mesh, const Cell& cell) {
    const auto v = cell_vertices(mesh, cell);
    Corners<std::tuple_size_v<decltype(v)>> x;
    for (std::size_t i = 0; i < v.size(); ++i) x[i] = position[v[i]];
    return x;
}
template <class Cell>
[[nodiscard]] auto corners(const Mesh& mesh, const Cell& cell) {
    return corners(mesh.position, mesh, cell);
}

template <std::size_t n>
inline constexpr std::size_t points_of_cell = n == 4 ? 1 : 6;

/// What is known of a cell's shape functions at a point, for the part of the cell it stands for.
template <std::size_t n, class Number = double>
struct CellPoint {
    Number volume;                                   // [m^3]
    std::array<Vector3<Number>, n> volume_gradient;  // [m^2] volume times grad phi_i; they sum to zero
};
template <std::size_t n, class Number = double>
using CellPoints = std::array<CellPoint<n, Number>, points_of_cell<n>>;

/// The only point of a tet: its volume and dV/dx_i, a third of the area vector of the facet opposite corner i, pointing to
/// that corner; from differences to corner 0 alone, so that the rounding error is relative to the cell's size.
template <class Number>
[[nodiscard]] [[gnu::always_inline]] inline CellPoint<4, Number> linear_tet(const std::array<Vector3<Number>, 4>& x) {
    constexpr double sixth = 1.0 / 6;
    const Vector3<Number> a = x[1] - x[0], b = x[2] - x[0], c = x[3] - x[0];
    const Vector3<Number> g1 = sixth * cross(b, c), g2 = sixth * cross(c, a), g3 = sixth * cross(a, b);
    return {dot(a, g1), {-(g1 + g2 + g3), g1, g2, g3}};
}

template <class Number>
[[nodiscard]] CellPoints<4, Number> cell_points(const std::array<Vector3<Number>, 4>& x) {
    return {linear_tet(x)};
}
[[nodiscard]] CellPoints<6> cell_points(const Corners<6>& x);

template <std::size_t n, class Number = double>
[[nodiscard]] Number total_volume(const CellPoints<n, Number>& points) {
    Number sum = 0;
    for (const CellPoint<n, Number>& point : points) sum += point.volume;
    return sum;
}

/// The gradient at a point of the field with these values at the corners.
template <std::size_t n, class Number>
[[nodiscard]] Vector3<Number> gradient(const CellPoint<n, Number>& point, const std::array<Number, n>& values) {
    Vector3<Number> sum;
    for (std::size_t i = 0; i < n; ++i) sum += values[i] / point.volume * point.volume_gradient[i];
    return sum;
}

/// The means over a step of the points' volume_gradient, while the corners go straight from `x0` to `x1`.
/// Exact: the integrand is quadratic in time and two Gauss points integrate cubics, and a product a b of what changes
/// evenly has the mean ((a0 + a1)(b0 + b1) + a0 b0 + a1 b1) / 6. So the volume swept is
/// the volume gained: sum (x1_i - x0_i) . mean_i = V1 - V0, the geometric conservation law of
/// [Lesoinne, Farhat 1996].
template <std::size_t n, class Number = double>
using VolumeGradients = std::array<std::array<Vector3<Number>, n>, points_of_cell<n>>;
template <class Number>
[[nodiscard]] VolumeGradients<4, Number> mean_volume_gradients(const std::array<Vector3<Number>, 4>& x0,
                                                               const std::array<Vector3<Number>, 4>& x1) {
    constexpr double share = 1.0 / 6;
    std::array<Vector3<Number>, 4> both;
    for (std::size_t i = 0; i < 4; ++i) both[i] = (x0[i] - x0[0]) + (x1[i] - x1[0]);
    const CellPoint<4, Number> begin = linear_tet(x0), end = linear_tet(x1), sum = linear_tet(both);
    VolumeGradients<4, Number> mean;
    for (std::size_t i = 0; i < 4; ++i)
        mean[0][i] = share * (sum.volume_gradient[i] + begin.volume_gradient[i] + end.volume_gradient[i]);
    return mean;
}
[[nodiscard]] VolumeGradients<6> mean_volume_gradients(const Corners<6>& x0, const Corners<6>& x1);

/// The mean over a step of the area vector [m^2] of the triangle whose corners go straight from `x0` to `x1`.
[[nodiscard]] Vec3 mean_area_vector(const std::array<Vec3, 3>& x0, const std::array<Vec3, 3>& x1);

/// The means over the part of the cell that a point stands for: at the point itself in a prism.
template <std::size_t n>
struct ShapeMeans {
    std::array<double, n> value = {};                     // of phi_i
    std::array<std::array<double, n>, n> product = {};  // of phi_i phi_j
};

/// The two Gauss points of the interval 0 ... 1, each of weight one half.
inline constexpr std::array<double, 2> gauss_points = {0.5 - 0.5 * std::numbers::inv_sqrt3,
                                                       0.5 + 0.5 * std::numbers::inv_sqrt3};

/// Where point k of a prism stands: barycentric coordinates in its triangle, and the height, 0 ... 1. The
/// three points of a triangle, each of weight one third, integrate quadratics [Strang, Fix 1973].
struct PrismPoint {
    std::array<double, 3> triangle;
    double height;
};
[[nodiscard]] constexpr PrismPoint prism_point(std::size_t k) {
    PrismPoint point{{1.0 / 6, 1.0 / 6, 1.0 / 6}, gauss_points[k / 3]};
    point.triangle[k % 3] = 2.0 / 3;
    return point;
}
[[nodiscard]] constexpr std::array<double, 6> prism_shape(const PrismPoint& at) {
    std::array<double, 6> value = {};
    for (std::size_t a = 0; a < 3; ++a) {
        value[a] = at.triangle[a] * (1 - at.height);
        value[a + 3] = at.triangle[a] * at.height;
    }
    return value;
}

template <std::size_t n>
[[nodiscard]] constexpr std::array<ShapeMeans<n>, points_of_cell<n>> make_shape_means() {
    std::array<ShapeMeans<n>, points_of_cell<n>> means = {};
    for (std::size_t k = 0; k < means.size(); ++k) {
        if constexpr (n == 4) means[k].value = {0.25, 0.25, 0.25, 0.25};
        else means[k].value = prism_shape(prism_point(k));
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j)
                means[k].product[i][j] =
                    n == 4 ? (i == j ? 0.1 : 0.05) : means[k].value[i] * means[k].value[j];
    }
    return means;
}
/// Per point of a cell with n corners.
template <std::size_t n>
inline constexpr std::array<ShapeMeans<n>, points_of_cell<n>> shape_means = make_shape_means<n>();

/// Calls `visit(cell, vertex, share)` for each corner of the cells, with the integral of its shape function [m^3].
template <class Visit>
void for_each_share(const Mesh& mesh, const Cells& cells, const Visit& visit) {
    for_each_cell(cells, [&](const auto& cell) {
        const auto vertices = cell_vertices(mesh, cell);
        const auto points = cell_points(corners(mesh, cell));
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            double share = 0;
            for (std::size_t k = 0; k < points.size(); ++k)
                share += points[k].volume * shape_means<vertices.size()>[k].value[i];
            visit(cell, vertices[i], share);
        }
    });
}

/// The mean, for point k, of phi_i times what has these values at the corners.
template <std::size_t n, class T>
[[nodiscard]] T mean_product(std::size_t k, std::size_t i, const std::array<T, n>& values) {
    if constexpr (n == 4) return 0.05 * (values[0] + values[1] + values[2] + values[3] + values[i]);
    T sum = {};
    for (std::size_t j = 0; j < n; ++j) sum += shape_means<n>[k].product[i][j] * values[j];
    return sum;
}

/// The same with the density at vertices [kg/m^3]: calls `visit(cell, vertex, mass)` with its integral by the shape function [kg].
template <class Visit>
void for_each_mass(const Mesh& mesh, const Cells& cells, const Array<Vertex, double>& density, const Visit& visit) {
    for_each_cell(cells, [&](const auto& cell) {
        const auto vertices = cell_vertices(mesh, cell);
        const auto points = cell_points(corners(mesh, cell));
        const auto thin = at_corners(density, vertices);
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            double mass = 0;
            for (std::size_t k = 0; k < points.size(); ++k) mass += points[k].volume * mean_product(k, i, thin);
            visit(cell, vertices[i], mass);
        }
    });
}

/// The mean, for point k, of what has these values at the corners.
template <std::size_t n, class T>
[[nodiscard]] T mean_value(std::size_t k, const std::array<T, n>& values) {
    T sum = {};
    for (std::size_t i = 0; i < n; ++i) sum += shape_means<n>[k].value[i] * values[i];
    return sum;
}

}  // namespace kropla
