#pragma once

#include <span>
#include <string>
#include <vector>

namespace kropla {

/// How many values there are and how they are spread.
struct Distribution {
    std::size_t count = 0;
    double min = 0, mean = 0, median = 0, p99 = 0, p999 = 0, max = 0;
};
/// Values may be infinite, but are numbers. All zero for no values.
[[nodiscard]] Distribution distribution(std::vector<double> values);

/// The lines of a histogram, as text of at most 38 columns: the bin, how many values it holds, and a bar, the
/// fullest bin's being the longest. Bin i holds edges[i] <= value < edges[i + 1]; what lies outside goes to
/// the first or last bin.
[[nodiscard]] std::vector<std::string> histogram(std::span<const double> values,
                                                 std::span<const double> edges);

}  // namespace kropla
