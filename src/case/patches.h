#pragma once

#include "case/case.h"
#include "case/table.h"
#include <kropla/io/file_cells.h>

#include <map>
#include <string>

namespace kropla {

/// For each patch of the file that has a name, the face of the box that it is, as a whole and alone; else none. The mesh is
/// of the file's tets and has its patches.
[[nodiscard]] std::map<std::string, Patch> faces_of_patches(const Mesh& mesh, const FileCells& cells);

/// In [heat.face], [flow.face] and [species.face], puts the face's key in the place of the name of a patch that is one.
/// Throws CaseError if a patch is named there that is none, or if both stand there. `file` is of `table`.
void name_faces(const CaseTable& file, const Case& given, toml::table& table);

}  // namespace kropla
