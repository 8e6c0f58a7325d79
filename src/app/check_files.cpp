#include "app/check_files.h"

#include "app/fault.h"
#include <kropla/base/error.h>
#include <kropla/io/pvd.h>
#include <kropla/io/mesh_file.h>
#include <kropla/io/vtk.h>
#include <kropla/mesh/prisms.h>
#include <kropla/mesh/quality.h>

#include <algorithm>
#include <fmt/format.h>

namespace kropla {
namespace {

std::vector<std::filesystem::path> vtu_files_in(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".vtu") files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

std::vector<std::filesystem::path> files_of(const std::filesystem::path& path) {
    if (!std::filesystem::exists(path)) throw FileError(path.string() + ": cannot be read: no such file or folder");
    std::vector<std::filesystem::path> files;
    if (std::filesystem::is_directory(path)) {
        const auto frames = path / "frames";  // of a run
        files = vtu_files_in(std::filesystem::is_directory(frames) ? frames : path);
    } else if (path.extension() == ".pvd") {
        for (const SeriesEntry& entry : read_pvd(path)) files.push_back(path.parent_path() / entry.file);
    } else {
        return {path};
    }
    if (files.empty()) throw FileError(path.string() + ": has no VTU files");
    return files;
}

}  // namespace

std::vector<std::filesystem::path> files_to_check(std::span<const std::filesystem::path> paths) {
    std::vector<std::filesystem::path> all;
    for (const auto& path : paths) {
        const auto files = files_of(path);
        all.insert(all.end(), files.begin(), files.end());
    }
    return all;
}

CheckLine check_line(const std::filesystem::path& path) {
    FileCells cells;
    try {
        cells = read_mesh_file(path);
    } catch (const FileError& error) {  // it names the file
        return {false, fmt::format("{}\n", error.what())};
    }
    try {
        const Mesh mesh = make_frame(std::move(cells)).mesh;
        if (const std::string fault = fault_of(mesh); !fault.empty())
            return {false, fmt::format("{}: invalid: {}\n", path.string(), fault)};
        const QualitySummary quality = summarise_quality(mesh);
        return {true, fmt::format("{}: valid, {} tets, {} prisms, worst R/r {:.2f}\n", path.string(), quality.tets,
                                  count_prisms(mesh), quality.max_aspect_ratio)};
    } catch (const FileError& error) {
        return {false, fmt::format("{}: invalid: {}\n", path.string(), error.what())};
    }
}

}  // namespace kropla
