// Does a cell stay the right way round while its vertices go along straight lines? The volume of a tet is a cubic in
// the fraction of the way, and so is the Jacobian at a corner of a prism; a cubic is positive where its Bernstein
// coefficients are. Bodies turn as a whole: what their turn does to all of their cells follows from its angle.

#include "adapt/way.h"

#include "base/for_all.h"
#include "mesh/four_cells.h"
#include <kropla/mesh/prisms.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace kropla {
namespace {

/// Six times the volume of a tet as its corners go along straight lines, as a cubic in the fraction s of the
/// way: its four Bernstein coefficients on [0, 1].
std::array<double, 4> volume_along(const std::array<Vec3, 3>& e, const std::array<Vec3, 3>& de) {
    const double c0 = determinant(e[0], e[1], e[2]);
    const double c1 = determinant(de[0], e[1], e[2]) + determinant(e[0], de[1], e[2]) + determinant(e[0], e[1], de[2]);
    const double c2 =
        determinant(e[0], de[1], de[2]) + determinant(de[0], e[1], de[2]) + determinant(de[0], de[1], e[2]);
    const double c3 = determinant(de[0], de[1], de[2]);
    return {c0, c0 + c1 / 3, c0 + (2 * c1 + c2) / 3, c0 + c1 + c2 + c3};
}

/// The largest s up to which the cubic with these Bernstein coefficients stays positive; it is positive at 0.
/// A cubic is positive where its coefficients are; else the interval is halved [de Casteljau].
double positive_until(const std::array<double, 4>& b, int depth = 0) {
    if (std::ranges::all_of(b, [](double x) { return x > 0; })) return 1;
    if (depth == 16 || b[0] <= 0) return 0;
    const double m = (b[1] + b[2]) / 2;
    const double l1 = (b[0] + b[1]) / 2, l2 = (l1 + m) / 2, r1 = (b[2] + b[3]) / 2, r2 = (r1 + m) / 2;
    const double middle = (l2 + r2) / 2;
    const double left = positive_until({b[0], l1, l2, middle}, depth + 1);
    if (left < 1) return left / 2;
    return 0.5 + positive_until({middle, r2, r1, b[3]}, depth + 1) / 2;
}

/// The share of the way up to which a tet keeps `least` of its volume.
double positive_share(const std::array<Vec3, 3>& e, const std::array<Vec3, 3>& de, double least) {
    auto b = volume_along(e, de);
    const double kept = least * b[0];
    for (double& x : b) x -= kept;
    return positive_until(b);
}

double safe_fraction(const Mesh& mesh, Tet t, const Array<Vertex, Vec3>& start, const Array<Vertex, Vec3>& place,
                     double least) {
    const auto& v = mesh.tets[t];
    std::array<Vec3, 3> e, de;
    for (int i = 0; i < 3; ++i) {
        e[as_size(i)] = start[v[as_size(i + 1)]] - start[v[0]];
        de[as_size(i)] = place[v[as_size(i + 1)]] - place[v[0]] - e[as_size(i)];
    }
    return positive_share(e, de, least);
}

/// The edges of a prism: around its base and around its top, each opposite to the corner of its number, and its legs.
constexpr std::array<std::array<std::size_t, 2>, 9> edges_of_prism = {
    {{1, 2}, {2, 0}, {0, 1}, {4, 5}, {5, 3}, {3, 4}, {0, 3}, {1, 4}, {2, 5}}};
using PrismEdges = std::array<Vec3, 9>;
using PrismLengths = std::array<double, 9>;

PrismEdges edges_of(const std::array<Vec3, 6>& x) {
    PrismEdges edges;
    for (std::size_t i = 0; i < edges.size(); ++i) edges[i] = x[edges_of_prism[i][1]] - x[edges_of_prism[i][0]];
    return edges;
}

PrismLengths lengths_of(const PrismEdges& edges) {
    PrismLengths lengths;
    std::ranges::transform(edges, lengths.begin(), [](const Vec3& edge) { return norm(edge); });
    return lengths;
}

/// Those at a corner, in the order in which their determinant is the Jacobian there.
std::array<std::size_t, 3> edges_at(std::size_t corner) {
    const std::size_t first = corner < 3 ? 0 : 3, k = corner % 3;
    return {first + (k + 1) % 3, first + (k + 2) % 3, 6 + k};
}

}  // namespace

MoveReport check_way(const ZoneMotion& motion, const Mesh& mesh, const Array<Vertex, Vec3>& start, double least) {
    std::vector<double> safe(motion.cells.size(), 1);
    for_all((safe.size() + 3) / 4, [&](std::size_t four) {
        const std::size_t first = 4 * four;
        const auto is_safe = surely_keep_volume(four_cells(motion.cells, mesh, first, start),
                                                four_cells(motion.cells, mesh, first, motion.place), least);
        for (std::size_t i = 0; i < 4 && first + i < safe.size(); ++i)
            if (!is_safe[i]) safe[first + i] = safe_fraction(mesh, motion.cells[first + i], start, motion.place, least);
    });
    MoveReport report{true, 1, {}};
    for (std::size_t c = 0; c < safe.size(); ++c)
        if (safe[c] < report.fraction) report = {false, safe[c], motion.cells[c]};
    return report;
}

double safe_fraction(const Mesh& mesh, std::span<const Tet> cells, const Array<Vertex, Vec3>& start,
                     const Array<Vertex, Vec3>& place, double least) {
    double fraction = 1;
    for (Tet t : cells) fraction = std::min(fraction, safe_fraction(mesh, t, start, place, least));
    return fraction;
}

double safe_fraction(const std::array<Vec3, 6>& from, const std::array<Vec3, 6>& to, double least) {
    const PrismEdges start = edges_of(from);
    PrismEdges change = edges_of(to);
    for (std::size_t i = 0; i < change.size(); ++i) change[i] -= start[i];
    const PrismLengths length = lengths_of(start), changed = lengths_of(change);
    double fraction = 1;
    for (std::size_t corner = 0; corner < 6; ++corner) {
        const auto [i, j, k] = edges_at(corner);
        const std::array<Vec3, 3> e = {start[i], start[j], start[k]};
        // As surely_keep_volume for a tet, but told by the product of the lengths of the rows, which differ.
        const double longest = (length[i] + changed[i]) * (length[j] + changed[j]) * (length[k] + changed[k]);
        const double may_change = longest - length[i] * length[j] * length[k];
        if ((1 - least) * determinant(e[0], e[1], e[2]) > may_change) continue;
        fraction = std::min(fraction, positive_share(e, {change[i], change[j], change[k]}, least));
    }
    return fraction;
}

double volume_kept_turning(const Shape& from, const Shape& to) {
    double trace = 0;
    for (std::size_t i = 0; i < 3; ++i) trace += dot(from.orientation.axes[i], to.orientation.axes[i]);
    return (1 + trace) / 4;
}

}  // namespace kropla
