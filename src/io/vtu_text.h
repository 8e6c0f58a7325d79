#pragma once

#include <filesystem>
#include <string_view>

namespace kropla {

/// Looks at what VTK's reader would take on trust, and crash on: that the text is of a VTU file and ends as
/// one, that it promises no more vertices, cells and values than its size can hold, and that each appended
/// array lies in the file with all its compressed blocks. Throws FileError.
void check_vtu_text(const std::filesystem::path& path, std::string_view bytes);

}  // namespace kropla
