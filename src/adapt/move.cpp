// Motion of bodies through the mesh. Bodies move rigidly, or deform; their displacement is spread into the surroundings
// by weights that fall with the distance, as in [Luke, Collins, Blades 2012], "A fast mesh deformation method
// using explicit interpolation". Here a body's displacement is that of its motion at the vertex, and
// the share of it that a vertex takes follows the cells' size, so that cells stream past the body instead of being
// squeezed and torn; vertices on the faces of the box slide along; and a body reaches no farther than a few
// of its own sizes.

#include "adapt/constants.h"
#include "base/for_all.h"
#include "adapt/zone.h"
#include "domain/layer_room.h"
#include "domain/triangle_tree.h"
#include "generate/layers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>

namespace kropla {
namespace {

/// The motion of one body over a step.
struct Travel {
    Shape from, to;
    double reach;     // [m]; 0 of one that rests
    double far_away;  // from the centre, nothing beyond is in reach [m]
    double grain;     // of places in the body [m]: a power of two
    double sized = 0; // from the centre at either end, no target size changes beyond [m]; 0: where none does beyond reach
    const Deformation* deformation = nullptr;  // of a body that deforms, from
    double start = 0, end = 0;                 // to [s]

    /// Where a point fixed to the body would go from `x`.
    [[nodiscard]] Vec3 displacement(const Vec3& x) const {
        if (deformation != nullptr) return (*deformation)(x, start, end) - x;
        const Vec3 in_body = rotated_back(from.orientation, x - from.centre);
        return to.centre + rotated(to.orientation, in_body) - x;
    }
    /// Where a vertex of the body comes from `x`. It has one place in the body for ever: found again from `x`
    /// it is off by rounding only, which is less than half a grain. So nothing adds up over the steps, and
    /// volumes stay.
    [[nodiscard]] Vec3 taken_along(const Vec3& x) const {
        if (deformation != nullptr) return (*deformation)(x, start, end);
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

/// How far a body's displacement goes. The farther, the less each cell is strained; so where walls cut away a part
/// of what is in reach, it goes farther, to about as many cells.
double reach_of(const Shape& shape, const Domain& domain) {
    const double size = outer_radius(shape);
    const double whole = std::pow(2 * (1 + reach_in_body_sizes) * size, 3);
    const auto volume_in_reach = [&](double sizes) {
        return volume_within(domain.box, shape.centre, (1 + sizes) * size);
    };
    double sizes = reach_in_body_sizes;
    while (sizes < most_reach && volume_in_reach(sizes + reach_step) <= whole) sizes += reach_step;
    return std::max(sizes * size, least_reach_in_sizes * domain.size.surface);
}

/// How far from a body within the box the target size rises [m].
double graded_distance(const Snapshot& at, std::size_t body) {
    const double rise = largest_size(at.box, at.size) - surface_size(at, body);
    const double across = norm(at.box.max - at.box.min);
    return at.size.growth * across > rise ? std::max(0.0, rise / at.size.growth) : across;
}

bool moves(const Travel& travel) {
    return travel.deformation != nullptr || travel.from.centre != travel.to.centre || travel.from.orientation.axes != travel.to.orientation.axes;
}

std::vector<Travel> travels(const Domain& domain, const Snapshot& start, double t0, double t1) {
    std::vector<Travel> result;
    for (std::size_t body = 0; body < domain.bodies.size(); ++body) {
        const Shape& from = start.shapes[body];
        const double size = outer_radius(from);
        const double reach = reach_of(from, domain), graded = graded_distance(start, body);
        Travel travel{from, shape_at(domain.bodies[body], t1), reach, reach + size, grain_of(domain.box, size)};
        if (const Deformation& deformation = domain.bodies[body].deformation) {
            travel.to = from;
            travel.deformation = &deformation;
            travel.start = t0;
            travel.end = t1;
        }
        if (graded > reach) travel.sized = graded + size;
        result.push_back(std::move(travel));
    }
    return result;
}

/// Does nothing of the body move? `deforming` is its surface, if it deforms.
bool rests(const Mesh& mesh, const Travel& travel, const BodySurface* deforming) {
    if (deforming == nullptr) return !moves(travel);
    return std::ranges::all_of(deforming->vertices, [&](Vertex v) { return travel.displacement(mesh.position[v]) == Vec3{}; });
}

/// The mesh around what rests is left as it is.
void leave_out_resting(const Mesh& mesh, std::span<const BodySurface> deforming, std::vector<Travel>& travels) {
    for (std::size_t body = 0; body < travels.size(); ++body) {
        const auto surface = std::ranges::find(deforming, body, &BodySurface::body);
        if (rests(mesh, travels[body], surface == deforming.end() ? nullptr : &*surface))
            travels[body].reach = travels[body].far_away = travels[body].sized = 0;
    }
}

/// The share of a body's motion that the mesh takes part in at a distance from it. Seen from the body, cells
/// stream past; with their size h rising outwards, as many vertices enter any part as leave it if the stream
/// is as h^3.
double displacement_share(const SizeField& size, double distance, double reach) {
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

/// The displacement of the point `x` of the surroundings. None goes across a wall; none along fixed ones either.
Vec3 spread(std::span<const Travel> travels, const Snapshot& at, const Vec3& x) {
    double total = 0;
    double least = std::numeric_limits<double>::infinity();
    Vec3 sum;
    for (std::size_t i = 0; i < travels.size(); ++i) {
        const double d = distance_to_body(at, i, x);
        if (d == 0) return travels[i].displacement(x);
        const double share = displacement_share(at.size, d, travels[i].reach);
        total += 1 / (d * d);
        sum += share / (d * d) * travels[i].displacement(x);
        least = std::min(least, d);
    }
    Vec3 u = sum / total;
    for (int axis = 0; axis < 3; ++axis) {
        const double y = std::max(0.0, std::min(x[axis] - at.box.min[axis], at.box.max[axis] - x[axis]));
        u[axis] *= y * y / (y * y + least * least);
    }
    if (at.walls) {
        const double squared = at.walls->nearest(x).squared_distance;
        u *= squared / (squared + least * least);
    }
    return u;
}

/// Of a vector at `x` what is along the faces of the box on which `x` lies, exactly.
Vec3 along_faces(const Box& box, const Vec3& x, Vec3 vector) {
    for (int axis = 0; axis < 3; ++axis)
        if (x[axis] == box.min[axis] || x[axis] == box.max[axis]) vector[axis] = 0;
    return vector;
}

/// Of a vector at `x` what a line is free to follow on the faces of the box on which `x` lies, exactly: what is along them, or
/// nothing on those on which it is pinned.
Vec3 free_part(const Box& box, unsigned pinned, const Vec3& x, const Vec3& vector) {
    for (int face = 0; face < box_faces; ++face)
        if (reaches(pinned, face) && x[face / 2] == (face % 2 == 0 ? box.min : box.max)[face / 2]) return {};
    return along_faces(box, x, vector);
}

/// Puts the bodies' vertices where they go with the body; those of a deforming one that are on faces of the box, along these.
void place_bodies(const Mesh& mesh, const Domain& domain, std::span<const Travel> travels,
                  std::span<const std::vector<Vertex>> bodies, ZoneMotion& motion) {
    motion.bodies.clear();
    for (std::size_t i = 0; i < bodies.size(); ++i)
        for (Vertex v : bodies[i]) {
            motion.bodies.push_back(v);
            motion.moves[v] = ZoneMotion::with_body;
            const Vec3& from = mesh.position[v];
            motion.place[v] = travels[i].taken_along(from);
            if (travels[i].deformation == nullptr) continue;
            const Vec3 free = free_part(domain.box, domain.bodies[i].pinned, from, {1, 1, 1});
            for (int axis = 0; axis < 3; ++axis)
                if (free[axis] == 0) motion.place[v][axis] = from[axis];
        }
}

/// The vertices of a surface went with the flow; what was flat between them has become curved. Shifts them along their
/// normals by the volume that is between the flat triangles and the curved ones, so that the volume inside becomes what the
/// flow makes of it, place by place: to the fourth power of the edges, not to the second. The curved triangle is the
/// quadratic one through the images of the middles of its edges. A vertex on a face of the box is shifted along the face, or
/// not at all where its line is pinned; what the flow takes through the face does not count as curved.
void keep_with_flow(const Mesh& mesh, const Box& box, const Body& body, const Travel& travel, const BodySurface& surface,
                    ZoneMotion& motion) {
    const auto number = [&](Vertex v) {
        return static_cast<std::size_t>(std::ranges::lower_bound(surface.vertices, v) - surface.vertices.begin());
    };
    const auto gone = [&](Vertex v) {  // where the flow alone takes it
        const Vec3& from = mesh.position[v];
        return along_faces(box, from, {1, 1, 1}) == Vec3{1, 1, 1} ? motion.place[v] : travel.taken_along(from);
    };
    const auto rise = [&](Vertex a, Vertex b) {  // of the middle of an edge, over the middle of its ends
        const Vec3 middle = 0.5 * (mesh.position[a] + mesh.position[b]);
        const Vec3 image = (*travel.deformation)(middle, travel.start, travel.end);
        return along_faces(box, middle, image - 0.5 * (gone(a) + gone(b)));
    };
    std::vector<Vec3> normal(surface.vertices.size());  // times twice the area around
    std::vector<double> missing(surface.vertices.size(), 0);
    std::vector<double> of_triangle(surface.triangles.size());
    for_all(surface.triangles.size(), [&](std::size_t t) {
        const auto& [a, b, c] = surface.triangles[t];
        const Vec3 twice_area = cross(motion.place[b] - motion.place[a], motion.place[c] - motion.place[a]);
        of_triangle[t] = dot(twice_area, rise(a, b) + rise(b, c) + rise(c, a)) / 6;
    });
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
        const auto& [a, b, c] = surface.triangles[t];
        const Vec3 twice_area = cross(motion.place[b] - motion.place[a], motion.place[c] - motion.place[a]);
        for (Vertex v : surface.triangles[t]) {
            normal[number(v)] += twice_area;
            missing[number(v)] += of_triangle[t] / 3;
        }
    }
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) {
        const Vertex v = surface.vertices[i];
        const Vec3 free = free_part(box, body.pinned, mesh.position[v], normal[i]);
        if (squared_norm(free) > 0) motion.place[v] += 6 * missing[i] / squared_norm(free) * free;
    }
}

/// The volume that a surface sweeps from places to others, outwards: where it ends on a face of the box, it goes along that.
double swept_volume(const BodySurface& surface, const Array<Vertex, Vec3>& from, const Array<Vertex, Vec3>& to) {
    double sum = 0;
    for (const std::array<Vertex, 3>& corner : surface.triangles) {
        const auto twice_area = [&](double done) {
            const auto place = [&](Vertex v) { return from[v] + done * (to[v] - from[v]); };
            return cross(place(corner[1]) - place(corner[0]), place(corner[2]) - place(corner[0]));
        };
        Vec3 gone;
        for (Vertex v : corner) gone += to[v] - from[v];
        sum += dot(gone, twice_area(0) + 4 * twice_area(0.5) + twice_area(1)) / 36;  // Simpson's rule, which is exact
    }
    return sum;
}

/// Shifts the vertices of a surface evenly along their normals, on faces of the box along these, until what it holds is what it
/// held before.
void keep_volume(const Mesh& mesh, const Box& box, const Body& body, const BodySurface& surface, ZoneMotion& motion) {
    const auto number = [&](Vertex v) {
        return static_cast<std::size_t>(std::ranges::lower_bound(surface.vertices, v) - surface.vertices.begin());
    };
    for (int pass = 0; pass < even_shift_steps; ++pass) {
        std::vector<Vec3> gradient(surface.vertices.size());  // of the volume, by the vertices' places
        for (const auto& [a, b, c] : surface.triangles) {
            const Vec3 area = cross(motion.place[b] - motion.place[a], motion.place[c] - motion.place[a]);
            for (Vertex v : {a, b, c}) gradient[number(v)] += area / 6;
        }
        double gained = 0;  // per length of the shift
        for (std::size_t i = 0; i < gradient.size(); ++i) {
            gradient[i] = free_part(box, body.pinned, mesh.position[surface.vertices[i]], gradient[i]);
            gained += norm(gradient[i]);
        }
        const double shift = -swept_volume(surface, mesh.position, motion.place) / gained;
        for (std::size_t i = 0; i < gradient.size(); ++i)
            if (const double size = norm(gradient[i]); size > 0)
                motion.place[surface.vertices[i]] += shift / size * gradient[i];
    }
}

/// Then puts the columns of layers on their wall, as high as the gaps there let them be at the end.
void place_columns(const Mesh& mesh, const Snapshot& at_end, ZoneMotion& motion) {
    for (const PrismLayer& layer : mesh.layers) {
        std::vector<Vec3> wall;
        for (int column = 0; column < count_columns(layer); ++column)
            wall.push_back(motion.place[column_vertex(layer, column, 0)]);
        const auto places = column_places(layer, wall, at_end);
        for (std::size_t i = 0; i < places.size(); ++i)
            if (i % as_size(layer.count + 1) != 0) motion.place[layer.columns[i]] = places[i];
    }
}

/// Adds the tets of the region at the body: of all its pieces, as around a hollow body and within it.
void add_tets_beside(const Mesh& mesh, std::span<const Vertex> body, Region region, std::vector<Tet>& tets) {
    std::vector<Tet> around;
    for (Vertex v : body) {
        ball(mesh, v, around);
        std::ranges::copy_if(around, std::back_inserter(tets), [&](Tet t) { return mesh.region[t] == region; });
    }
}

/// Is `x` so far from all bodies that none of them can move it? Told from the balls that hold them.
bool out_of_reach(std::span<const Travel> travels, const Vec3& x) {
    return std::ranges::none_of(travels, [&](const Travel& travel) {
        return squared_norm(x - travel.from.centre) < travel.far_away * travel.far_away;
    });
}

/// Is the target size there the same before and after the step?
bool keeps_its_size(std::span<const Travel> travels, const Vec3& x) {
    return std::ranges::none_of(travels, [&](const Travel& travel) {
        const double least = std::min(squared_norm(x - travel.from.centre), squared_norm(x - travel.to.centre));
        return least < travel.sized * travel.sized;
    });
}

/// Is a cell of the region at the vertex in the zone?
bool has_cell_at(const Zone& zone, const Mesh& mesh, Vertex v, Region region) {
    return zone.has.contains(v) && std::ranges::any_of(zone.ball[v], [&](Tet t) { return mesh.region[t] == region; });
}

/// Takes in all cells of the surroundings, and of deforming bodies, with a vertex that a body moves, or whose target size
/// it changes, outwards from those that are there. What has come out of reach stays, until there is too much of it.
void reach_out(const Mesh& mesh, std::span<const Travel> travels, const MovedBodies& bodies, Zone& zone) {
    std::vector<Tet> cells;
    const auto begin_with = [&](const std::vector<Vertex>& body, Region region) {
        if (std::ranges::any_of(body, [&](Vertex v) { return has_cell_at(zone, mesh, v, region); })) return;
        add_tets_beside(mesh, body, region, cells);
    };
    zone.deforming.clear();
    for (const BodySurface& surface : bodies.deforming) zone.deforming.push_back(region_of_body(surface.body));
    for (const auto& body : bodies.vertices) begin_with(body, surroundings);
    for (const BodySurface& surface : bodies.deforming)
        begin_with(bodies.vertices[surface.body], region_of_body(surface.body));
    add_cells(zone, mesh, cells);
    auto front = zone.has.list();
    std::vector<Tet> around;
    while (!front.empty()) {
        cells.clear();
        for (Vertex v : front) {
            if ((zone.axes[v] & Zone::rim) == 0) continue;
            const Vec3& x = mesh.position[v];
            if (out_of_reach(travels, x) && keeps_its_size(travels, x)) continue;
            ball(mesh, v, around);
            for (Tet t : around)
                if (zone.takes(mesh.region[t]) && !zone.holds.contains(t)) cells.push_back(t);
        }
        add_cells(zone, mesh, cells);
        IndexSet<Vertex> next;
        for (Tet t : cells)
            for (Vertex v : mesh.tets[t]) next.insert(v);
        front = next.list();
    }
}

/// Places the vertices that do not belong to a body.
void place_others(const Mesh& mesh, const Snapshot& at_start, std::span<const Travel> travels, Follow surroundings,
                  const Zone& zone, ZoneMotion& motion) {
    motion.vertices = zone.has.list();
    for_all(motion.vertices.size(), [&](std::size_t i) {
        const Vertex v = motion.vertices[i];
        if (motion.moves[v] == ZoneMotion::with_body) return;
        motion.place[v] = mesh.position[v];
        if (out_of_reach(travels, mesh.position[v])) {
            if (motion.moves[v] == 0 && !keeps_its_size(travels, mesh.position[v]))
                motion.moves[v] = ZoneMotion::by_size;
            return;
        }
        motion.moves[v] = ZoneMotion::by_itself;
        if (surroundings == Follow::rest) return;
        motion.place[v] += restricted(spread(travels, at_start, mesh.position[v]), freedom(zone, motion, v));
    });
}

/// Lists the cells that take part, and leaves out of the zone what does not, if there is too much of it.
void list_and_shrink(const Mesh& mesh, Zone& zone, ZoneMotion& motion) {
    list_cells(zone, motion, mesh);
    if (zone.holds.size() <= most_unused * (motion.cells.size() + motion.beyond.size())) return;
    IndexSet<Tet> stay;
    for (Tet t : motion.cells) stay.insert(t);
    for (Tet t : motion.beyond) stay.insert(t);
    shrink(zone, mesh, stay);
    motion.vertices = zone.has.list();
}

}  // namespace

void place_boundary(const Mesh& mesh, const Domain& domain, const MovedBodies& bodies, double t0, double t1, Zone& zone,
                    ZoneMotion& motion) {
    const Snapshot at_start = snapshot(domain, t0, bodies.deforming, mesh.position, bodies.uneven);
    std::vector<Travel> travelling = travels(domain, at_start, t0, t1);
    leave_out_resting(mesh, bodies.deforming, travelling);
    reach_out(mesh, travelling, bodies, zone);
    fit(motion, mesh);
    place_bodies(mesh, domain, travelling, bodies.vertices, motion);
    for (const BodySurface& surface : bodies.deforming) {
        const Body& body = domain.bodies[surface.body];
        keep_with_flow(mesh, domain.box, body, travelling[surface.body], surface, motion);
        if (body.keeps_volume) keep_volume(mesh, domain.box, body, surface, motion);
    }
    const Snapshot at_end = snapshot(domain, t1, bodies.deforming, motion.place, bodies.uneven);
    place_columns(mesh, at_end, motion);
    place_others(mesh, at_start, travelling, bodies.surroundings, zone, motion);
    list_and_shrink(mesh, zone, motion);
    find_sizes(motion, at_end);
}

MoveReport move_boundary(Mesh& mesh, const Domain& domain, const MovedBodies& bodies, double t0, double t1, Zone& zone,
                         ZoneMotion& motion) {
    place_boundary(mesh, domain, bodies, t0, t1, zone, motion);
    const MoveReport report = check_way(motion, mesh, mesh.position, least_volume_kept);
    if (report.arrived) write_places(motion, mesh);
    return report;
}

}  // namespace kropla
