#pragma once

#include <kropla/base/watch.h>
#include <kropla/mesh/mesh.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace kropla {

// --- Where a point is --------------------------------------------------------------------------------------

/// Where a point is: in a tet, at these barycentric coordinates (they sum to one; none is below -1e-9, save
/// for a point that lies outside the region by more than rounding, which gets the nearest tet found).
struct Location {
    Tet tet;
    std::array<double, 4> weights;
};

/// Finds the tet of the region of `start` that holds `x`: a walk from `start` across the facets that `x` lies
/// beyond, as in [Devillers, Pion, Teillaud 2001], "Walking in a triangulation"; where the walk ends at the
/// region's surface, as a region need not be convex, the search spreads from there from neighbour to
/// neighbour.
[[nodiscard]] Location locate(const Mesh& mesh, const Vec3& x, Tet start);

// --- The plan: geometry, once per change of the mesh -------------------------------------------------------

struct TransferGeometry;

/// How to carry any field from `before` to `after`, which are to outlive the plan.
struct TransferPlan {
    const Mesh* before = nullptr;
    const Mesh* after = nullptr;
    std::size_t cells = 0;  // of the new mesh that take part: those that changed, and those around them
    std::shared_ptr<const TransferGeometry> geometry;
};

/// Plans the transfer between two meshes in one slot numbering which differ in `cells` and in the balls of
/// `vertices` (each may stand more than once, some may be gone again). The work is proportional to what
/// differs. Regions fill the same volume in both meshes, and layers are the same. Throws Interrupted if the watch
/// says so.
[[nodiscard]] TransferPlan plan_transfer(const Mesh& before, const Mesh& after, std::span<const Tet> cells,
                                         std::span<const Vertex> vertices, const Watch* watch = nullptr);

/// The same for any two meshes of one domain: all slots are compared.
[[nodiscard]] TransferPlan plan_transfer(const Mesh& before, const Mesh& after, const Watch* watch = nullptr);

// --- Fields ------------------------------------------------------------------------------------------------

/// One number per vertex, wherever it is kept: that of vertex v is first[v.value * stride]. So a component of
/// a vector, a time level, a member of a user's own struct is such a field. There is one for every slot of
/// both meshes.
struct NodalData {
    double* first;
    std::size_t stride = 1;  // [doubles]
    double& operator[](Vertex v) const { return first[static_cast<std::size_t>(v.value) * stride]; }
};
/// One number per tet, likewise.
struct CellData {
    double* first;
    std::size_t stride = 1;
    double& operator[](Tet t) const { return first[static_cast<std::size_t>(t.value) * stride]; }
};

struct ProjectOptions {
    bool limit = true;                    // keep the bounds of the old cells that overlap
    std::span<const double> weight = {};  // per region: the density whose integral is reported; empty: 1
    Region only = {};                     // a field of this region alone; elsewhere it has no meaning. None: of all
    const Watch* watch = nullptr;         // may end the work, which throws Interrupted then
};

/// What the transfer of a field did; integrals are over the cells that take part, weighted.
struct TransferReport {
    double before = 0, after = 0;  // the integral
    double size = 0;               // that of the absolute values: what the error is relative to
    double limited = 0;            // the largest change of a value by the limiter
    double beyond = 0;  // by how much a value exceeds its bounds, where no others keep the integral
    int grown = 0;      // clusters that had to take in more cells to keep their bounds

    [[nodiscard]] double error() const { return size > 0 ? (after - before) / size : 0; }
    TransferReport& operator+=(const TransferReport& other);
};

/// Carries a field that is linear in every tet: on each cluster of changed cells the projection in the mean
/// square (Galerkin) among the fields that have the old integral there, and at the rim the old values. Values
/// of vertices that keep one unchanged cell stay, bit for bit, where a cluster need not grow: it grows by a
/// ring of cells if it has no free vertex, or if no values within the bounds have the integral. Vertices of
/// interfaces and layers keep their values, or where they are new or elsewhere get the old one at the nearest
/// point, so that each region's integral is its own. Linear fields are kept exactly.
/// Throws, nothing written: FieldError if a value that takes part or a weight is not finite, or a region has no
/// weight; TransferError if the integral of a region would differ by more than 1e-12 of that of the absolute
/// value, as where cells change in a region of which no vertex is free; Interrupted if the watch says so.
TransferReport project(const TransferPlan& plan, NodalData values, const ProjectOptions& options = {});
TransferReport project(const TransferPlan& plan, Array<Vertex, double>& values,
                       const ProjectOptions& options = {});
/// By components; the report is of all three.
TransferReport project(const TransferPlan& plan, Array<Vertex, Vec3>& values,
                       const ProjectOptions& options = {});

/// Carries a field that is constant in every tet: means over the old cells that overlap, which keep the
/// integral and the bounds by themselves. Throws as for vertices.
TransferReport project(const TransferPlan& plan, CellData values, const ProjectOptions& options = {});
TransferReport project(const TransferPlan& plan, Array<Tet, double>& values,
                       const ProjectOptions& options = {});

}  // namespace kropla
