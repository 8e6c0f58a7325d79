// Two bodies that pass each other, and what a code of one's own has on the mesh, carried from step to step: a scalar and a
// vector per vertex, a number per cell, a struct of one's own. Prints what is conserved; writes the last mesh as VTK.
#include <kropla/mesh/quality.h>
#include <kropla/step/advance.h>
#include <kropla/step/initial_mesh.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>

using namespace kropla;

struct Material {  // of a cell
    int phase = 0;
    double fraction = 0;
    Vec3 drift;
};

Domain two_spheres() {
    Domain domain{{{-3, -2, -2}, {3, 2, 2}}, {}, {.surface = 0.3, .growth = 0.2, .far = 0.8}};
    for (const double side : {-1.0, 1.0})
        domain.bodies.push_back({side < 0 ? "left" : "right", {{2 * side, 0.8 * side, 0}, {0.6, 0.6, 0.6}, {}},
                                 [side](double t) { return Pose{{-4 * side * t, 0, 0}, {}}; }});
    return domain;
}

double integral(const Mesh& mesh, const Array<Vertex, double>& values) {
    double sum = 0;
    for (Tet t : all_tets(mesh))
        for (Vertex v : mesh.tets[t]) sum += volume(mesh, t) / 4 * values[v];
    return sum;
}

void write_vtk(const Mesh& mesh, const Array<Vertex, double>& heat) {  // free slots and all
    std::ofstream out("carried.vtk");
    out << "# vtk DataFile Version 3.0\ncarried\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS " << mesh.position.size()
        << " double\n";
    for (const Vec3& x : mesh.position) out << x.x << ' ' << x.y << ' ' << x.z << '\n';
    out << "CELLS " << count_tets(mesh) << ' ' << 5 * count_tets(mesh) << '\n';
    for (Tet t : all_tets(mesh)) {
        out << 4;
        for (Vertex v : mesh.tets[t]) out << ' ' << v.value;
        out << '\n';
    }
    out << "CELL_TYPES " << count_tets(mesh) << '\n';
    for (int i = 0; i < count_tets(mesh); ++i) out << "10\n";
    out << "POINT_DATA " << mesh.position.size() << "\nSCALARS heat double\nLOOKUP_TABLE default\n";
    for (double h : heat) out << h << '\n';
}

int main() try {
    MovingMesh moving(two_spheres(), initial_mesh(two_spheres(), 1), 0);
    const Mesh& mesh = moving.reference();
    Array<Vertex, double> heat(mesh.position.size());
    Array<Vertex, Vec3> flow(mesh.position.size(), {1, 0, 0});
    Array<Tet, double> dye(mesh.tets.size(), 0.5);
    std::vector<Material> materials(mesh.tets.size());
    for (Vertex v : heat.indices()) heat[v] = 1 + std::exp(-squared_norm(mesh.position[v]));
    Fields fields;
    fields.per_vertex(heat);
    fields.per_vertex(flow);
    fields.per_cell(dye);
    fields.per_cell(materials, &Material::fraction, &Material::drift);
    AdvanceOptions options;
    options.contents = {[&](const Mesh& now) { return integral(now, heat); }};  // looked at around each transfer
    while (moving.time() < 1 - 1e-9) {
        const Advanced step = advance(moving, fields, std::min(0.05, 1 - moving.time()), {}, options);  // no solver here
        double least = 1, most = 0;
        for (Tet t : all_tets(mesh)) least = std::min(least, dye[t]), most = std::max(most, dye[t]);
        std::printf("%4.2f  worst R/r %5.2f  vertices kept %5.1f %%  heat lost %8.1e  dye %g ... %g\n", step.time,
                    summarise_quality(mesh).max_aspect_ratio, 100 * step.kept_vertices, step.contents[0].by_transfer / step.contents[0].after,
                    least, most);
    }
    write_vtk(mesh, heat);
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
}
