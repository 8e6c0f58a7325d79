#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kropla {

/// What the text of a VTU file says of what follows.
struct VtuText {
    std::uint64_t cells = 0;
    std::vector<std::string> of_points, of_cells;  // names of arrays of texts, one for each vertex or cell: not looked at
};

/// Looks at what VTK's reader would take on trust, and crash on: that the text is of a VTU file and ends as
/// one, that it promises no more vertices, cells and values than its size can hold, that each appended
/// array lies in the file with all its compressed blocks, and that what is in plain text are values of the array's type.
/// Arrays of texts of the whole file, of which the reader crashes if there are more than are promised, become such of the
/// texts' bytes in `bytes`. Throws FileError.
VtuText check_vtu_text(const std::filesystem::path& path, std::string& bytes);

}  // namespace kropla
