// Motion of bodies through the mesh. Bodies move rigidly; their displacement is spread into the surroundings
// by weights that fall with the distance, as in [Luke, Collins, Blades 2012], "A fast mesh deformation method
// using explicit interpolation". Here a body's displacement is that of its rigid motion at the vertex, and
// how much of it is felt follows the cells' size, so that cells stream past the body instead of being
// squeezed and torn; vertices on the faces of the box slide along; and a body reaches no farther than a few
// of its own sizes.

#include "adapt/for_all.h"
#include "adapt/zone.h"
#include "domain/layer_room.h"
#include "generate/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

constexpr double reach_in_body_sizes = 6.0;    // how far a displacement is felt
constexpr double most_reach = 10.0;             // in a narrow box, where that is no more work
constexpr double least_reach_in_sizes = 10.0;   // and at least, in surface sizes

constexpr std::size_t too_much = 2;  // of a zone, in what is in reach: then the rest is left out

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// The motion of one body over a step.
struct Travel {
    Shape from, to;
    double reach;     // [m]
    double far_away;  // from the centre, nothing beyond is in reach [m]
    double grain;     // of places in the body [m]: a power of two

    /// Where a point fixed to the body would go from `x`.
    [[nodiscard]] Vec3 displacement(const Vec3& x) const {
        const Vec3 in_body = rotated_back(from.orientation, x - from.centre);
        return to.centre + rotated(to.orientation, in_body) - x;
    }
    /// Where a vertex of the body comes from `x`. It has one place in the body for ever: found again from `x`
    /// it is off by rounding only, which is less than half a grain. So nothing adds up over the steps, and
    /// volumes stay.
    [[nodiscard]] Vec3 taken_along(const Vec3& x) const {
        if (from.centre == to.centre && from.orientation.axes == to.orientation.axes) return x;
        Vec3 in_body = rotated_back(from.orientation, x - from.centre);
        for (int axis = 0; axis < 3; ++axis) in_body[axis] = grain * std::round(in_body[axis] / grain);
        return to.centre + rotated(to.orientation, in_body);
    }
};

/// More than twice what rounding may do to a place in a body of this size [m], anywhere in the box: half a unit
/// in the last place of each coordinate of a vertex, turned; and what a rotation and its transpose are off of
/// being inverse.
double grain_of(const Box& box, double size) {
    double farthest = 0;
    for (int axis = 0; axis < 3; ++axis)
        farthest = std::max({farthest, std::abs(box.min[axis]), std::abs(box.max[axis])});
    const double rounding = std::numeric_limits<double>::epsilon() * (4 * farthest + 16 * size);
    return std::exp2(std::ceil(std::log2(rounding)));
}

/// The volume of the part of the box within `reach` of a point, by axes [m^3].
double volume_within(const Box& box, const Vec3& x, double reach) {
    double volume = 1;
    for (int axis = 0; axis < 3; ++axis)
        volume *= std::max(0.0, std::min(x[axis] + reach, box.max[axis]) - std::max(x[axis] - reach, box.min[axis]));
    return volume;
}

/// How far a body's displacement is felt. The farther, the less each cell is strained; so where walls cut away a part
/// of what is in reach, it goes farther, to about as many cells.
double reach_of(const Shape& shape, const Domain& domain) {
    constexpr double step = 0.25;
    const double size = std::max({shape.semi_axes.x, shape.semi_axes.y, shape.semi_axes.z});
    const double whole = std::pow(2 * (1 + reach_in_body_sizes) * size, 3);
    const auto volume_in_reach = [&](double sizes) {
        return volume_within(domain.box, shape.centre, (1 + sizes) * size);
    };
    double sizes = reach_in_body_sizes;
    while (sizes < most_reach && volume_in_reach(sizes + step) <= whole) sizes += step;
    return std::max(sizes * size, least_reach_in_sizes * domain.size.surface);
}

std::vector<Travel> travels(const Domain& domain, double t0, double t1) {
    std::vector<Travel> result;
    for (const Body& body : domain.bodies) {
        const Shape from = shape_at(body, t0);
        const double size = std::max({from.semi_axes.x, from.semi_axes.y, from.semi_axes.z});
        const double reach = reach_of(from, domain);
        result.push_back({from, shape_at(body, t1), reach, reach + size, grain_of(domain.box, size)});
    }
    return result;
}

/// The share of a body's motion that the mesh takes part in at a distance from it. Seen from the body, cells
/// stream past; with their size h rising outwards, as many vertices enter any part as leave it if the stream
/// is as h^3.
double felt(const SizeField& size, double distance, double reach) {
    if (distance >= reach) return 0;
    const auto volume_at = [&](double d) {
        const double h = size.surface + size.growth * d;
        return h * h * h;
    };
    const double here = volume_at(distance), near = volume_at(0), far = volume_at(reach);
    if (far == near) return 1 - distance / reach;
    return 1 - (here - near) / (far - near);
}

