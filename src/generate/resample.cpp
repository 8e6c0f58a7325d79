// Surfaces of any triangles, sampled anew at the target size.
//
// After [Botsch, Kobbelt 2004, "A remeshing approach to multiresolution modeling"]: in turn, edges longer than 4/3 of the
// size are split, those shorter than 4/5 are collapsed, edges are flipped to even out the valences, and points are moved
// along the surface; creases and corners stay. Changed: the points go to where those of skin.cpp go, and back to the
// nearest place of the surface as it was; what is far finer than the size is coarsened in stages, so that triangles stay
// well shaped and work is proportional to their number; at last edges are flipped for angles (sheet.h), for the sake of
// the Delaunay mesh that has the triangles as facets.

#include "generate/resample.h"

#include <kropla/base/error.h>
#include "domain/cut.h"
#include <kropla/domain/words.h>
#include "generate/creases.h"
#include "generate/triangle.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace kropla {

namespace {

constexpr double split_above = 4.0 / 3, collapse_below = 4.0 / 5;  // of the size

/// The surface as it was, to which points go back.
struct Original {
    const TriangulatedSurface& surface;
    Creases creases;

    [[nodiscard]] Vec3 nearest(const Vec3& x, Sheet::Hold hold) const {
        return hold == Sheet::Hold::none ? surface.closest_point(x) : creases.nearest(x);
    }
    [[nodiscard]] Vec3 middle(const Sheet& sheet, Half h) const {
        const Vec3 x = 0.5 * (sheet.place[sheet.origin[h]] + sheet.place[sheet.target(h)]);
        return nearest(x, sheet.crease[h] != 0 ? Sheet::Hold::on_crease : Sheet::Hold::none);
    }
};

/// The size at an edge [m].
double size_at(const Sheet& sheet, Half h, const SurfaceSize& size) {
    return size.local ? size.local(0.5 * (sheet.place[sheet.origin[h]] + sheet.place[sheet.target(h)])) : size.most;
}

/// Once over the edges that there are, the longest first: in another order slivers are made. Returns how many.
int split_long_edges(Sheet& sheet, const Original& original, const SurfaceSize& size) {
    const auto is_long = [&](Half h) { return sheet.length(h) > split_above * size_at(sheet, h, size); };
    std::vector<std::pair<double, Half>> found;
    for (Half h : sheet.origin.indices())
        if (sheet.alive(h) && h < sheet.twin[h] && is_long(h)) found.emplace_back(-sheet.length(h), h);
    std::ranges::sort(found);
    for (const auto& [length, h] : found)  // which may name another edge by now
        if (is_long(h)) split_edge(sheet, h, original.middle(sheet, h));
    return static_cast<int>(found.size());
}

/// Those that are short for the size, or for `most` if that is less.
int collapse_short_edges(Sheet& sheet, double most, const SurfaceSize& size, const Watch* watch) {
    constexpr int most_rounds = 20;
    int all = 0;
    for (int round = 0, done = 1; done > 0 && round < most_rounds; ++round) {
        heed(watch);
        done = 0;
        for (Half h : sheet.origin.indices()) {
            if (!sheet.alive(h) || sheet.length(h) >= collapse_below * most) continue;
            const double here = size_at(sheet, h, size);
            if (sheet.length(h) >= collapse_below * here || !may_collapse(sheet, h, split_above * here)) continue;
            collapse_edge(sheet, h);
            ++done;
        }
        all += done;
    }
    return all;
}

/// Where the vertex would be best off among its triangles, along them.
Vec3 drawn_to(const Sheet& sheet, Vertex v) {
    const Vec3& x = sheet.place[v];
    if (sheet.hold[v] == Sheet::Hold::on_crease) {
        Vec3 sum;
        for_each_leaving(sheet, v, [&](Half h) {
            if (sheet.crease[h] != 0) sum += sheet.place[sheet.target(h)] - x;
        });
        return x + sum / 2;
    }
    Vec3 sum;
    double weight = 0;
    for_each_leaving(sheet, v, [&](Half h) {
        const Vec3 &b = sheet.place[sheet.target(h)], &c = sheet.place[sheet.apex(h)];
        const double area = norm(normal_area(sheet, h));
        sum += area * (0.5 * (triangle_circumcentre(x, b, c) + (x + b + c) / 3) - x);
        weight += area;
    });
    return x + sum / weight;
}

/// Would all triangles of the vertex stay well within a right angle of how they stand?
bool may_move(const Sheet& sheet, Vertex v, const Vec3& to) {
    bool may = true;
    for_each_leaving(sheet, v, [&](Half h) {
        const Vec3 old = normal_area(sheet, h), now = normal_area(sheet, h, v, to);
        may = may && dot(old, now) > most_turned * norm(old) * norm(now);
    });
    return may;
}

void move_points(Sheet& sheet, const Original& original) {
    for (Vertex v : sheet.place.indices()) {
        if (!sheet.leaving[v].exists() || sheet.hold[v] == Sheet::Hold::corner) continue;
        const Vec3 by = drawn_to(sheet, v) - sheet.place[v];
        if (!is_finite(by)) continue;  // a triangle without area
        for (double part : {1.0, 0.5, 0.25}) {
            const Vec3 to = original.nearest(sheet.place[v] + part * by, sheet.hold[v]);
            if (!may_move(sheet, v, to)) continue;
            sheet.place[v] = to;
            break;
        }
    }
}

double mean_length(const Sheet& sheet) {
    double sum = 0;
    for (Half h : sheet.origin.indices()) sum += sheet.length(h);
    return sum / static_cast<double>(sheet.origin.size());
}

/// Where the surface bends within a triangle of the size, edges that are split may not become shorter, and there is no end.
void check_budget(const Sheet& sheet, std::size_t halves_at_start, const Original& original, double size) {
    constexpr double generous = 100;  // triangles per square of the size, and per triangle at the start
    const auto most = generous * (original.surface.area() / (size * size) + static_cast<double>(halves_at_start));
    if (static_cast<double>(sheet.origin.size()) > most)
        throw DomainError("a surface of triangles bends too much for triangles of " + metres(size) +
                          ": a smaller size would do");
}

/// Splits what is too long, and coarsens in stages what is too fine.
void bring_near(Sheet& sheet, const Original& original, const SurfaceSize& size, const Watch* watch) {
    constexpr int most_rounds = 30;  // each halves the longest edges
    constexpr double stage = 1.5;
    const std::size_t at_start = sheet.origin.size();
    double least = size.most;
    for (Half h : sheet.origin.indices()) least = std::min(least, size_at(sheet, h, size));
    for (int round = 0; round < most_rounds && split_long_edges(sheet, original, size) > 0; ++round) {
        check_budget(sheet, at_start, original, least);
        flip_for_angles(sheet, watch);
    }
    for (double at = stage * std::min(size.most, mean_length(sheet)); at < size.most; at *= stage) {
        if (collapse_short_edges(sheet, at, size, watch) == 0) continue;
        sheet = compacted(sheet);
        flip_for_angles(sheet, watch);
    }
}

void relax(Sheet& sheet, const Original& original, const SurfaceSize& size, const Watch* watch) {
    constexpr int rounds = 12, fine_rounds = 15, moves = 3;
    for (int round = 0; round < rounds; ++round) {
        heed(watch);
        split_long_edges(sheet, original, size);
        collapse_short_edges(sheet, size.most, size, watch);
        sheet = compacted(sheet);
        flip_for_valences(sheet);
        for (int i = 0; i < moves; ++i) move_points(sheet, original);
    }
    for (int round = 0; round < fine_rounds; ++round) {
        flip_for_angles(sheet, watch);
        move_points(sheet, original);
    }
    flip_for_angles(sheet, watch);
}

/// The points of the shape's surface, given by its own axes, where it stands; and back. A cut one is given where it stands.
void put_in_place(Surface& surface, const Shape& shape) {
    if (shape.cut) return;
    for (Vec3& x : surface.points) x = shape.centre + rotated(shape.orientation, x);
}
void take_back(Surface& surface, const Shape& shape) {
    if (shape.cut) return;
    for (Vec3& x : surface.points) x = rotated_back(shape.orientation, x - shape.centre);
}

/// All of the surface, where faces of a box cut it too.
const TriangulatedSurface& whole_of(const Shape& shape) { return shape.cut ? shape.cut->whole : *shape.surface; }

/// With creases also where faces cut it.
Sheet whole_sheet(const Shape& shape) {
    Sheet sheet = sheet_of(whole_of(shape));
    if (!shape.cut) return sheet;
    for (Half h : sheet.origin.indices()) {
        const auto [low, high] = std::minmax({sheet.origin[h].value, sheet.target(h).value});
        if (std::ranges::binary_search(shape.cut->lines, std::array{low, high})) sheet.crease[h] = 1;
    }
    find_holds(sheet);
    return sheet;
}

/// Of the whole surface what is in the box, with its creases.
Surface surface_in(const Bounds& box, const Surface& whole) {
    PartInBox part = part_in(box, whole.points, whole.triangles);
    Surface surface{std::move(part.points), std::move(part.triangles)};
    for (const auto& [a, b] : whole.creases) {
        const int p = part.number[as_size(a)], q = part.number[as_size(b)];
        if (p >= 0 && q >= 0) surface.creases.push_back({std::min(p, q), std::max(p, q)});
    }
    return surface;
}

constexpr int none = -1;

/// Joins the open edges to one point more, since a sheet is closed; returns its number. Its edges are creases.
int close_by_tip(Surface& surface) {
    std::map<std::array<int, 2>, std::array<int, 2>> open;  // edges by their ends; as their triangle goes along them
    for (const auto& t : surface.triangles)
        for (std::size_t i = 0; i < 3; ++i) {
            const std::array edge = {t[i], t[(i + 1) % 3]};
            const auto [low, high] = std::minmax(edge[0], edge[1]);
            if (!open.try_emplace({low, high}, edge).second) open.erase({low, high});
        }
    const auto tip = static_cast<int>(surface.points.size());
    surface.points.push_back(surface.points.front());
    for (const auto& [ends, edge] : open) {
        surface.triangles.push_back({edge[1], edge[0], tip});
        for (int end : ends) surface.creases.push_back({end, tip});
    }
    return tip;
}

void hold_tip(Sheet& sheet, Vertex tip) {
    for (Half h : sheet.origin.indices())
        if (sheet.origin[h] == tip || sheet.target(h) == tip) sheet.crease[h] = 1;
}

void open_again(Surface& surface, int tip) {
    const auto has_tip = [&](const auto& vertices) { return std::ranges::find(vertices, tip) != vertices.end(); };
    std::erase_if(surface.triangles, has_tip);
    std::erase_if(surface.creases, has_tip);
    surface.points.erase(surface.points.begin() + tip);
    const auto renumber = [&](auto& all) {
        for (auto& vertices : all)
            for (int& v : vertices) v -= v > tip ? 1 : 0;
    };
    renumber(surface.triangles);
    renumber(surface.creases);
}

}  // namespace

