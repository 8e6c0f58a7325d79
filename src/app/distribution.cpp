#include "app/distribution.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numeric>

namespace kropla {

Distribution distribution(std::vector<double> values) {
    if (values.empty()) return {};
    std::ranges::sort(values);
    const auto quantile = [&](double share) {
        return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
    };
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    return {.count = values.size(),
            .min = values.front(),
            .mean = sum / static_cast<double>(values.size()),
            .median = quantile(0.5),
            .p99 = quantile(0.99),
            .p999 = quantile(0.999),
            .max = values.back()};
}

std::vector<std::string> histogram(std::span<const double> values, std::span<const double> edges) {
    std::vector<std::size_t> counts(edges.size() - 1, 0);
    const auto inner = edges.subspan(1, edges.size() - 2);
    for (const double value : values)
        ++counts[static_cast<std::size_t>(std::ranges::upper_bound(inner, value) - inner.begin())];

    constexpr double longest = 17;  // [characters]
    const double fullest = static_cast<double>(std::max<std::size_t>(1, std::ranges::max(counts)));
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < counts.size(); ++i) {
        // Rounded up: a bin that holds anything shows it.
        const auto bar =
            static_cast<std::size_t>(std::ceil(longest * static_cast<double>(counts[i]) / fullest));
        lines.push_back(fmt::format("{:>4g} -{:>4g} {:>9}", edges[i], edges[i + 1], counts[i]));
        if (bar > 0) lines.back() += ' ' + std::string(bar, '#');
    }
    return lines;
}

}  // namespace kropla
