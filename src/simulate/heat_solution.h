#pragma once

#include "simulate/bounded.h"
#include "simulate/heat_cell.h"
#include "simulate/heat_conditions.h"
#include "simulate/solver.h"

#include <memory>
#include <string>
#include <vector>

namespace kropla {

/// A step of the heat equation while it is solved: all ranks do it together, with the same arguments.
class HeatSolution {
public:
    /// All outlive this; of the step, what changes from pass to pass is set.
    HeatSolution(const Ranks& ranks, HeatStep& step, const HeatConditions& conditions);

    /// A guess of the temperature at the end [K], instead of the one at the begin.
    void begin_with(const Array<Vertex, double>& guess);
    /// Throws SolverError if a system is not solved, or what is not linear does not settle; AllInterrupted if the watch of
    /// any rank says stop.
    void solve_all();

    /// The temperature at the end [K]; vertices that are not stepped have what they had.
    [[nodiscard]] const Array<Vertex, double>& after() const { return after_; }
    [[nodiscard]] HeatReport report() const;

private:
    [[nodiscard]] const std::vector<Vertex>& vertices() const { return pattern_->numbering.vertex; }
    [[nodiscard]] Vertex vertex_of(std::size_t owned_row) const {
        return vertices()[static_cast<std::size_t>(pattern_->rows.first_row) + owned_row];
    }
    [[nodiscard]] std::vector<double> per_row(const Array<Vertex, double>& values) const;
    void per_vertex(Array<Vertex, double>& values, const auto& value_of) const;
    [[nodiscard]] bool is_linear() const;
    [[nodiscard]] const HeatMaterial& material(Region r) const {
        return step_.options.regions[static_cast<std::size_t>(r.value)].material;
    }

    void set_fixed();
    void lower_marked();
    void lower_unsettled();
    [[nodiscard]] double negligible() const;
    void keep_bound(double bound, double side);

    void settle();
    [[nodiscard]] std::string not_settled(double change, int pass) const;
    double solve_once();
    double solve_to(double tolerance);
    double take(const std::vector<double>& solution);
    void take_as_guess();
    void take_falls_apart(const Enthalpy& h, MaterialState& state) const;
    [[nodiscard]] double nearest_to_guess(Vertex v, double solution) const;

    void assemble();
    void add_through();
    void note_capacities();
    void allow(std::size_t row, double load, double held);
    void allow_loads();
    void add_shares();
    void fix_values();

    const Ranks& ranks_;
    HeatStep& step_;
    const HeatConditions& conditions_;
    std::shared_ptr<const Pattern> pattern_;
    Array<Vertex, double> after_;
    Array<Vertex, double> solved_;  // before it was repaired: what the rows of the system speak of
    std::vector<char> marked_;      // rows of low order
    std::vector<double> changes_;   // of each row, by the last pass [-] of the largest temperature
    Array<Vertex, char> fresh_;     // that became so last; empty: none has
    CellSystems systems_;
    LinearSystem system_;
    Solver solver_;
    std::vector<double> diffusion_;  // along each coupling of the rank's rows
    std::vector<double> exchanged_;  // along it, by repair [J]
    std::vector<double> capacity_;   // of each row of all ranks [J/K]
    Allowance allowance_;
    bool linear_;
    bool surely_ = false;             // as take_falls_apart has it
    bool slowly_ = false;             // conductivities follow temperatures by halves
    Array<Vertex, double> falls_at_;  // temperatures about which falls of slopes are taken as linear; empty: there are none
    int iterations_ = 0, passes_ = 0;
    double error_ = 0;
};

}  // namespace kropla
