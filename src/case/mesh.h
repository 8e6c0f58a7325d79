#pragma once

#include "case/case.h"
#include "case/table.h"
#include <kropla/io/file_cells.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace kropla {

/// The mesh that [domain] mesh names, as it was read.
struct CaseMesh {
    std::string file;   // absolute
    FileCells cells;    // tidied
    std::vector<std::string> notes;  // what was mended
};

/// `file` is the case file, in whose folder a relative name is looked up. Throws CaseError, naming file, key and what is
/// wrong with the mesh: it cannot be read, overlaps itself, has prisms.
[[nodiscard]] CaseMesh read_case_mesh(const CaseTable& domain, const std::filesystem::path& file);

/// The number of the region that `region` of a body names, by name or number. Throws CaseError, saying which there are.
[[nodiscard]] int read_region(const CaseTable& body, const CaseMesh& mesh);

/// Gives the case the mesh, with the regions of its bodies (`regions`, the file's numbers, one each) as 1, 2, ... and all
/// others as 0, facets in the faces of the box that just holds it as the patches 0 ... 5 and others as fixed; the box, the
/// walls, and the bodies' shapes. Throws CaseError if a body reaches the boundary, or touches itself.
void take_case_mesh(const CaseTable& domain, const CaseMesh& mesh, const std::vector<int>& regions, Case& given);

}  // namespace kropla
