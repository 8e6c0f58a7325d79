// Does a cell stay the right way round while its vertices go along straight lines? The volume of a tet is a cubic in
// the fraction of the way, and so is the Jacobian at a corner of a prism; a cubic is positive where its Bernstein
// coefficients are. Bodies turn as a whole: what their turn does to all of their cells follows from its angle.

#include "adapt/way.h"

#include "base/for_all.h"
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

/// Does the corner of a prism keep its Jacobian without doubt? As surely_keep_volume for a tet, but told by the product of
/// the lengths of the rows, which differ.
bool is_surely_safe(const std::array<Vec3, 3>& e, const std::array<Vec3, 3>& de, double least) {
    double longest = 1, lengths = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        lengths *= norm(e[i]);
        longest *= norm(e[i]) + norm(de[i]);
    }
    return (1 - least) * determinant(e[0], e[1], e[2]) > longest - lengths;
}

/// The edges at corner i of a prism, by which its Jacobian is told there.
std::array<Vec3, 3> edges_at(const std::array<Vec3, 6>& x, std::size_t i) {
    const std::size_t base = i < 3 ? 0 : 3, k = i % 3;
    return {x[base + (k + 1) % 3] - x[i], x[base + (k + 2) % 3] - x[i], x[k + 3] - x[k]};
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
    double fraction = 1;
    for (std::size_t i = 0; i < 6; ++i) {
        const auto e = edges_at(from, i);
        auto de = edges_at(to, i);
        for (std::size_t k = 0; k < 3; ++k) de[k] -= e[k];
        if (!is_surely_safe(e, de, least)) fraction = std::min(fraction, positive_share(e, de, least));
    }
    return fraction;
}

double volume_kept_turning(const Shape& from, const Shape& to) {
    double trace = 0;
    for (std::size_t i = 0; i < 3; ++i) trace += dot(from.orientation.axes[i], to.orientation.axes[i]);
    return (1 + trace) / 4;
}

}  // namespace kropla
