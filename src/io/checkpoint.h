#pragma once

#include <kropla/simulate/fields.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace kropla {

/// All that a run needs to go on as if it had never stopped.
struct Checkpoint {
    Mesh mesh;  // free slots and their order included: later cells take them
    std::vector<NodalField> fields;
    double time = 0;     // [s] of the mesh and fields
    double next_dt = 0;  // [s]
    std::int64_t step = 0;
    std::string case_text;                 // the case as it runs
    std::map<std::string, double> values;  // what else the time loop remembers, by name
};

/// Writes the checkpoint as an HDF5 file, as a whole or not at all: the one before survives until then.
/// Throws FileError with the path and the system's reason.
void write_checkpoint(const std::filesystem::path& path, const Checkpoint& checkpoint);

/// Reads it back, bit for bit. Throws FileError if the file is missing, not a checkpoint, of another format
/// version, truncated or damaged.
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& path);

}  // namespace kropla
