// Hidden surfaces are painted over by what is nearer [Newell, Newell, Sancha 1972, "A solution to the hidden surface problem"],
// by the depths of the triangles' middles alone, as they are of like size and do not cut each other. Where a surface folds that
// is not the right order for all; so those that are hidden at their middle and near their corners are left out.
#include "report/surface_picture.h"

#include <kropla/mesh/topology.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace kropla {
namespace {

constexpr double width = 300;  // [pixels] of a picture
constexpr double margin = 0.05;  // of its window, on each side
constexpr int shades = 24;
constexpr double in_shade = 0.5;  // [-] of a colour, where no light falls

const Vec3 to_viewer = normalised(Vec3{0.55, -1, 0.5}), to_light = normalised(Vec3{0.1, -0.9, 1});
const Vec3 right = normalised(cross(Vec3{0, 0, 1}, to_viewer)), up = cross(to_viewer, right);

Point2 projected(const Vec3& x) { return {dot(x, right), dot(x, up)}; }

Vec3 normal_of(const SurfaceTriangle& t) {
    return cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]);
}
bool is_seen(const SurfaceTriangle& t) { return dot(normal_of(t), to_viewer) > 0; }

int shade_of(const SurfaceTriangle& t) {
    const double light = std::max(0.0, dot(normalised(normal_of(t)), to_light));
    return std::clamp(static_cast<int>(light * shades), 0, shades - 1);
}

std::string colour_of(Region region, int shade) {
    constexpr std::array<std::array<double, 3>, 4> bodies = {{{245, 154, 60}, {217, 99, 107}, {232, 193, 74}, {176, 124, 192}}};
    const auto& colour = bodies[static_cast<std::size_t>(region.value - 1) % bodies.size()];
    const double part = in_shade + (1 - in_shade) * (shade + 0.5) / shades;
    const auto level = [&](std::size_t i) { return static_cast<int>(std::lround(part * colour[i])); };
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", level(0), level(1), level(2));
    return text;
}

/// A triangle as it is seen: its corners in the picture's plane, and how far towards the viewer they are [m].
struct Seen {
    std::array<Point2, 3> places;
    std::array<double, 3> depths;
    const SurfaceTriangle* triangle;

    [[nodiscard]] double depth() const { return (depths[0] + depths[1] + depths[2]) / 3; }
    /// Of the corners, in turn, by these weights, the sum of which is 1.
    [[nodiscard]] Point2 place_at(const std::array<double, 3>& w) const {
        return {w[0] * places[0].x + w[1] * places[1].x + w[2] * places[2].x,
                w[0] * places[0].y + w[1] * places[1].y + w[2] * places[2].y};
    }
    [[nodiscard]] double depth_at(const std::array<double, 3>& w) const {
        return w[0] * depths[0] + w[1] * depths[1] + w[2] * depths[2];
    }
    /// The weights of a place; within, all are positive.
    [[nodiscard]] std::array<double, 3> weights(Point2 p) const {
        const auto twice = [](Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); };
        const auto& [a, b, c] = places;
        const double all = twice(a, b, c);
        return {twice(p, b, c) / all, twice(a, p, c) / all, twice(a, b, p) / all};
    }
};

std::vector<Seen> seen_of(std::span<const SurfaceTriangle> triangles) {
    std::vector<Seen> seen;
    for (const SurfaceTriangle& t : triangles) {
        if (!is_seen(t)) continue;
        Seen s{{}, {}, &t};
        for (std::size_t i = 0; i < 3; ++i) {
            s.places[i] = projected(t.corners[i]);
            s.depths[i] = dot(t.corners[i], to_viewer);
        }
        seen.push_back(s);
    }
    return seen;
}

/// Triangles by the squares of a grid over the window that they may lie in.
class Squares {
public:
    Squares(const CutWindow& window, std::span<const Seen> seen) : window_(window), squares_(across * across) {
        for (const Seen& s : seen) {
            const auto [left, right_end] = std::minmax({s.places[0].x, s.places[1].x, s.places[2].x});
            const auto [low, high] = std::minmax({s.places[0].y, s.places[1].y, s.places[2].y});
            for (std::size_t i = column(left); i <= column(right_end); ++i)
                for (std::size_t j = line(low); j <= line(high); ++j) squares_[i * across + j].push_back(&s);
        }
    }
    /// Is one of the others nearer to the viewer at this place?
    [[nodiscard]] bool is_hidden(const Seen& of, const std::array<double, 3>& weights) const {
        constexpr double rounding = 1e-9;  // so that a place on the edge between two is in one
        const Point2 p = of.place_at(weights);
        const double depth = of.depth_at(weights);
        return std::ranges::any_of(squares_[column(p.x) * across + line(p.y)], [&](const Seen* other) {
            const auto w = other->weights(p);
            return other != &of && std::ranges::all_of(w, [](double x) { return x > -rounding; }) && other->depth_at(w) > depth;
        });
    }

private:
    static constexpr std::size_t across = 64;
    [[nodiscard]] std::size_t column(double x) const { return at((x - window_.min.x) / (window_.max.x - window_.min.x)); }
    [[nodiscard]] std::size_t line(double y) const { return at((y - window_.min.y) / (window_.max.y - window_.min.y)); }
    static std::size_t at(double part) { return static_cast<std::size_t>(std::clamp(part * across, 0.0, across - 1.0)); }

