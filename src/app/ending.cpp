// The end of a run that did not come to its end.
#include "app/ending.h"

#include "case/table.h"
#include "io/file.h"
#include <kropla/io/vtk.h>
#include "report/page.h"
#include "report/run_files.h"

#include <fmt/format.h>

namespace kropla {

void report_end(const std::filesystem::path& folder, const std::exception& why, const Mesh* mesh) {
    std::error_code trouble;
    std::filesystem::create_directories(folder, trouble);
    if (trouble) throw FileError(fmt::format("{}: cannot be made: {}", folder.string(), trouble.message()));
    std::string text = fmt::format("# Why the run ended early.\nwhy = {}\n", toml_text(why.what()));
    if (const auto* stuck = dynamic_cast<const StuckError*>(&why)) {
        if (const auto& at = stuck->place)
            text += fmt::format("place = [{}, {}, {}]  # m\n", at->x, at->y, at->z);
        if (stuck->mesh) mesh = &*stuck->mesh;
    }
    if (mesh != nullptr) write_vtu(folder / ending_mesh_name, *mesh);
    write_file(folder / ending_name, text);
    write_report(folder);
}

void forget_end(const std::filesystem::path& folder) {
    std::error_code ignored;  // it was not there
    std::filesystem::remove(folder / ending_name, ignored);
    std::filesystem::remove(folder / ending_mesh_name, ignored);
}

}  // namespace kropla
