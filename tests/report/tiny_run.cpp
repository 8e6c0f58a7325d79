#include "tiny_run.h"

#include "io/file.h"
#include <kropla/io/pvd.h>
#include <kropla/io/vtk.h>

#include <unistd.h>

namespace kropla {
namespace {

std::string steps_of(const TinyRun& run) {
    std::string text =
        "step,time [s],dt [s],attempts,vertices,tets,prisms,max_aspect_ratio,p999_aspect_ratio,min_dihedral "
        "[deg],"
        "max_dihedral "
        "[deg],smoothing_sweeps,swaps,splits,collapses,local_remeshes,largest_ring,global_remeshes,"
        "touched_fraction,mesh_seconds [s],simulate_seconds [s],transfer_seconds [s]";
    if (run.heat)
        text +=
            ",transferred_fraction,energy_integral [J],energy_transfer_error,energy_before_transfer [J],energy_limited "
            "[K],energy_beyond_bounds [K]";
    text += '\n';
    for (int step = 1; step <= run.rows; ++step) {
        text += std::to_string(step) + "," + std::to_string(step * 0.1) + ",0.1," + (step == 2 ? "3" : "1") +
                ",637,2592,0," + (step == 3 ? std::to_string(run.worst) : "6.5") +
                ",6.25,12,140,2,30,4,3,1,2,0,0.125,0.25,0.5,0.01";
        if (run.heat) text += ",0.1," + std::to_string(100 + step) + ",1e-15," + std::to_string(100 + step) + ",3,0";
        text += '\n';
    }
    return text;
}

Mesh mesh_at(int height) {
    return grid_of_cubes({6, 6, 12}, [height](int i, int j, int k) {
        const bool inside = i >= 2 && i < 4 && j >= 2 && j < 4 && k >= height && k < height + 2;
        return Region(inside ? 1 : 0);
    });
}

NodalField temperature_of(const Mesh& mesh, int height) {
    NodalField field{"temperature", "K", Array<Vertex, double>(mesh.position.size())};
    const Vec3 centre = {3, 3, height + 1.0};
    for (const Vertex v : mesh.position.indices()) {
        field.values[v] = 300 + 1500 / (1 + squared_norm(mesh.position[v] - centre));
    }
    return field;
}

/// The body falls with 1 m/s, and takes along what is next to it; at the start all is at rest.
void add_flow(const Mesh& mesh, int height, double speed, std::vector<NodalField>& fields,
              std::vector<NodalVectorField>& vectors) {
    NodalField pressure{"pressure", "Pa", Array<Vertex, double>(mesh.position.size())};
    NodalVectorField velocity{"velocity", "m/s", Array<Vertex, Vec3>(mesh.position.size())};
    const Vec3 centre = {3, 3, height + 1.0};
    for (const Vertex v : mesh.position.indices()) {
        const Vec3 away = mesh.position[v] - centre;
        if (away == Vec3{}) continue;  // the one vertex within the body
        pressure.values[v] = -speed * away.z / squared_norm(away) - 10 * speed * (mesh.position[v].z - 6);
        velocity.values[v] = {0, 0, -speed / squared_norm(away)};
    }
    fields.push_back(std::move(pressure));
    vectors.push_back(std::move(velocity));
}

}  // namespace

void write_tiny_run(const std::filesystem::path& dir, const TinyRun& run) {
    std::filesystem::remove_all(dir);
    std::filesystem::create_directories(dir / "frames");
    write_file(dir / "case.toml",
               "[quality]\nmax_aspect_ratio = 10\n\n[time]\nend = 0.5\nsteps = 5  # a < b & c\n");
    write_file(dir / "steps.csv", run.steps.empty() ? steps_of(run) : run.steps);
    if (run.bodies)
        write_file(dir / "bodies.csv",
                   "body,semi_axis_1 [m],semi_axis_2 [m],semi_axis_3 [m],volume [m^3],mesh_volume [m^3],triangles,"
                   "mean_edge [m]\n1,1,2,1.25,10.4719755,10.4719756,48,1.138\n");
    std::vector<SeriesEntry> entries;
    for (int step = 0; step <= run.rows; ++step) {
        const int height = 9 - step;
        const Mesh mesh = mesh_at(height);
        std::vector<NodalField> fields;
        if (run.heat) fields.push_back(temperature_of(mesh, height));
        const std::string name = "frames/0000" + std::to_string(step) + ".vtu";
        std::vector<NodalVectorField> vectors;
        if (run.flow) add_flow(mesh, height, step > 0 ? 1 : 0, fields, vectors);
        write_vtu(dir / name, mesh, fields, nullptr, vectors);
        entries.push_back({step * 0.1, name});
    }
    write_pvd(dir / "frames.pvd", entries);
}

std::filesystem::path test_folder(const std::string& name) {
    return std::filesystem::temp_directory_path() / ("kropla-" + std::to_string(getpid()) + "-" + name);
}

}  // namespace kropla