Surface resampled(const Shape& shape, const SurfaceSize& asked, const Watch* watch) {
    SurfaceSize size{asked.most};  // in the shape's own axes
    if (asked.local)
        size.local = [&](const Vec3& x) { return asked.local(shape.centre + rotated(shape.orientation, x)); };
    Sheet sheet = whole_sheet(shape);
    const Original original{whole_of(shape), Creases(sheet)};
    bring_near(sheet, original, size, watch);
    relax(sheet, original, size, watch);
    Surface surface = surface_of(sheet);
    put_in_place(surface, shape);
    return shape.cut ? surface_in(shape.cut->box, surface) : surface;
}

Snapshot bounded_by(const std::vector<Surface>& walls, const Snapshot& at) {
    Snapshot bounded = at;
    for (std::size_t body = 0; body < walls.size(); ++body) {
        Shape& shape = bounded.shapes[body];
        if (!shape.surface) continue;
        std::vector<Vec3> points = walls[body].points;
        try {
            if (shape.cut) {
                // The line in which it ends there is shorter than its triangles.
                if (const auto lies = triangle_on_face(shape.cut->box, points, walls[body].triangles))
                    throw SurfaceError("the line in which it ends on " + wall_name(lies->face) + " has too few edges, at " +
                                           place_words(points[as_size(walls[body].triangles[lies->triangle][0])]),
                                       {lies->triangle});
                shape = shape_of_facets(std::move(points), walls[body].triangles, &shape.cut->box);
                continue;
            }
            for (Vec3& x : points) x -= shape.centre;
            shape = shape_within(make_surface(std::move(points), walls[body].triangles), shape.centre);
        } catch (const SurfaceError& error) {
            const Surface& wall = walls[body];
            const double size = error.triangles.empty()
                                    ? surface_size(at, body)
                                    : surface_size(at, body, wall.points[as_size(wall.triangles[error.triangles.front()][0])]);
            throw BodyError(body, "at its target size, " + metres(size) + " there, " + error.what() +
                                      (shape.cut ? "" : " (from its centre)") + "; a smaller size may do");
        }
    }
    return bounded;
}

