#pragma once

#include <vector>

namespace kropla {

/// A property of a material, by the temperature [K]: a number, or a table, piecewise linear and constant beyond its ends.
class Property {
public:
    Property(double number = 1) : value_{number} {}  // NOLINT: a number is a property
    /// At least two temperatures, rising, and as many values. Throws CaseError if not.
    Property(std::vector<double> temperature, std::vector<double> value);

    bool operator==(const Property&) const = default;

    [[nodiscard]] bool constant() const { return temperature_.empty(); }
    [[nodiscard]] double operator()(double temperature) const;
    [[nodiscard]] const std::vector<double>& temperatures() const { return temperature_; }  // empty: a number
    [[nodiscard]] const std::vector<double>& values() const { return value_; }

private:
    std::vector<double> temperature_, value_;
};

struct HeatMaterial {
    Property conductivity = 1;   // [W/(m K)]
    Property density = 1;        // [kg/m^3]
    Property specific_heat = 1;  // [J/(kg K)]
    double latent_heat = 0;      // [J/kg] taken up evenly from `solidus` to `liquidus`
    double solidus = 0, liquidus = 0;  // [K] only with a latent heat
};

/// The heat that a volume holds [J/m^3]: the integral of density times specific heat from 0 K on, and the latent heat.
/// Piecewise quadratic: between the temperatures of both tables the product is taken as linear, in eight pieces where
/// both vary. It rises with the temperature, so that each determines the other.
class Enthalpy {
public:
    Enthalpy() : Enthalpy(HeatMaterial{}) {}
    explicit Enthalpy(const HeatMaterial& material);

    /// Is it the temperature times a number, `slope` of any?
    [[nodiscard]] bool proportional() const { return piece_.size() == 1; }
    [[nodiscard]] double operator()(double temperature) const;
    [[nodiscard]] double slope(double temperature) const;  // [J/(m^3 K)]; at a jump the one beyond it
    [[nodiscard]] double temperature(double enthalpy) const;
    /// What all falls of the slope at colder temperatures sum up to, and the integral of it: with them added, the slope and
    /// the enthalpy only bend upwards.
    [[nodiscard]] double fallen(double temperature) const;        // [J/m^3]
    [[nodiscard]] double fallen_slope(double temperature) const;  // [J/(m^3 K)]

private:
    /// From a temperature on, up to that of the next piece.
    struct Piece {
        double temperature, enthalpy;
        double slope, bend;  // at its begin, and how it rises [J/(m^3 K^2)]
    };
    static double value_of(const std::vector<Piece>& pieces, double temperature);
    static double slope_of(const std::vector<Piece>& pieces, double temperature);
    void sum_falls();

    std::vector<Piece> piece_, fall_;
};

}  // namespace kropla
