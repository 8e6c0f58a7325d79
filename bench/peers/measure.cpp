// peers_measure FILE ...: how good the tets of mesh files are, a line of CSV for each, whoever made them. From the
// definitions: R = |alpha u + beta v + gamma w| / 12 V of the edges u, v, w at a corner and their squared lengths,
// r = 3 V / area; dihedral angles between the normals of the facets.

#include "cells.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <limits>
#include <set>

namespace peers {
namespace {

struct TetShape {
    double volume, aspect_ratio, least_angle, largest_angle;  // [m^3], R/r, [degrees]
};

using Corners = std::array<Point, 4>;

/// Normals of the facets opposite the corners, twice their areas long.
std::array<Point, 4> facet_normals(const Corners& x) {
    std::array<Point, 4> normals;
    constexpr int facets[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& f = facets[i];
        const Point &a = x[static_cast<std::size_t>(f[0])], &b = x[static_cast<std::size_t>(f[1])],
                    &c = x[static_cast<std::size_t>(f[2])];
        normals[i] = cross(difference(b, a), difference(c, a));
    }
    return normals;
}

double circumradius(const Corners& x, double volume) {
    const Point u = difference(x[1], x[0]), v = difference(x[2], x[0]), w = difference(x[3], x[0]);
    const Point vw = cross(v, w), wu = cross(w, u), uv = cross(u, v);
    Point sum;
    for (std::size_t i = 0; i < 3; ++i) sum[i] = dot(u, u) * vw[i] + dot(v, v) * wu[i] + dot(w, w) * uv[i];
    return length(sum) / (12 * std::abs(volume));
}

TetShape shape_of(const Corners& x) {
    TetShape shape{};
    const Point u = difference(x[1], x[0]), v = difference(x[2], x[0]), w = difference(x[3], x[0]);
    shape.volume = dot(u, cross(v, w)) / 6;
    const auto normals = facet_normals(x);
    double area = 0;
    for (const Point& n : normals) area += length(n) / 2;
    shape.aspect_ratio = circumradius(x, shape.volume) * area / (3 * std::abs(shape.volume));
    if (!std::isfinite(shape.aspect_ratio)) shape.aspect_ratio = std::numeric_limits<double>::infinity();
    shape.least_angle = 180;
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = i + 1; j < 4; ++j) {
            const double cosine = -dot(normals[i], normals[j]) / (length(normals[i]) * length(normals[j]));
            const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::acos(-1.0);
            shape.least_angle = std::min(shape.least_angle, angle);
            shape.largest_angle = std::max(shape.largest_angle, angle);
        }
    return shape;
}

void print_measures(const std::string& file) {
    const Cells cells = read_cells(file);
    std::vector<double> ratios;
    std::set<int> used;
    double sum = 0, least = 180, largest = 0, volume = 0;
    int over_limit = 0, positive = 0, negative = 0;
    for (const auto& tet : cells.tets) {
        Corners x;
        for (std::size_t i = 0; i < 4; ++i) x[i] = cells.places[static_cast<std::size_t>(tet[i])];
        const TetShape shape = shape_of(x);
        ratios.push_back(shape.aspect_ratio);
        sum += shape.aspect_ratio;
        volume += std::abs(shape.volume);
        (shape.volume > 0 ? positive : negative) += 1;
        if (shape.aspect_ratio > 10) ++over_limit;
        least = std::min(least, shape.least_angle);
        largest = std::max(largest, shape.largest_angle);
        used.insert(tet.begin(), tet.end());
    }
    std::ranges::sort(ratios);
    const auto rank = static_cast<std::size_t>(std::ceil(0.999 * static_cast<double>(ratios.size()))) - 1;
    std::printf("%s,%zu,%zu,%.6g,%.6g,%.6g,%d,%.6g,%.6g,%.12g,%d\n", file.c_str(), used.size(), ratios.size(),
                ratios.back(), sum / static_cast<double>(ratios.size()), ratios[rank], over_limit, least, largest,
                volume, std::min(positive, negative));
}

}  // namespace
}  // namespace peers

int main(int count, char** arguments) try {
    std::printf("file,vertices,tets,worst,mean,p999,over_10,least_angle,largest_angle,volume,turned_over\n");
    for (int i = 1; i < count; ++i) peers::print_measures(arguments[i]);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "peers_measure: %s\n", error.what());
    return 5;
}
