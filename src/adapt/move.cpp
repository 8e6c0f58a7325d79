// Motion of bodies through the mesh. Bodies move rigidly; their displacement is spread into the surroundings by inverse-distance weights, after [Luke, Collins,
// Blades 2012], "A fast mesh deformation method using explicit interpolation"; here each body's displacement is that
// of its rigid motion at the vertex, the walls weigh in with none, and a body reaches no farther than a few of its
// own sizes, so that work stays near it.

#include "adapt/adapt.h"
#include "domain/layer_room.h"
#include "generate/layers.h"
#include "mesh/quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

constexpr double reach_in_body_sizes = 3.0;     // how far a displacement is felt
constexpr double least_reach_in_sizes = 10.0;   // and at least, in surface sizes

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The motion of one body over a step.
struct Travel {
    Shape from, to;
    double reach;  // [m]

    /// Where a point fixed to the body would go from `x`.
    [[nodiscard]] Vec3 displacement(const Vec3& x) const {
        const Vec3 in_body = rotated_back(from.orientation, x - from.centre);
        return to.centre + rotated(to.orientation, in_body) - x;
    }
};

std::vector<Travel> travels(const Domain& domain, double t0, double t1) {
    std::vector<Travel> result;
    for (const Body& body : domain.bodies) {
        const Shape from = shape_at(body, t0);
        const double size = std::max({from.semi_axes.x, from.semi_axes.y, from.semi_axes.z});
        const double reach = std::max(reach_in_body_sizes * size, least_reach_in_sizes * domain.size.surface);
        result.push_back({from, shape_at(body, t1), reach});
    }
    return result;
}

double distance_to_walls(const Box& box, const Vec3& x) {
    double least = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) least = std::min({least, x[axis] - box.min[axis], box.max[axis] - x[axis]});
    return std::max(least, 0.0);
}

/// Falls smoothly from 1 at the body to 0 at its reach.
double felt(double distance, double reach) {
    const double s = distance / reach;
    return s >= 1 ? 0 : (1 - s * s) * (1 - s * s);
}

/// The distance from the body, or from the shell of its layer if it has one outside.
double distance_to_body(const Snapshot& at, std::size_t body, const Vec3& x) {
    const Shape& shape = at.shapes[body];
    const double d = signed_distance(shape, x);
    if (d <= 0 || !layer_at_side(at, body, false)) return std::max(d, 0.0);
    return std::max(d - layer_thickness(at, body, false, closest_point(shape, x)), 0.0);
}

/// The displacement of the point `x` of the surroundings; nothing if it is out of every body's reach, or on a wall.
std::optional<Vec3> spread(std::span<const Travel> travels, const Snapshot& at, const Vec3& x) {
    const double to_wall = distance_to_walls(at.box, x);
    if (to_wall == 0) return std::nullopt;
    bool reached = false;
    double total = 1 / (to_wall * to_wall);
    Vec3 sum;
    for (std::size_t i = 0; i < travels.size(); ++i) {
        const double d = distance_to_body(at, i, x);
        if (d == 0) return travels[i].displacement(x);
        const double share = felt(d, travels[i].reach);
        reached |= share > 0;
        total += 1 / (d * d);
        sum += share / (d * d) * travels[i].displacement(x);
    }
    if (!reached) return std::nullopt;
    return sum / total;
}

/// Six times the volume of a tet as its corners go along straight lines, as a cubic in the fraction s of the way:
/// its four Bernstein coefficients on [0, 1].
std::array<double, 4> volume_along(const std::array<Vec3, 3>& e, const std::array<Vec3, 3>& de) {
    const double c0 = determinant(e[0], e[1], e[2]);
    const double c1 = determinant(de[0], e[1], e[2]) + determinant(e[0], de[1], e[2]) + determinant(e[0], e[1], de[2]);
    const double c2 =
        determinant(e[0], de[1], de[2]) + determinant(de[0], e[1], de[2]) + determinant(de[0], de[1], e[2]);
    const double c3 = determinant(de[0], de[1], de[2]);
    return {c0, c0 + c1 / 3, c0 + (2 * c1 + c2) / 3, c0 + c1 + c2 + c3};
}

/// The largest s up to which the cubic with these Bernstein coefficients stays positive; it is positive at 0. A cubic
/// is positive where its coefficients are; else the interval is halved [de Casteljau].
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

double safe_fraction(const Mesh& mesh, Tet t, const Array<Vertex, Vec3>& displacement, double least) {
    const auto& v = mesh.tets[t];
    std::array<Vec3, 3> e, de;
    for (int i = 0; i < 3; ++i) {
        e[at(i)] = mesh.position[v[at(i + 1)]] - mesh.position[v[0]];
        de[at(i)] = displacement[v[at(i + 1)]] - displacement[v[0]];
    }
    auto b = volume_along(e, de);
    const double kept = least * b[0];
    for (double& x : b) x -= kept;
    return positive_until(b);
}

