#include <kropla/simulate/material.h>

#include <kropla/base/error.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace kropla {
namespace {

constexpr int pieces_of_product = 8;  // between two temperatures of tables: of a product of two lines

/// Every temperature at which something begins or ends, once, rising.
std::vector<double> knots(const HeatMaterial& m) {
    std::vector<double> all = m.density.temperatures();
    const std::vector<double>& others = m.specific_heat.temperatures();
    all.insert(all.end(), others.begin(), others.end());
    if (m.latent_heat > 0) all.insert(all.end(), {m.solidus, m.liquidus});
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    if (m.density.constant() || m.specific_heat.constant()) return all;
    std::vector<double> fine;
    for (std::size_t k = 0; k + 1 < all.size(); ++k)
        for (int piece = 0; piece < pieces_of_product; ++piece)
            fine.push_back(all[k] + piece * (all[k + 1] - all[k]) / pieces_of_product);
    fine.push_back(all.back());
    return fine;
}

}  // namespace

Property::Property(std::vector<double> temperature, std::vector<double> value)
    : temperature_(std::move(temperature)), value_(std::move(value)) {
    if (temperature_.size() < 2 || temperature_.size() != value_.size())
        throw CaseError("a table needs at least two temperatures and as many values, got " +
                        std::to_string(temperature_.size()) + " and " + std::to_string(value_.size()));
    for (std::size_t k = 0; k + 1 < temperature_.size(); ++k)
        if (!(temperature_[k] < temperature_[k + 1]))
            throw CaseError("the temperatures of a table must rise, got " + std::to_string(temperature_[k]) + " and " +
                            std::to_string(temperature_[k + 1]));
}

double Property::operator()(double temperature) const {
    if (constant()) return value_.front();
    const auto above = std::ranges::upper_bound(temperature_, temperature);
    if (above == temperature_.begin()) return value_.front();
    if (above == temperature_.end()) return value_.back();
    const auto k = static_cast<std::size_t>(above - temperature_.begin());
    const double share = (temperature - temperature_[k - 1]) / (temperature_[k] - temperature_[k - 1]);
    return std::lerp(value_[k - 1], value_[k], share);
}

Enthalpy::Enthalpy(const HeatMaterial& m) {
    const auto capacity = [&](double temperature) { return m.density(temperature) * m.specific_heat(temperature); };
    const std::vector<double> knot = knots(m);
    const double first = knot.empty() ? 0 : knot.front();
    piece_.push_back({0, 0, capacity(first), 0});
    fall_.push_back({0, 0, 0, 0});
    if (knot.empty()) return;
    piece_.front() = {first, capacity(first) * first, capacity(first), 0};  // and below it
    const double molten = m.latent_heat > 0 ? m.density(m.solidus) * m.latent_heat / (m.liquidus - m.solidus) : 0;
    double enthalpy = piece_.front().enthalpy;
    for (std::size_t k = 0; k < knot.size(); ++k) {
        const bool last = k + 1 == knot.size();
        const double width = last ? 0 : knot[k + 1] - knot[k];
        const double melting = knot[k] >= m.solidus && knot[k] < m.liquidus ? molten : 0;
        const double begin = capacity(knot[k]) + melting;
        const double end = last ? begin : capacity(knot[k + 1]) + melting;
        piece_.push_back({knot[k], enthalpy, begin, last ? 0 : (end - begin) / width});
        enthalpy += width * (begin + end) / 2;
    }
    sum_falls();
}

/// Of each piece, by how much the slope has fallen up to it, and falls in it.
void Enthalpy::sum_falls() {
    fall_ = {{piece_.front().temperature, 0, 0, 0}};
    for (std::size_t k = 1; k < piece_.size(); ++k) {
        const Piece &last = piece_[k - 1], &here = piece_[k], &summed = fall_.back();
        const double width = here.temperature - last.temperature, end = last.slope + last.bend * width;
        const double so_far = summed.slope + summed.bend * width;
        fall_.push_back({here.temperature, summed.enthalpy + width * (summed.slope + so_far) / 2,
                         so_far + std::max(0.0, end - here.slope), std::max(0.0, -here.bend)});
    }
}

double Enthalpy::value_of(const std::vector<Piece>& pieces, double temperature) {
    const auto beyond = std::upper_bound(pieces.begin() + 1, pieces.end(), temperature,
                                         [](double t, const Piece& piece) { return t < piece.temperature; });
    const Piece& piece = *(beyond - 1);
    const double more = temperature - piece.temperature;
    return piece.enthalpy + more * (piece.slope + 0.5 * piece.bend * more);
}

double Enthalpy::slope_of(const std::vector<Piece>& pieces, double temperature) {
    const auto beyond = std::upper_bound(pieces.begin() + 1, pieces.end(), temperature,
                                         [](double t, const Piece& piece) { return t < piece.temperature; });
    const Piece& piece = *(beyond - 1);
    return piece.slope + piece.bend * (temperature - piece.temperature);
}

double Enthalpy::operator()(double temperature) const {
    return value_of(piece_, temperature);
}

double Enthalpy::slope(double temperature) const {
    return slope_of(piece_, temperature);
}

double Enthalpy::fallen(double temperature) const {
    return value_of(fall_, temperature);
}

double Enthalpy::fallen_slope(double temperature) const {
    return slope_of(fall_, temperature);
}

double Enthalpy::temperature(double enthalpy) const {
    const auto beyond = std::upper_bound(piece_.begin() + 1, piece_.end(), enthalpy,
                                         [](double h, const Piece& piece) { return h < piece.enthalpy; });
    const Piece& piece = *(beyond - 1);
    const double more = enthalpy - piece.enthalpy;
    const double root = std::sqrt(std::max(0.0, piece.slope * piece.slope + 2 * piece.bend * more));
    return piece.temperature + 2 * more / (piece.slope + root);
}

}  // namespace kropla
