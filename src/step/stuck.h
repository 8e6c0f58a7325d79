#pragma once

#include <kropla/base/error.h>
#include <kropla/mesh/mesh.h>

#include <optional>
#include <string>
#include <utility>

namespace kropla {

/// A FloorError that knows where [m]; and the mesh that failed there, if there is no better one to show.
struct StuckError : FloorError {
    StuckError(const std::string& what, const std::optional<Vec3>& at, std::optional<Mesh> reached = {})
        : FloorError(what), place(at), mesh(std::move(reached)) {}
    std::optional<Vec3> place;
    std::optional<Mesh> mesh;
    bool in_gap = false;  // bodies, or a body and a wall, leave too little room there
};

}  // namespace kropla
