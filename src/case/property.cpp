#include "case/property.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kropla {
namespace {

constexpr double hottest = 30000;      // [K] of expressions: the middle of an arc
constexpr double widest = 500;         // [K] between two temperatures of an expression's table
constexpr double closest = 0.05;       // [K]: where an expression jumps
constexpr double straight = 1e-6;      // [-] by which a line may miss an expression

struct Samples {
    std::vector<double> temperature, value;

    void add(double at, double found) {
        temperature.push_back(at);
        value.push_back(found);
    }
};

/// Adds what is needed between the last sample and this one, and this one.
void add_up_to(const Expression& f, double at, double found, Samples& samples) {
    const double from = samples.temperature.back(), begin = samples.value.back();
    const double middle = 0.5 * (from + at), there = f(middle);
    const double quarter = 0.75 * from + 0.25 * at;
    const auto misses = [&](double where, double is, double line) {
        return where - from > closest && !(std::abs(is - line) <= straight * std::abs(is));
    };
    if (misses(middle, there, 0.5 * (begin + found)) || misses(quarter, f(quarter), 0.75 * begin + 0.25 * found)) {
        add_up_to(f, middle, there, samples);
        add_up_to(f, at, found, samples);
        return;
    }
    samples.add(at, found);
}

bool is_good(double value) { return std::isfinite(value) && value > 0; }

/// As far from `start` in steps of this as the expression is good: how far the last one is off, to `closest`.
double reach(const Expression& f, double start, double step) {
    double good = start;
    while (std::abs(step) > closest) {
        const double next = good + step;
        if (next >= 0 && next <= hottest && is_good(f(next))) good = next;
        else step /= 2;
    }
    return good;
}

Samples samples_between(const Expression& f, double low, double high) {
    const int parts = std::max(1, static_cast<int>(std::ceil((high - low) / widest)));
    Samples samples;
    samples.add(low, f(low));
    for (int k = 1; k <= parts; ++k) {
        const double at = k == parts ? high : low + k * (high - low) / parts;
        add_up_to(f, at, f(at), samples);
    }
    return samples;
}

/// About `usual`, as far as the expression is good; steps may have passed over where it is not, as at a pole.
Property sampled(const Expression& f, double usual) {
    double low = reach(f, usual, -widest), high = reach(f, usual, widest);
    for (;;) {
        Samples samples = samples_between(f, low, high);
        const auto& [temperature, value] = samples;
        const double was_low = low, was_high = high;
        for (std::size_t k = 0; k < value.size(); ++k) {
            if (is_good(value[k])) continue;
            if (temperature[k] < usual) low = temperature[k + 1];
            else if (high == was_high) high = temperature[k - 1];
        }
        if (low == was_low && high == was_high) return {std::move(samples.temperature), std::move(samples.value)};
    }
}

WrittenProperty read_table(const CaseTable& parent, std::string_view key) {
    const CaseTable table = parent.table(key);
    table.allow({"T", "value"});
    std::vector<double> temperature = table.all_numbers("T", "temperatures [K] that rise"),
                        value = table.all_numbers("value", "positive values, one for each of T");
    if (temperature.size() < 2) table.refuse_value("T", "must be at least two temperatures");
    if (value.size() != temperature.size())
        table.refuse("value", fmt::format("must be as many numbers as T has, {}, got {}", temperature.size(), value.size()));
    for (std::size_t k = 0; k < temperature.size(); ++k) {
        if (k > 0 && !(temperature[k - 1] < temperature[k]))
            table.refuse("T", fmt::format("must rise, got {} after {}", temperature[k], temperature[k - 1]));
        if (!(value[k] > 0))
            table.refuse("value", fmt::format("must be positive, got {} at T = {}", value[k], temperature[k]));
    }
    const std::string written = fmt::format("{{ T = [{}], value = [{}] }}", fmt::join(temperature, ", "), fmt::join(value, ", "));
    return {{std::move(temperature), std::move(value)}, written};
}

}  // namespace

WrittenProperty read_property(const CaseTable& table, std::string_view key, double usual_temperature) {
    if (table.holds_table(key)) return read_table(table, key);
    if (!table.holds_text(key)) {
        const double value = table.positive(key);
        return {value, toml_number(value)};
    }
    const Formula formula = table.formula(key, Variables::temperature);
    const double usual = formula.value(usual_temperature);
    const std::vector<std::string> names = names_in(formula.value.text());
    if (!is_good(usual))
        table.refuse(key, fmt::format("must be positive, but {} is {} at T = {}", formula.written, usual, usual_temperature));
    if (std::ranges::find(names, "T") == names.end()) return {usual, formula.written};
    return {sampled(formula.value, usual_temperature), formula.written};
}

}  // namespace kropla
