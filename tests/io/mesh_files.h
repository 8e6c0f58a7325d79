#pragma once

#include "layered.h"
#include <kropla/io/mesh_file.h>

namespace kropla {

/// A cube with a body in it, its six faces as patches 1 ... 6, some with names, and a patch 9 on the body's surface.
inline FileCells named_cube(int n = 4) {
    Mesh mesh = cube_of_tets(n);
    set_face_patches(mesh, 1e-3 * n);
    FileCells cells = cells_of(mesh, {{0, "surroundings"}, {1, "the rotor, hot"}}, {{1, "inlet"}, {2, "outlet"}, {9, "skin"}});
    for (const Tet t : mesh.tets.indices())
        for (int corner = 0; corner < 4; ++corner) {
            const Tet n_ = mesh.neighbour[t][static_cast<std::size_t>(corner)];
            if (!n_.exists() || !(mesh.region[t] < mesh.region[n_])) continue;
            const auto [a, b, c] = facet_vertices(mesh, {t, corner});
            cells.facets.push_back({{a, b, c, Vertex{}}, 9});
        }
    return cells;
}

inline void expect_same(const FileCells& a, const FileCells& b) {
    EXPECT_EQ(a.position, b.position);
    EXPECT_EQ(a.tets, b.tets);
    EXPECT_EQ(a.region, b.region);
    EXPECT_EQ(a.facets, b.facets);
    EXPECT_EQ(a.region_names, b.region_names);
    EXPECT_EQ(a.patch_names, b.patch_names);
    ASSERT_EQ(a.prisms.size(), b.prisms.size());
    for (std::size_t i = 0; i < a.prisms.size(); ++i) {
        EXPECT_EQ(a.prisms[i].vertices, b.prisms[i].vertices);
        EXPECT_EQ(a.prisms[i].region, b.prisms[i].region);
    }
}

/// What a file with these bytes is refused with, without its name.
inline std::string refusal_of(const std::string& name, const std::string& bytes) {
    const Folder folder;
    put(folder / name, bytes);
    const std::string message = message_of<FileError>([&] { (void)read_mesh_file(folder / name); });
    EXPECT_EQ(message.find('\n'), std::string::npos);
    const std::string start = (folder / name).string() + ": ";
    EXPECT_TRUE(message.empty() || message.starts_with(start)) << message;
    return message.substr(std::min(message.size(), start.size()));
}

inline FileCells cells_from(const std::string& name, const std::string& bytes) {
    const Folder folder;
    put(folder / name, bytes);
    return read_mesh_file(folder / name);
}

}  // namespace kropla
