// The box: its corners, edges and faces, and points along its edges.

#include "generate/box.h"

#include <kropla/base/error.h>

#include <algorithm>
#include <cmath>

namespace kropla {

std::vector<Vec3> box_corners(const Box& box) {
    std::vector<Vec3> corners;
    for (double z : {box.min.z, box.max.z})
        for (double y : {box.min.y, box.max.y})
            for (double x : {box.min.x, box.max.x}) corners.push_back({x, y, z});
    return corners;
}

namespace {

/// Points from `start` along `axis` to `end`, both left out. The count of edges is the integral of 1 / size,
/// rounded; the points divide that integral evenly.
void space_evenly(const Snapshot& at, const Vec3& start, int axis, double end, std::vector<Vec3>& into) {
    constexpr double step = 1.0 / 16;  // of the local size
    std::vector<double> places = {start[axis]}, integral = {0};
    for (Vec3 x = start; x[axis] < end;) {
        const double ds = std::min(step * target_size(at, x), end - x[axis]);
        if (!(x[axis] + ds > x[axis]))
            throw DomainError("the box is too far from the origin for cells of so small a size");
        Vec3 middle = x;
        middle[axis] += 0.5 * ds;
        integral.push_back(integral.back() + ds / target_size(at, middle));
        x[axis] = x[axis] + ds < end ? x[axis] + ds : end;
        places.push_back(x[axis]);
    }
    const int edges = std::max(1, static_cast<int>(std::lround(integral.back())));
    int k = 1;
    for (std::size_t i = 1; i < places.size(); ++i)
        for (; k < edges && integral[i] >= integral.back() * k / edges; ++k) {
            const double part =
                (integral.back() * k / edges - integral[i - 1]) / (integral[i] - integral[i - 1]);
            Vec3 x = start;
            x[axis] = places[i - 1] + part * (places[i] - places[i - 1]);
            into.push_back(x);
        }
}

}  // namespace

std::vector<Vec3> sample_box_edges(const Snapshot& at, const std::vector<Vec3>& given) {
    std::vector<Vec3> points;
    for (const Vec3& corner : box_corners(at.box))
        for (int axis = 0; axis < 3; ++axis) {
            if (corner[axis] != at.box.min[axis]) continue;
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::vector<double> ends = {at.box.max[axis]};
            for (const Vec3& x : given)
                if (x[u] == corner[u] && x[v] == corner[v] && x[axis] > corner[axis]) ends.push_back(x[axis]);
            std::ranges::sort(ends);
            ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
            Vec3 start = corner;
            for (double end : ends) {
                space_evenly(at, start, axis, end, points);
                start[axis] = end;
            }
        }
    return points;
}

Box face_of_box(const Box& box, Patch patch) {
    const int axis = patch.value / 2;
    Box face = box;
    if (patch.value % 2 == 0) face.max[axis] = box.min[axis];
    else face.min[axis] = box.max[axis];
    return face;
}

bool lies_on_face(const Box& box, Patch patch, const Vec3& x) {
    const int axis = patch.value / 2;
    return x[axis] == (patch.value % 2 == 0 ? box.min[axis] : box.max[axis]);
}

Patch shared_face(const Box& box, std::initializer_list<Vec3> points) {
    for (Patch patch(0); patch.value < 6; ++patch.value)
        if (std::ranges::all_of(points, [&](const Vec3& x) { return lies_on_face(box, patch, x); }))
            return patch;
    return {};
}

double distance_to_walls(const Box& box, const Vec3& x) {
    return std::min({x.x - box.min.x, box.max.x - x.x, x.y - box.min.y, box.max.y - x.y, x.z - box.min.z,
                     box.max.z - x.z});
}

}  // namespace kropla
