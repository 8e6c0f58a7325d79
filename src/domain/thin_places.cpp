#include "domain/thin_places.h"

#include "base/for_all.h"
#include <kropla/domain/domain.h>
#include "domain/triangulated_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace kropla {
namespace {

constexpr ThinPlaces::Width nowhere{std::numeric_limits<double>::infinity(), true, {}};

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
                narrower = {width, inside, x};
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
    std::map<int, std::vector<Place>> by_size;
    for (const Look& look : looks) {
        if (look.narrowest.across < narrowest_.across) narrowest_ = look.narrowest;
        for (const Place& place : look.places)
            by_size[static_cast<int>(std::log(place.size / least) / std::log(alike))].push_back(place);
    }
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
