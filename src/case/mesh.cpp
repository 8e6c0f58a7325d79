// [domain] mesh: what others have meshed, made the mesh of a case.
#include "case/mesh.h"

#include "case/patches.h"
#include <kropla/base/error.h>
#include <kropla/base/predicates.h>
#include <kropla/domain/of_mesh.h>
#include <kropla/domain/words.h>
#include <kropla/io/fixed_mesh.h>
#include <kropla/io/mesh_file.h>
#include <kropla/mesh/topology.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kropla {
namespace {

/// [of the box's largest side] facets so near to a face of the box are in it: what generators round.
constexpr double same_plane = 1e-9;

void note(std::size_t count, const char* what, std::vector<std::string>& notes) {
    if (count > 0) notes.push_back(fmt::format("domain.mesh: {}: {}", what, count));
}

/// That what the cells are of is one mesh of tets. Throws FileError, without the file's name.
void check_cells(const FileCells& cells) {
    if (!cells.prisms.empty())
        throw FileError(fmt::format("has {} prisms; a mesh that moves is of tets alone", cells.prisms.size()));
    if (const std::string fault = fault_of_sides(fixed_mesh(cells)); !fault.empty())
        throw FileError(fmt::format("{}: the mesh overlaps itself", fault));
}

CaseMesh read_tidied(const std::filesystem::path& path) {
    CaseMesh mesh{path.string(), read_mesh_file(path), {}};
    const Tidied done = tidy(mesh.cells);
    note(done.united, "vertices at the places of others, united with them", mesh.notes);
    note(done.turned, "cells that were inside out, turned round", mesh.notes);
    try {
        check_cells(mesh.cells);
    } catch (const FileError& error) {
        throw FileError(fmt::format("{}: {}", path.string(), error.what()));
    }
    return mesh;
}

Box box_of(const Mesh& mesh) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Box box{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
    for (const Vec3& x : mesh.position)
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = std::min(box.min[axis], x[axis]);
            box.max[axis] = std::max(box.max[axis], x[axis]);
        }
    return box;
}

/// The face of the box in which the facet lies, or `box_faces`. Puts its vertices exactly there.
int face_of(const std::array<Vertex, 3>& facet, const Box& box, double tolerance, Mesh& mesh) {
    for (int face = 0; face < box_faces; ++face) {
        const int axis = face / 2;
        const double plane = (face % 2 == 0 ? box.min : box.max)[axis];
        const auto is_there = [&](Vertex v) { return std::abs(mesh.position[v][axis] - plane) <= tolerance; };
        if (!std::ranges::all_of(facet, is_there)) continue;
        for (const Vertex v : facet) mesh.position[v][axis] = plane;
        return face;
    }
    return box_faces;
}

Mesh with_patches(Mesh mesh) {
    const Box box = box_of(mesh);
    const Vec3 span = box.max - box.min;
    const double tolerance = same_plane * std::max({span.x, span.y, span.z});
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            const auto i = as_size(corner);
            if (mesh.neighbour[t][i].exists()) continue;
            mesh.patch[t][i] = Patch(face_of(facet_vertices(mesh, {t, corner}), box, tolerance, mesh));
        }
    return mesh;
}

/// Bodies are apart from each other and from the boundary: no vertex is of two of these.
void check_apart(const CaseTable& domain, const std::string& file, const Mesh& mesh, const std::vector<Body>& bodies) {
    Array<Vertex, Region> of(mesh.position.size());
    const auto name = [&](Region body) { return toml_text(bodies[as_size(body.value - 1)].name); };
    const auto refuse = [&](Region body, const std::string& other, Vertex v) {
        domain.refuse("mesh", fmt::format("{}: body {} touches {} at {}; bodies are to be apart from each other and from the boundary",
                                          file, name(body), other, place_words(mesh.position[v])));
    };
    for (const Tet t : mesh.tets.indices()) {
        const Region region = mesh.region[t];
        if (region == surroundings) continue;
        for (const Vertex v : mesh.tets[t]) {
            if (of[v].exists() && of[v] != region) refuse(of[v], "body " + name(region), v);
            of[v] = region;
        }
    }
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            if (mesh.neighbour[t][as_size(corner)].exists()) continue;
            for (const Vertex v : facet_vertices(mesh, {t, corner}))
                if (of[v].exists()) refuse(of[v], "the boundary", v);
        }
}

}  // namespace

CaseMesh read_case_mesh(const CaseTable& domain, const std::filesystem::path& file) {
    for (const char* key : {"min", "max"})
        if (domain.has(key)) domain.refuse(key, "stands beside mesh, whose box is its own");
    std::filesystem::path path = domain.text("mesh");
    if (path.empty()) domain.refuse_value("mesh", "must be the name of a mesh file");
    if (path.is_relative()) path = std::filesystem::absolute(file).parent_path() / path;
    try {
        return read_tidied(path.lexically_normal());
    } catch (const FileError& error) {
        domain.refuse("mesh", error.what());
    }
}

int read_region(const CaseTable& body, const CaseMesh& mesh) {
    const std::vector<int> numbers = region_numbers(mesh.cells);
    std::vector<std::string> known;
    for (const int number : numbers) {
        const auto name = mesh.cells.region_names.find(number);
        const std::string also = name != mesh.cells.region_names.end() ? fmt::format(" ({})", toml_text(name->second)) : "";
        known.push_back(fmt::format("{}{}", number, also));
    }
    const std::string must = fmt::format("must be one of the mesh's regions: {}", fmt::join(known, ", "));
    if (body.has("region") && body.holds_text("region")) {
        const std::string wanted = body.text("region");
        for (const int number : numbers) {
            const auto name = mesh.cells.region_names.find(number);
            if (name != mesh.cells.region_names.end() && name->second == wanted) return number;
        }
        body.refuse_value("region", must);
    }
    if (!body.has("region")) body.refuse_value("region", must);
    const auto number = static_cast<int>(body.integer("region", 0, std::numeric_limits<int>::max()));
    if (!std::ranges::binary_search(numbers, number)) body.refuse_value("region", must);
    return number;
}

void take_case_mesh(const CaseTable& domain, const CaseMesh& brought, const std::vector<int>& regions, Case& given) {
    Array<Tet, Region> region;
    for (const Region of_file : brought.cells.region) {
        const auto body = std::ranges::find(regions, of_file.value);
        region.push_back(body == regions.end() ? surroundings
                                               : region_of_body(static_cast<std::size_t>(body - regions.begin())));
    }
    Array<Vertex, Vec3> position;
    for (const Vec3& x : brought.cells.position) position.push_back(without_underflow(x));
    const auto mesh = std::make_shared<Mesh>(with_patches(make_mesh(std::move(position), brought.cells.tets, std::move(region))));
    if (std::ranges::find(mesh->region, surroundings) == mesh->region.end())
        domain.refuse("mesh", fmt::format("{}: has no region around the bodies", brought.file));
    const Domain around = domain_of(*mesh, {});
    given.domain.box = around.box;
    given.domain.walls = around.walls;
    for (std::size_t body = 0; body < regions.size(); ++body) {
        try {
            given.domain.bodies[body].shape = shape_of_region(*mesh, region_of_body(body));
        } catch (const DomainError& error) {
            domain.refuse("mesh", fmt::format("{}: body {}: {}", brought.file, toml_text(given.domain.bodies[body].name), error.what()));
        }
    }
    check_apart(domain, brought.file, *mesh, given.domain.bodies);
    given.mesh = BroughtMesh{brought.file, mesh, brought.notes, faces_of_patches(*mesh, brought.cells)};
}

}  // namespace kropla
