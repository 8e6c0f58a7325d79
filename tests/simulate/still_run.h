#pragma once

#include "heat_problems.h"
#include "meshes.h"

#include <vector>

namespace kropla {

/// Steps of heat on a mesh that stands still; what they report goes into the outcome.
class StillRun {
public:
    StillRun(const Ranks& ranks, const Mesh& mesh, const HeatOptions& options, Outcome& outcome)
        : field(initial_temperature(mesh, options)), ranks_(ranks), mesh_(mesh), options_(options), outcome_(outcome) {}

    /// Takes `count` equal steps to `end` [s].
    void steps_to(double end, int count);

    NodalField field;
    double time = 0;  // [s]

private:
    const Ranks& ranks_;
    const Mesh& mesh_;
    const HeatOptions& options_;
    Outcome& outcome_;
};

/// The volume that is solid [m^3]: 1 at vertices colder than `solidus`, 0 above `liquidus`, linear in between.
[[nodiscard]] double solid_volume(const Mesh& mesh, const NodalField& temperature, double solidus, double liquidus);

/// An eighth of a ball around the origin, of shells with these radii, as ball_of_shells; regions by shell (-1: hollow).
/// The outermost sphere has the patches 1, 3 and 5, the planes and a hole's surface have patch 0.
[[nodiscard]] Mesh eighth_of_ball(const std::vector<double>& radii, const std::function<int(int shell)>& region);

/// Radii that are a little larger, by which the facets of each shell enclose the volume that its sphere should.
[[nodiscard]] std::vector<double> keeping_volumes(const std::vector<double>& radii);

/// A narrow part of a ball around the origin, `across` cells wide in both directions, of shells with these radii [m]; its
/// sides are planes through the origin. It begins at the origin if the first radius is 0, else with a sphere, patch 2. The
/// last sphere is patch 1. Volumes are `share` times (r1^3 - r0^3) between any two radii.
struct Sector {
    Mesh mesh;
    double share;
};
[[nodiscard]] Sector sector_of_ball(const std::vector<double>& radii, int across,
                                    const std::function<int(int shell)>& region);

/// The mean of the vertices at this distance from the origin [m], to 1e-9 of it.
[[nodiscard]] double mean_at_radius(const Mesh& mesh, const NodalField& field, double radius);

/// The value at the vertex that stands there.
[[nodiscard]] double value_at_vertex(const Mesh& mesh, const NodalField& field, const Vec3& place);

/// Where a function that changes its sign between `low` and `high` is zero.
[[nodiscard]] double root_between(const std::function<double(double)>& function, double low, double high);

}  // namespace kropla