/// The surroundings' tets with a vertex in reach of a body, found outwards from the bodies, and the displacement of
/// each of their vertices.
struct Reached {
    std::vector<Tet> cells;
    std::vector<Vertex> vertices;
    Array<Vertex, Vec3> displacement;
};

/// The displacement of the bodies' vertices: rigid, but for the columns of layers, which stand on their wall at t1 as
/// high as the gaps there let them.
Array<Vertex, Vec3> displacement_of_bodies(const Mesh& mesh, std::span<const Travel> travels, const Snapshot& at_end,
                                           std::span<const std::vector<Vertex>> bodies) {
    Array<Vertex, Vec3> displacement(mesh.position.size());
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (Vertex v : bodies[i]) displacement[v] = travels[i].displacement(mesh.position[v]);
    for (const PrismLayer& layer : mesh.layers) {
        std::vector<Vec3> wall;
        for (int column = 0; column < count_columns(layer); ++column) {
            const Vertex v = column_vertex(layer, column, 0);
            wall.push_back(mesh.position[v] + displacement[v]);
        }
        const auto places = column_places(layer, wall, at_end);
        for (std::size_t i = 0; i < places.size(); ++i)
            if (i % static_cast<std::size_t>(layer.count + 1) != 0)
                displacement[layer.columns[i]] = places[i] - mesh.position[layer.columns[i]];
    }
    return displacement;
}

Reached reached_by(const Mesh& mesh, const Snapshot& at_start, const Snapshot& at_end,
                   std::span<const Travel> travels, std::span<const std::vector<Vertex>> bodies) {
    enum State : char { unseen, fixed, moving, in_body };
    Array<Vertex, State> state(mesh.position.size(), unseen);
    Array<Tet, char> seen(mesh.tets.size(), 0);
    Reached reached;
    reached.displacement = displacement_of_bodies(mesh, travels, at_end, bodies);
    for (const auto& body : bodies)
        for (Vertex v : body) state[v] = in_body;

    const auto look_at = [&](Vertex v) {
        if (state[v] != unseen) return;
        const auto u = spread(travels, at_start, mesh.position[v]);
        state[v] = u ? moving : fixed;
        if (!u) return;
        reached.displacement[v] = *u;
        reached.vertices.push_back(v);
    };
    const auto add = [&](Tet t) {
        if (seen[t] != 0 || mesh.region[t] != surroundings) return;
        seen[t] = 1;
        reached.cells.push_back(t);
    };
    std::vector<Tet> around;
    for (const auto& body : bodies)
        for (Vertex v : body) {
            ball(mesh, v, around);
            for (Tet t : around) add(t);
        }
    for (std::size_t i = 0; i < reached.cells.size(); ++i) {
        const Tet t = reached.cells[i];
        bool moves = false;
        for (Vertex v : mesh.tets[t]) {
            look_at(v);
            moves |= state[v] != fixed;
        }
        if (!moves) continue;
        for (Tet n : mesh.neighbour[t])
            if (n.exists()) add(n);
    }
    return reached;
}

}  // namespace

double safe_fraction(const Mesh& mesh, std::span<const Tet> cells, const Array<Vertex, Vec3>& displacement,
                     double least) {
    double fraction = 1;
    for (Tet t : cells) fraction = std::min(fraction, safe_fraction(mesh, t, displacement, least));
    return fraction;
}

MoveReport move_boundary(Mesh& mesh, const Domain& domain, std::span<const std::vector<Vertex>> bodies, double t0,
                         double t1) {
    constexpr double least_volume_kept = 0.05;  // of a cell's volume, anywhere on its way
    const auto journey = travels(domain, t0, t1);
    Reached reached = reached_by(mesh, snapshot(domain, t0), snapshot(domain, t1), journey, bodies);

    MoveReport report;
    report.fraction = 1;
    for (Tet t : reached.cells) {
        const double f = safe_fraction(mesh, t, reached.displacement, least_volume_kept);
        if (f < report.fraction) {
            report.fraction = f;
            report.limiting = t;
        }
    }
    report.cells = std::move(reached.cells);
    report.vertices = std::move(reached.vertices);
    report.arrived = report.fraction == 1;
    if (!report.arrived) return report;

    for (Vertex v : report.vertices) mesh.position[v] += reached.displacement[v];
    for (const auto& body : bodies)
        for (Vertex v : body) mesh.position[v] += reached.displacement[v];
    return report;
}

}  // namespace kropla
