#include "case/noted_table.h"

#include "simulate/step_mean.h"

#include <fmt/format.h>

#include <vector>

namespace kropla {

Vec3 probe_of(const Box& box) {
    const Vec3 span = box.max - box.min;
    return box.min + Vec3{0.37 * span.x, 0.41 * span.y, 0.43 * span.z};
}

namespace {

Quantity quantity_of(const Formula& formula) {
    if (!formula.written.starts_with('"')) return Constant{formula.value(0)};
    return [f = formula.value](const Vec3& place, double t) { return f(t, place); };
}

}  // namespace

Quantity NotedTable::quantity(std::string_view key, Variables of) {
    if (!table_.has(key)) return {};
    const Formula formula = table_.formula(key, of, probe_);
    written_.emplace_back(key, formula.written);
    return quantity_of(formula);
}

VectorQuantity NotedTable::vector(std::string_view key, std::string_view meaning, Variables of) {
    VectorQuantity read;
    if (!table_.has(key)) return read;
    std::vector<std::string> words;
    for (const Formula& formula : table_.formulas(key, 3, meaning, of)) {
        read[words.size()] = quantity_of(formula);
        words.push_back(formula.written);
    }
    written_.emplace_back(key, fmt::format("[{}]", fmt::join(words, ", ")));
    return read;
}

double NotedTable::number(std::string_view key) {
    const double value = table_.number(key);
    written_.emplace_back(key, toml_number(value));
    return value;
}

Property NotedTable::property(std::string_view key, double usual_temperature) {
    const WrittenProperty read = read_property(table_, key, usual_temperature);
    written_.emplace_back(key, read.written);
    return read.property;
}

std::string inline_table(const WrittenKeys& keys) {
    std::vector<std::string> parts;
    for (const auto& [name, text] : keys) parts.push_back(fmt::format("{} = {}", name, text));
    return fmt::format("{{ {} }}", fmt::join(parts, ", "));
}

}  // namespace kropla
