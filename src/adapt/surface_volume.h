#pragma once

#include "adapt/surface.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace kropla {

// The volume under triangles of a surface, some of whose vertices stand elsewhere than in the mesh.

using Triangle = std::array<Vertex, 3>;

/// Places of a mesh, some of them changed.
class Places {
public:
    Places(const Mesh& mesh, std::span<const Displaced> moved) : mesh_(mesh), moved_(moved) {}
    [[nodiscard]] const Vec3& operator[](Vertex v) const {
        const auto found = std::ranges::find(moved_, v, &Displaced::vertex);
        return found == moved_.end() ? mesh_.position[v] : found->place;
    }

private:
    const Mesh& mesh_;
    std::span<const Displaced> moved_;
};

/// Six times the volume under the triangles, seen from `origin`.
[[nodiscard]] double volume_under(std::span<const Triangle> triangles, const Places& places, const Vec3& origin);

/// The triangles of the surface at the vertices, each once.
[[nodiscard]] std::vector<Triangle> triangles_at(const Mesh& mesh, std::span<const Vertex> vertices, Region region);

}  // namespace kropla