/// The distance from the body, or from the shell of its layer if it has one outside.
double distance_to_body(const Snapshot& at, std::size_t body, const Vec3& x) {
    const Shape& shape = at.shapes[body];
    const double d = signed_distance(shape, x);
    if (d <= 0 || !layer_at_side(at, body, false)) return std::max(d, 0.0);
    return std::max(d - layer_thickness(at, body, false, closest_point(shape, x)), 0.0);
}

/// The displacement of the point `x` of the surroundings. None goes across a wall.
Vec3 spread(std::span<const Travel> travels, const Snapshot& at, const Vec3& x) {
    double total = 0;
    double least = std::numeric_limits<double>::infinity();
    Vec3 sum;
    for (std::size_t i = 0; i < travels.size(); ++i) {
        const double d = distance_to_body(at, i, x);
        if (d == 0) return travels[i].displacement(x);
        const double share = felt(at.size, d, travels[i].reach);
        total += 1 / (d * d);
        sum += share / (d * d) * travels[i].displacement(x);
        least = std::min(least, d);
    }
    Vec3 u = sum / total;
    for (int axis = 0; axis < 3; ++axis) {
        const double y = std::max(0.0, std::min(x[axis] - at.box.min[axis], at.box.max[axis] - x[axis]));
        u[axis] *= y * y / (y * y + least * least);
    }
    return u;
}

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

double safe_fraction(const Mesh& mesh, Tet t, const Array<Vertex, Vec3>& displacement, double least) {
    const auto& v = mesh.tets[t];
    std::array<Vec3, 3> e, de;
    for (int i = 0; i < 3; ++i) {
        e[at(i)] = mesh.position[v[at(i + 1)]] - mesh.position[v[0]];
        de[at(i)] = displacement[v[at(i + 1)]] - displacement[v[0]];
    }
    return positive_share(e, de, least);
}

double safe_fraction(const Mesh& mesh, Tet t, const Array<Vertex, Vec3>& start, const Array<Vertex, Vec3>& place,
                     double least) {
    const auto& v = mesh.tets[t];
    std::array<Vec3, 3> e, de;
    for (int i = 0; i < 3; ++i) {
        e[at(i)] = start[v[at(i + 1)]] - start[v[0]];
        de[at(i)] = place[v[at(i + 1)]] - place[v[0]] - e[at(i)];
    }
    return positive_share(e, de, least);
}

/// Puts the bodies' vertices where they go: rigidly with the body, but for the columns of layers, which stand on
/// their wall at the end as high as the gaps there let them.
void place_bodies(const Mesh& mesh, const Snapshot& at_end, std::span<const Travel> travels,
                  std::span<const std::vector<Vertex>> bodies, Zone& zone) {
    zone.bodies.clear();
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (Vertex v : bodies[i]) {
            zone.bodies.push_back(v);
            zone.moves[v] = Zone::with_body;
            zone.place[v] = travels[i].taken_along(mesh.position[v]);
        }
    for (const PrismLayer& layer : mesh.layers) {
        std::vector<Vec3> wall;
        for (int column = 0; column < count_columns(layer); ++column)
            wall.push_back(zone.place[column_vertex(layer, column, 0)]);
        const auto places = column_places(layer, wall, at_end);
        for (std::size_t i = 0; i < places.size(); ++i)
            if (i % static_cast<std::size_t>(layer.count + 1) != 0) zone.place[layer.columns[i]] = places[i];
    }
}

/// A tet of the surroundings at the body.
std::optional<Tet> tet_beside(const Mesh& mesh, std::span<const Vertex> body) {
    std::vector<Tet> around;
    for (Vertex v : body) {
        ball(mesh, v, around);
        const auto found = std::ranges::find_if(around, [&](Tet t) { return mesh.region[t] == surroundings; });
        if (found != around.end()) return *found;
    }
    return std::nullopt;
}

/// Is `x` so far from all bodies that none of them can move it? Told from the balls that hold them.
bool out_of_reach(std::span<const Travel> travels, const Vec3& x) {
    return std::ranges::none_of(travels, [&](const Travel& travel) {
        return squared_norm(x - travel.from.centre) < travel.far_away * travel.far_away;
    });
}

/// Takes in all cells of the surroundings with a vertex in reach of a body, outwards from those that are there. What
/// has come out of reach stays, until there is too much of it.
void reach_out(const Mesh& mesh, std::span<const Travel> travels, std::span<const std::vector<Vertex>> bodies,
               Zone& zone) {
    std::vector<Tet> cells;
    const auto is_there = [&](Vertex v) { return zone.has.contains(v); };
    for (const auto& body : bodies)
        if (std::ranges::none_of(body, is_there))
            if (const auto t = tet_beside(mesh, body)) cells.push_back(*t);
    add_cells(zone, mesh, cells);
    auto front = zone.has.list();
    std::vector<Tet> around;
    while (!front.empty()) {
        cells.clear();
        for (Vertex v : front) {
            if ((zone.axes[v] & Zone::rim) == 0 || out_of_reach(travels, mesh.position[v])) continue;
            ball(mesh, v, around);
            for (Tet t : around)
                if (mesh.region[t] == surroundings && !zone.holds.contains(t)) cells.push_back(t);
        }
        add_cells(zone, mesh, cells);
        IndexSet<Vertex> next;
        for (Tet t : cells)
            for (Vertex v : mesh.tets[t]) next.insert(v);
        front = next.list();
    }
}

