#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace kropla {

/// One frame of a series.
struct SeriesEntry {
    double time;       // [s]
    std::string file;  // relative to the PVD file
    bool operator==(const SeriesEntry&) const = default;
};

/// Writes the series as a ParaView collection, as a whole or not at all. Throws FileError.
void write_pvd(const std::filesystem::path& path, std::span<const SeriesEntry> entries);

/// Reads back a series, times bit for bit. Throws FileError if the file is missing, not a collection, or
/// truncated.
[[nodiscard]] std::vector<SeriesEntry> read_pvd(const std::filesystem::path& path);

}  // namespace kropla
