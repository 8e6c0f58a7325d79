#pragma once

#include <kropla/mesh/mesh.h>

#include <string>

namespace kropla {

/// The first fault of a mesh that was read from a file, with its cell and place; empty if it has none. Beside what
/// `verify` asks: whether all cells are turned over, as by a writer that numbers corners the other way round; whether
/// a vertex hangs, boundary facets cut or cover each other, or a part of the mesh lies within another.
[[nodiscard]] std::string fault_of(const Mesh& mesh);

/// The middle of a cell as text.
[[nodiscard]] std::string place_of(const Mesh& mesh, Tet t);

}  // namespace kropla