    CutWindow window_;
    std::vector<std::vector<const Seen*>> squares_;
};

/// Those that are not hidden, the farthest first.
std::vector<Seen> in_order(const std::vector<Seen>& seen, const CutWindow& window) {
    constexpr double near = 0.9, far = (1 - near) / 2, third = 1.0 / 3;
    constexpr std::array<std::array<double, 3>, 4> places = {
        {{third, third, third}, {near, far, far}, {far, near, far}, {far, far, near}}};
    const Squares squares(window, seen);
    std::vector<Seen> shown;
    for (const Seen& s : seen)
        if (!std::ranges::all_of(places, [&](const auto& place) { return squares.is_hidden(s, place); })) shown.push_back(s);
    std::ranges::stable_sort(shown, {}, &Seen::depth);
    return shown;
}

constexpr double room_for_axes = 34;  // [pixels] below

/// The axes x, y and z as lines with their names, in the lower left corner.
std::string draw_axes(double height) {
    constexpr double length = 24, left = 22, above = 10, beyond = 1.35;  // [pixels], of the line
    const Point2 origin{left, height - above};
    std::string lines, names;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 along;
        along[axis] = length;
        const Point2 to = projected(along);
        lines += line_path(std::array{origin, Point2{origin.x + to.x, origin.y - to.y}});
        names += "<text class=\"tick\" text-anchor=\"middle\" x=\"" + pixels(origin.x + beyond * to.x) + "\" y=\"" +
                 pixels(origin.y - beyond * to.y + 4) + "\">" + "xyz"[axis] + "</text>";
    }
    return "<path class=\"axes\" d=\"" + lines + "\"/>" + names;
}

}  // namespace

std::vector<SurfaceTriangle> surface_triangles(const Mesh& mesh) {
    std::vector<SurfaceTriangle> triangles;
    for (const Tet t : all_tets(mesh))
        for (int corner = 0; corner < 4 && mesh.region[t] != surroundings; ++corner) {
            const Tet n = mesh.neighbour[t][as_size(corner)];
            if (n.exists() && mesh.region[n] == mesh.region[t]) continue;
            const auto [a, b, c] = facet_vertices(mesh, {t, corner});
            triangles.push_back({mesh.region[t], {mesh.position[a], mesh.position[b], mesh.position[c]}});
        }
    return triangles;
}

CutWindow extent_in_space(std::span<const SurfaceTriangle> triangles) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    CutWindow window{{infinity, infinity}, {-infinity, -infinity}};
    for (const SurfaceTriangle& t : triangles)
        for (const Vec3& x : t.corners) {
            const auto [px, py] = projected(x);
            window.min = {std::min(window.min.x, px), std::min(window.min.y, py)};
            window.max = {std::max(window.max.x, px), std::max(window.max.y, py)};
        }
    const double more = margin * std::max(window.max.x - window.min.x, window.max.y - window.min.y);
    return {{window.min.x - more, window.min.y - more}, {window.max.x + more, window.max.y + more}};
}

std::size_t count_seen(std::span<const SurfaceTriangle> triangles) {
    return static_cast<std::size_t>(std::ranges::count_if(triangles, is_seen));
}

std::string draw_surfaces(std::span<const SurfaceTriangle> triangles, const CutWindow& window) {
    const double scale = width / (window.max.x - window.min.x), height = (window.max.y - window.min.y) * scale + room_for_axes;
    std::string svg = "<svg class=\"picture cells\" viewBox=\"0 0 " + pixels(width) + ' ' + pixels(height) + "\" role=\"img\">";
    std::string fill, path;
    const auto finish = [&] {
        if (!path.empty()) svg += "<path fill=\"" + fill + "\" d=\"" + path + "\"/>";
        path.clear();
    };
    for (const Seen& s : in_order(seen_of(triangles), window)) {
        const std::string colour = colour_of(s.triangle->region, shade_of(*s.triangle));
        if (colour != fill) finish();
        fill = colour;
        auto places = s.places;
        for (Point2& p : places) p = {(p.x - window.min.x) * scale, (window.max.y - p.y) * scale};
        path += polygon_path(places);
    }
    finish();
    return svg + draw_axes(height) + "</svg>";
}

}  // namespace kropla