std::vector<Added> refine(Surface& surface, const std::vector<std::size_t>& triangles, const Shape& shape) {
    const Original original{whole_of(shape), Creases(whole_sheet(shape))};
    take_back(surface, shape);
    const int tip = shape.cut ? close_by_tip(surface) : none;
    Sheet sheet = make_sheet(surface);
    std::vector<Added> added;
    const Array<Half, Vertex> before = sheet.origin;
    for (std::size_t t : triangles) {
        const Half first(3 * t);
        const std::array halves = {first, next(first), previous(first)};
        if (std::ranges::any_of(halves, [&](Half h) { return sheet.origin[h] != before[h]; }))
            continue;  // split from across an edge of it
        const Half longest = *std::ranges::max_element(halves, {}, [&](Half h) { return sheet.length(h); });
        const double half_edge = 0.5 * sheet.length(longest);
        const Vec3 middle = original.middle(sheet, longest);
        split_edge(sheet, longest, middle);
        added.push_back({shape.centre + rotated(shape.orientation, middle), half_edge});
    }
    if (tip != none) hold_tip(sheet, Vertex(tip));
    flip_for_angles(sheet);
    surface = surface_of(sheet);
    if (tip != none) open_again(surface, tip);
    put_in_place(surface, shape);
    return added;
}

}  // namespace kropla
