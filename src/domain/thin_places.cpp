#include "domain/thin_places.h"

#include "base/for_all.h"
#include <kropla/domain/domain.h>
#include "domain/sharp_edges.h"
#include "domain/triangulated_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace kropla {
namespace {

constexpr ThinPlaces::Width nowhere{std::numeric_limits<double>::infinity(), ThinPlaces::Kind::body, {}};

/// To the nearest of the faces of the box on which the surface ends, but for these [m].
double distance_to_faces(const TriangulatedSurface& surface, unsigned but, const Vec3& x) {
    double least = std::numeric_limits<double>::infinity();
    for (int face = 0; face < 6; ++face) {
        if (((surface.reached() & ~but) >> face & 1u) == 0) continue;
        const Extent& extent = surface.extent();
        least = std::min(least, std::abs(x[face / 2] - (face % 2 == 0 ? extent.min : extent.max)[face / 2]));
    }
    return least;
}

}  // namespace

/// A triangle of a surface is looked at, and what is found there.
struct ThinPlaces::Look {
    const TriangulatedSurface& surface;
    std::size_t triangle;
    double least, most;  // [m]
    double coarse;       // [m] longer parts are halved in any case, so that nothing of that extent is overlooked
    Vec3 normal;
    std::vector<Place> places = {};
    Width narrowest = nowhere;

    /// The size there [m].
    double at(const Vec3& x) {
        constexpr double parallel = 0.94;  // cosine of 20 degrees
        Width narrower = nowhere;
        for (const bool inside : {true, false})
            if (const double width = surface.width_between(x, normal, inside, most / neck_share, parallel); width < narrower.across)
                narrower = {width, inside ? Kind::body : Kind::slot, x};
        const double width = narrower.across;
        if (width < narrowest.across) narrowest = narrower;
        if (!(width < most / neck_share)) return most;
        return std::clamp(std::clamp(surface.radius_at(triangle), neck_share * width, gap_share * width), least, most);
    }

    /// Halved along the longest edge until the sizes found in it are alike, or it is as short as they are.
    void halve(const Corners& part) {
        constexpr double alike = 1.25;      // [-]
        constexpr double to_corner = 0.8;   // [-] of the way from the middle
        std::size_t i = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (distance(part[k], part[(k + 1) % 3]) > distance(part[i], part[(i + 1) % 3])) i = k;
        const Vec3 &a = part[i], &b = part[(i + 1) % 3], &c = part[(i + 2) % 3], middle = (a + b + c) / 3;
        const double length = distance(a, b);
        double smallest = at(middle), largest = smallest;
        if (length > smallest)
            for (const Vec3& corner : part) {
                const double there = at(middle + to_corner * (corner - middle));
                largest = std::max(largest, there);
                smallest = std::min(smallest, there);
            }
        if (length > coarse || (length > smallest && largest > alike * smallest)) {
            const Vec3 between = 0.5 * (a + b);
            halve({a, between, c});
            halve({between, b, c});
        } else if (smallest < most) {
            places.push_back({part, smallest});
        }
    }
};

/// A segment of a sharp edge is looked at: how near others are that it does not meet.
struct ThinPlaces::EdgeLook {
    const TriangulatedSurface& surface;
    const SharpEdges& edges;
    const BoxTree& tree;  // of their segments
    double least, most;   // [m]
    double coarse;        // [m] as for triangles
    int course;
    std::vector<Place> places = {};
    Width narrowest = nowhere;

    /// The size there [m].
    double at(const Vec3& x) {
        constexpr double near = 0.4;  // [of the size] edges that are farther from each other are meshed as they are
        const double beyond = near * most;
        const double to_edges = tree.least([&](const Extent& box) { return std::sqrt(box.squared_distance(x)); },
                                           [&](std::size_t i) {
                                               const SharpEdges::Segment& other = edges.segments[i];
                                               return edges.meet(course, other.course)
                                                          ? beyond
                                                          : distance(closest_on_segment(other.a, other.b, x), x);
                                           },
                                           beyond);
        const double to_faces = distance_to_faces(surface, edges.courses[static_cast<std::size_t>(course)].faces, x);
        const double width = std::min(to_edges, to_faces);
        if (!(width < beyond)) return most;
        if (width < narrowest.across) narrowest = {width, to_edges <= to_faces ? Kind::edges : Kind::edge_at_face, x};
        return std::clamp(gap_share * width, least, most);
    }

    /// Halved until it is as short as the sizes found.
    void halve(const Vec3& a, const Vec3& b) {
        const Vec3 middle = 0.5 * (a + b);
        const double size = std::min({at(a), at(middle), at(b)}), length = distance(a, b);
        if (length > coarse || (length > size && size < most)) {
            halve(a, middle);
            halve(middle, b);
        } else if (size < most) {
            places.push_back({{a, b, b}, size});
        }
    }
};

ThinPlaces::ThinPlaces(const TriangulatedSurface& surface, double least, double most) : most_(most), narrowest_(nowhere) {
    constexpr double alike = 1.2;       // [-] sizes
    constexpr double most_along = 500;  // parts along the surface, however small sizes are
    const double coarse = std::max(most, distance(surface.extent().min, surface.extent().max) / most_along);
    std::vector<Look> looks;
    for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
        const Corners corners = surface.tree().corners(t);
        looks.push_back({surface, t, least, most, coarse, normalised(cross(corners[1] - corners[0], corners[2] - corners[0]))});
    }
    for_all(looks.size(), [&](std::size_t t) { looks[t].halve(surface.tree().corners(t)); }, 16);
    const SharpEdges edges(surface);
    std::vector<Extent> extents;
    for (const SharpEdges::Segment& segment : edges.segments) extents.push_back(extent({segment.a, segment.b, segment.b}));
    const BoxTree tree(std::move(extents));
    std::vector<EdgeLook> edge_looks;
    for (const SharpEdges::Segment& segment : edges.segments)
        edge_looks.push_back({surface, edges, tree, least, most, coarse, segment.course});
    for_all(edge_looks.size(), [&](std::size_t e) { edge_looks[e].halve(edges.segments[e].a, edges.segments[e].b); }, 16);
    std::map<int, std::vector<Place>> by_size;
    const auto take = [&](const auto& look) {
        if (look.narrowest.across < narrowest_.across) narrowest_ = look.narrowest;
        for (const Place& place : look.places)
            by_size[static_cast<int>(std::log(place.size / least) / std::log(alike))].push_back(place);
    };
    std::ranges::for_each(looks, take);
    std::ranges::for_each(edge_looks, take);
    for (auto& [number, places] : by_size) {
        const double smallest = std::ranges::min_element(places, {}, &Place::size)->size;
        std::vector<Extent> boxes;
        for (const Place& place : places) boxes.push_back(extent(place.part));
        groups_.push_back({smallest, std::move(places), BoxTree(std::move(boxes))});
    }
}

double ThinPlaces::size(const Vec3& x, double growth) const {
    double size = most_;
    for (const Group& group : groups_)
        size = group.tree.least(
            [&](const Extent& box) { return group.smallest + growth * std::sqrt(box.squared_distance(x)); },
            [&](std::size_t i) {
                const Place& place = group.places[i];
                return place.size + growth * distance(closest_on_triangle(place.part, x).point, x);
            },
            size);
    return size;
}

}  // namespace kropla
