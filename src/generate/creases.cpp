// Sharp edges of triangulated surfaces, by the angle between triangles [Botsch, Kobbelt 2004, "A remeshing approach to
// multiresolution modeling", of features].

#include "generate/creases.h"

#include <algorithm>
#include <cmath>

namespace kropla {

namespace {

std::vector<std::pair<Vec3, Vec3>> crease_segments(const Sheet& sheet) {
    std::vector<std::pair<Vec3, Vec3>> segments;
    for (Half h : sheet.origin.indices())
        if (sheet.alive(h) && sheet.crease[h] != 0 && h < sheet.twin[h])
            segments.emplace_back(sheet.place[sheet.origin[h]], sheet.place[sheet.target(h)]);
    return segments;
}

std::vector<Extent> boxes_of(const std::vector<std::pair<Vec3, Vec3>>& segments) {
    std::vector<Extent> boxes;
    for (const auto& [a, b] : segments) {
        boxes.emplace_back();
        boxes.back().take_in(a);
        boxes.back().take_in(b);
    }
    return boxes;
}

}  // namespace

void find_holds(Sheet& sheet) {
    for (Vertex v : sheet.place.indices()) {
        if (!sheet.leaving[v].exists()) continue;
        std::vector<Vec3> along;
        for_each_leaving(sheet, v, [&](Half h) {
            if (sheet.crease[h] != 0) along.push_back(sheet.place[sheet.target(h)] - sheet.place[v]);
        });
        const bool straight = along.size() == 2 && angle_between(along[0], -along[1]) < sharp;
        sheet.hold[v] = along.empty() ? Sheet::Hold::none : straight ? Sheet::Hold::on_crease : Sheet::Hold::corner;
    }
}

Sheet sheet_of(const TriangulatedSurface& surface) {
    Surface triangles;
    triangles.points.assign(surface.points().begin(), surface.points().end());
    triangles.triangles.assign(surface.triangles().begin(), surface.triangles().end());
    Sheet sheet = make_sheet(triangles);
    for (Half h : sheet.origin.indices())
        sheet.crease[h] = angle_between(normal_area(sheet, h), normal_area(sheet, sheet.twin[h])) > sharp ? 1 : 0;
    find_holds(sheet);
    return sheet;
}

Creases::Creases(const Sheet& sheet) : segments_(crease_segments(sheet)), tree_(boxes_of(segments_)) {}

Vec3 Creases::nearest(const Vec3& x) const {
    Vec3 found = x;
    double least = Extent::infinite;
    tree_.least([&](const Extent& box) { return box.squared_distance(x); },
                [&](std::size_t item) {
                    const Vec3 there = closest_on_segment(segments_[item].first, segments_[item].second, x);
                    const double away = squared_norm(there - x);
                    if (away < least) {
                        least = away;
                        found = there;
                    }
                    return away;
                });
    return found;
}

}  // namespace kropla
