#pragma once

#include <kropla/adapt/adapt.h>
#include <kropla/domain/domain.h>
#include <kropla/mesh/mesh.h>

namespace kropla {

/// The mesh with which a moving domain begins, at t = 0: generated, improved, repaired, triangles of surfaces without a
/// layer exchanged where cells at them stay bad, its slots in spatial order; where
/// a cell stays above the floor, with other random points, three times in all, or up to eight times if meshes are small.
/// Same domain, same `options.seed`, same mesh. The watch is told how far it is.
/// Throws DomainError if the domain cannot be meshed as it is asked for; StuckError, with the mesh as it is, if a cell
/// stays above `options.floor`.
[[nodiscard]] Mesh initial_mesh(const Domain& domain, const AdaptOptions& options = {});
[[nodiscard]] Mesh initial_mesh(const Domain& domain, std::uint64_t seed);

}  // namespace kropla