/// Gathers what is in reach of the bodies, and where the vertices are to go.
void gather_reached(const Mesh& mesh, const Snapshot& at_start, const Snapshot& at_end, std::span<const Travel> travels,
                    std::span<const std::vector<Vertex>> bodies, Zone& zone) {
    reach_out(mesh, travels, bodies, zone);
    place_bodies(mesh, at_end, travels, bodies, zone);
    zone.vertices = zone.has.list();
    for_all(zone.vertices.size(), [&](std::size_t i) {
        const Vertex v = zone.vertices[i];
        if (zone.moves[v] == Zone::with_body) return;
        zone.place[v] = mesh.position[v];
        if (out_of_reach(travels, mesh.position[v])) return;
        zone.moves[v] = Zone::by_itself;
        zone.place[v] += restricted(spread(travels, at_start, mesh.position[v]), freedom(zone, v));
    });
    list_cells(zone, mesh);
    if (zone.holds.size() <= too_much * zone.cells.size()) return;
    shrink(zone, mesh);
    zone.vertices = zone.has.list();
}

/// The length of the longest row.
[[gnu::always_inline]] inline Four longest(const std::array<FourVec3, 3>& rows) {
    return square_root(greater(greater(squared_norm(rows[0]), squared_norm(rows[1])), squared_norm(rows[2])));
}

/// Which of four cells keep `least` of their volume on the way without doubt, told by their sizes: a determinant
/// of rows that are no longer than L and change by no more than D changes by at most (L + D)^3 - L^3 [by
/// Hadamard's inequality for each of its terms].
KROPLA_FOR_EACH_PROCESSOR
void tell_safe(const FourPlaces& from, const FourPlaces& to, double least, std::array<bool, 4>& safe) {
    const FourTets start = gathered(from), end = gathered(to);
    const std::array<FourVec3, 3> e = {start.b - start.a, start.c - start.a, start.d - start.a};
    const FourVec3 da = end.a - start.a;
    const std::array<FourVec3, 3> de = {end.b - start.b - da, end.c - start.c - da, end.d - start.d - da};
    const Four l = longest(e), d = longest(de);
    const Four surplus = (1 - least) * determinant(e[0], e[1], e[2]) - d * (3 * l * (l + d) + d * d);
    for (std::size_t i = 0; i < 4; ++i) safe[i] = surplus[i] > 0;
}

}  // namespace

double safe_fraction(const Mesh& mesh, std::span<const Tet> cells, const Array<Vertex, Vec3>& displacement,
                     double least) {
    double fraction = 1;
    for (Tet t : cells) fraction = std::min(fraction, safe_fraction(mesh, t, displacement, least));
    return fraction;
}

MoveReport check_way(const Zone& zone, const Mesh& mesh, const Array<Vertex, Vec3>& start, double least) {
    std::vector<double> safe(zone.cells.size(), 1);
    for_all((safe.size() + 3) / 4, [&](std::size_t four) {
        const std::size_t first = 4 * four;
        std::array<bool, 4> is_safe;
        tell_safe(four_cells(zone, mesh, first, start), four_cells(zone, mesh, first, zone.place), least, is_safe);
        for (std::size_t i = 0; i < 4 && first + i < safe.size(); ++i)
            if (!is_safe[i]) safe[first + i] = safe_fraction(mesh, zone.cells[first + i], start, zone.place, least);
    });
    MoveReport report{true, 1, {}};
    for (std::size_t c = 0; c < safe.size(); ++c)
        if (safe[c] < report.fraction) report = {false, safe[c], zone.cells[c]};
    return report;
}

void place_boundary(const Mesh& mesh, const Domain& domain, std::span<const std::vector<Vertex>> bodies, double t0,
                    double t1, Zone& zone) {
    gather_reached(mesh, snapshot(domain, t0), snapshot(domain, t1), travels(domain, t0, t1), bodies, zone);
}

MoveReport move_boundary(Mesh& mesh, const Domain& domain, std::span<const std::vector<Vertex>> bodies, double t0,
                         double t1, Zone& zone) {
    place_boundary(mesh, domain, bodies, t0, t1, zone);
    const MoveReport report = check_way(zone, mesh, mesh.position, least_volume_kept);
    if (report.arrived) write_places(zone, mesh);
    return report;
}

}  // namespace kropla
