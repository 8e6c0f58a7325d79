#pragma once

#include <kropla/simulate/heat.h>

#include <optional>
#include <string>
#include <vector>

namespace kropla {

// What is dissolved in a material, goes with it and diffuses in it, region by region:
//     dc/dt + u . grad c = div(D grad c) + s,    c an amount per volume.
// This is the heat equation with a capacity of one, so it is stepped as heat is (heat.h): conserved, and within bounds.
// At an interface each side has a value of its own, and what passes is told: a flux through the body's surface.

struct SpeciesRegion {
    double diffusivity = 1;  // [m^2/s]
    HeatStart initial = 0;   // [kg/m^3] a number or a profile
    Quantity source = {};    // [kg/(m^3 s)]; empty: none
};

/// From a body into the surroundings, through its surface: what one of the two loses the other gains, where it is there.
struct SpeciesSurface {
    Quantity flux = {};   // [kg/(m^2 s)]
    double per_heat = 0;  // [kg/J] more of it, by the heat that leaves the body there, and only by that
};

struct Species {
    std::string name;
    std::vector<std::optional<SpeciesRegion>> regions;  // region 0, 1, ...: where it is
    std::array<HeatFace, 6> faces = {};                 // a value [kg/m^3] or a flux in [kg/(m^2 s)]; else nothing passes
    std::vector<SpeciesSurface> surfaces = {};          // of bodies 1, 2, ...; fewer: nothing passes at the others
};

/// Per region [kg/m^3] at its vertices, elsewhere zero; empty where the species is not.
using Concentrations = std::vector<Array<Vertex, double>>;

/// Throws CaseError, naming the key below `species.NAME`, if a diffusivity is not positive, an initial value not finite, or
/// the mesh has other regions.
[[nodiscard]] Concentrations initial_concentrations(const Mesh& mesh, const Species& species);

/// Brings values of a region that a transfer left beyond `least` and `most` [kg/m^3] back to them, and what this takes comes from
/// vertices around (bounded.h): the amount stays. All ranks call it together.
void keep_within(const Ranks& ranks, const Mesh& mesh, Region region, double least, double most, Array<Vertex, double>& values);

/// Of each region where the species is: the balance of amounts [kg], `surfaces` and `faces` among them.
struct SpeciesReport {
    std::vector<HeatBalance> balance;
};

/// Takes the concentrations from t [s] on `before` to t + dt on `current`. `heat` and `flow` (material_flow.h) say how
/// materials move, `surfaces` what heat left bodies in this step (HeatReport; empty: none). Ranks, solver and errors as for step_heat; with an error some
/// regions may have been stepped.
SpeciesReport step_species(const Ranks& ranks, const Mesh& before, const Mesh& current, const Species& species,
                           const HeatOptions& heat, const MaterialFlow& flow, const std::vector<SurfaceFlux>& surfaces,
                           Concentrations& values, double t, double dt);

}  // namespace kropla
