// kropla_raw_mesh SIZE OUT: the Delaunay mesh, before any improvement, of well-spaced points in a unit box with a sphere
// of radius 0.25 as interface, edges SIZE everywhere (0.0256: 600,000 tets), for `kropla improve` to work on.

#include <kropla/generate/generate.h>
#include <kropla/io/mesh_file.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

int main(int argc, char** argv) try {
    using namespace kropla;
    if (argc != 3) {
        std::fprintf(stderr, "kropla_raw_mesh SIZE OUT\n");
        return 2;
    }
    const double size = std::atof(argv[1]);
    Domain domain;
    domain.box = {{0, 0, 0}, {1, 1, 1}};
    domain.size = {.surface = size, .growth = 0, .far = size};
    domain.bodies.push_back({"ball", {{0.5, 0.5, 0.5}, {0.25, 0.25, 0.25}, {}}});
    write_mesh_file(argv[2], cells_of(generate_mesh(domain, 1), {{0, "surroundings"}, {1, "ball"}}));
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 5;
}
