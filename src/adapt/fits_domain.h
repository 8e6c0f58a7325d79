#pragma once

#include <kropla/domain/domain.h>
#include <kropla/mesh/mesh.h>

namespace kropla {

/// Is this the mesh of the domain at time `t` [s]? Throws DomainError, naming body, region or facet, and place: if
/// `verify` finds a fault; a region is that of no body, or a body has no cells; a facet in patch 0 ... 5 does not lie
/// on that face of the box; or a vertex of a body's surface is farther from where the body stands then than half of
/// its surface size.
void check_fits(const Domain& domain, const Mesh& mesh, double t);

}  // namespace kropla
