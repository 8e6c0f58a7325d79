#include <kropla/io/mesh_file.h>

#include <kropla/base/error.h>
#include <kropla/io/medit.h>
#include <kropla/io/msh.h>
#include <kropla/io/vtk.h>

#include <string>

namespace kropla {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& path) {
    throw FileError(path.string() + ": is of no format that is known; the name is to end in " +
                    std::string(mesh_extensions));
}

}  // namespace

bool is_mesh_file(const std::filesystem::path& path) {
    const auto extension = path.extension();
    return extension == ".vtu" || extension == ".msh" || extension == ".mesh";
}

FileCells read_mesh_file(const std::filesystem::path& path, const Watch* watch) {
    if (path.extension() == ".vtu") return read_vtu_cells(path, watch);
    if (path.extension() == ".msh") return read_msh(path, watch);
    if (path.extension() == ".mesh") return read_medit(path, watch);
    refuse(path);
}

void write_mesh_file(const std::filesystem::path& path, const FileCells& cells, const Watch* watch) {
    if (path.extension() == ".vtu") return write_vtu(path, cells, watch);
    if (path.extension() == ".msh") return write_msh(path, cells, watch);
    if (path.extension() == ".mesh") return write_medit(path, cells, watch);
    refuse(path);
}

}  // namespace kropla
