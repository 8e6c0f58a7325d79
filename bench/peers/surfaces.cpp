// peers_surfaces FRAME.vtu BASE cx cy cz radius surface growth far: what the other mesh generators start from. Of a
// frame, the triangles of the sphere (entity 1) and of the box (entity 2), as BASE.msh (Gmsh 2.2) and BASE.smesh
// (TetGen), and the target size at the frame's vertices as BASE.b.node, .b.ele and .b.mtr (TetGen's background mesh).

#include "cells.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <map>
#include <memory>
#include <stdexcept>

namespace peers {
namespace {

using Triangle = std::array<int, 3>;

struct Surfaces {
    std::vector<Point> places;        // of the vertices on a surface
    std::vector<Triangle> sphere, box;  // by their numbers, from 0
};

struct SizeField {
    Point centre;
    double radius, surface, growth, far;  // [m], growth in metres per metre
};

double target_size(const SizeField& size, const Point& p) {
    const double away = std::abs(length(difference(p, size.centre)) - size.radius);
    return std::min(size.far, size.surface + size.growth * away);
}

/// The facets that one tet has, or two of different regions.
Surfaces surfaces_of(const Cells& cells) {
    struct Sides {
        Triangle corners;
        int count = 0, region_sum = 0;
    };
    std::map<Triangle, Sides> facets;
    constexpr int opposite[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
    for (std::size_t t = 0; t < cells.tets.size(); ++t)
        for (const auto& f : opposite) {
            Triangle corners, key;
            for (std::size_t i = 0; i < 3; ++i) corners[i] = cells.tets[t][static_cast<std::size_t>(f[i])];
            key = corners;
            std::ranges::sort(key);
            Sides& sides = facets[key];
            if (sides.count == 0 || cells.region[t] == 1) sides.corners = corners;
            ++sides.count;
            sides.region_sum += cells.region[t];
        }
    Surfaces surfaces;
    std::map<int, int> number;
    const auto numbered = [&](Triangle corners) {
        for (int& v : corners) {
            const auto [found, is_new] = number.try_emplace(v, static_cast<int>(surfaces.places.size()));
            if (is_new) surfaces.places.push_back(cells.places[static_cast<std::size_t>(v)]);
            v = found->second;
        }
        return corners;
    };
    for (const auto& [key, sides] : facets) {
        if (sides.count == 1) surfaces.box.push_back(numbered(sides.corners));
        else if (sides.region_sum == 1) surfaces.sphere.push_back(numbered(sides.corners));
    }
    return surfaces;
}

struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

File create(const std::string& name) {
    File file(std::fopen(name.c_str(), "w"));
    if (!file) throw std::runtime_error(name + ": cannot be written");
    return file;
}

void write_msh(const std::string& base, const Surfaces& surfaces) {
    const File file = create(base + ".msh");
    std::fprintf(file.get(), "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%zu\n", surfaces.places.size());
    int name = 0;
    for (const Point& p : surfaces.places)
        std::fprintf(file.get(), "%d %.17g %.17g %.17g\n", ++name, p[0], p[1], p[2]);
    std::fprintf(file.get(), "$EndNodes\n$Elements\n%zu\n", surfaces.sphere.size() + surfaces.box.size());
    name = 0;
    for (const int entity : {1, 2})
        for (const Triangle& t : entity == 1 ? surfaces.sphere : surfaces.box)
            std::fprintf(file.get(), "%d 2 2 %d %d %d %d %d\n", ++name, entity, entity, t[0] + 1, t[1] + 1,
                         t[2] + 1);
    std::fprintf(file.get(), "$EndElements\n");
}

void write_smesh(const std::string& base, const Surfaces& surfaces, const SizeField& size) {
    const File file = create(base + ".smesh");
    std::fprintf(file.get(), "%zu 3 0 0\n", surfaces.places.size());
    int name = 0;
    for (const Point& p : surfaces.places)
        std::fprintf(file.get(), "%d %.17g %.17g %.17g\n", ++name, p[0], p[1], p[2]);
    std::fprintf(file.get(), "%zu 1\n", surfaces.sphere.size() + surfaces.box.size());
    for (const int entity : {1, 2})
        for (const Triangle& t : entity == 1 ? surfaces.sphere : surfaces.box)
            std::fprintf(file.get(), "3 %d %d %d %d\n", t[0] + 1, t[1] + 1, t[2] + 1, entity);
    const Point& corner = *std::ranges::min_element(surfaces.places);  // of the box
    std::fprintf(file.get(), "0\n2\n1 %.17g %.17g %.17g 1\n2 %.17g %.17g %.17g 2\n", size.centre[0],
                 size.centre[1], size.centre[2], corner[0] + 1e-3 * size.radius, corner[1] + 1e-3 * size.radius,
                 corner[2] + 1e-3 * size.radius);
}

void write_background(const std::string& base, const Cells& cells, const SizeField& size) {
    const File nodes = create(base + ".b.node"), tets = create(base + ".b.ele"), sizes = create(base + ".b.mtr");
    std::fprintf(nodes.get(), "%zu 3 0 0\n", cells.places.size());
    std::fprintf(sizes.get(), "%zu 1\n", cells.places.size());
    int name = 0;
    for (const Point& p : cells.places) {
        std::fprintf(nodes.get(), "%d %.17g %.17g %.17g\n", ++name, p[0], p[1], p[2]);
        std::fprintf(sizes.get(), "%.17g\n", target_size(size, p));
    }
    std::fprintf(tets.get(), "%zu 4 0\n", cells.tets.size());
    name = 0;
    for (const auto& t : cells.tets)
        std::fprintf(tets.get(), "%d %d %d %d %d\n", ++name, t[0] + 1, t[1] + 1, t[2] + 1, t[3] + 1);
}

}  // namespace
}  // namespace peers

int main(int count, char** arguments) try {
    using namespace peers;
    if (count != 10) throw std::runtime_error("FRAME.vtu BASE cx cy cz radius surface growth far");
    const auto number = [&](int i) { return std::atof(arguments[i]); };
    const SizeField size = {{number(3), number(4), number(5)}, number(6), number(7), number(8), number(9)};
    const std::string base = arguments[2];
    const Cells cells = read_cells(arguments[1]);
    const Surfaces surfaces = surfaces_of(cells);
    write_msh(base, surfaces);
    write_smesh(base, surfaces, size);
    write_background(base, cells, size);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "peers_surfaces: %s\n", error.what());
    return 5;
}
