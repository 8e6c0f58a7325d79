#pragma once

#include "simulate/assembly.h"
#include "simulate/elements.h"
#include <kropla/simulate/material_flow.h>
#include <kropla/simulate/heat.h>

namespace kropla {

/// What the material of a region is at its vertices; empty where it does not depend on the temperature. Enthalpies are
/// per volume, or per mass in the region that is carried by its mass.
struct MaterialState {
    Array<Vertex, double> enthalpy;      // [J/m^3] at the temperature that is guessed
    Array<Vertex, double> slope;         // [J/(m^3 K)] of it there
    Array<Vertex, double> conductivity;  // [W/(m K)] there
    Array<Vertex, double> old;           // [J/m^3] the enthalpy at the step's begin
};

/// All that a cell needs to know of the step.
struct HeatStep {
    const Mesh& before;
    const Mesh& current;
    const HeatOptions& options;
    const Array<Vertex, double>& old_temperature;
    const MaterialFlow& flow;                        // of what does not go with the mesh
    Array<Region, Array<Vertex, Vec3>> carried;      // where a body's vertices came from [m], or empty
    const Array<Region, Array<Vertex, double>>& source;  // its mean at the region's vertices [W/m^3], or empty
    double dt;                                       // [s]

    Region only = {};                  // the region that is stepped; none: all of them
    Array<Region, Enthalpy> enthalpy = {};
    Array<Region, MaterialState> material = {};
    Array<Vertex, double> guess = {};  // [K] about which all that is not linear is taken as linear
    Array<Vertex, char> low = {};      // vertices whose cells are to be of low order (bounded.h); empty: none

    [[nodiscard]] bool steps(Region region) const { return !only.exists() || region == only; }
};

/// Of each region; per mass of this one.
[[nodiscard]] Array<Region, Enthalpy> enthalpy_curves(const HeatOptions& options, Region by_mass = {});

/// The cell's part of the system derived in heat.h: rows in J, unknowns in K.
[[nodiscard]] CellSystem<4> cell_system(const HeatStep& step, Tet t);
[[nodiscard]] CellSystem<6> cell_system(const HeatStep& step, const Prism& prism);
/// Of four tets at once, to the same bits.
void cell_systems(const HeatStep& step, const std::array<Tet, 4>& tets, const FourPlaces& systems);

/// What ask_cells is to ask.
struct HeatKernel {
    const HeatStep& step;

    template <class Cell>
    auto operator()(const Cell& cell) const { return cell_system(step, cell); }
    void operator()(const std::array<Tet, 4>& tets, const FourPlaces& systems) const { cell_systems(step, tets, systems); }
};

}  // namespace kropla
