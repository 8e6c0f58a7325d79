#pragma once

#include <kropla/mesh/mesh.h>

#include <span>

namespace kropla {

/// A prism of a mesh, by where it stands in its layer.
struct Prism {
    Layer layer;
    int triangle;
    int k;  // 0 ... count - 1, from the wall
};

[[nodiscard]] inline const PrismLayer& layer_of(const Mesh& mesh, Layer l) {
    return mesh.layers[as_size(l.value)];
}

/// The patches of the tets' boundary that a layer takes: at its wall, on the far side of the body's surface,
/// and at its shell.
[[nodiscard]] inline Patch wall_patch(Layer l) { return Patch(box_faces + 2 * l.value); }
[[nodiscard]] inline Patch shell_patch(Layer l) { return Patch(box_faces + 2 * l.value + 1); }

inline constexpr int most_layers = 13;  // patches go up to 31

/// A vertex of a column: k = 0 on the wall ... count on the shell.
[[nodiscard]] inline Vertex column_vertex(const PrismLayer& layer, int column, int k) {
    return layer.columns[as_size(column * (layer.count + 1) + k)];
}
[[nodiscard]] inline int count_columns(const PrismLayer& layer) {
    return static_cast<int>(layer.columns.size()) / (layer.count + 1);
}
[[nodiscard]] inline int count_prisms(const PrismLayer& layer) {
    return static_cast<int>(layer.triangles.size()) * layer.count;
}
[[nodiscard]] int count_prisms(const Mesh& mesh);

/// Gives the mesh one more layer: its column vertices, places of `position` already, are no free slots from
/// now on.
void add_layer(Mesh& mesh, PrismLayer layer);

/// All prisms, layer by layer, triangle by triangle, from the wall outwards.
[[nodiscard]] std::vector<Prism> all_prisms(const Mesh& mesh);

/// The six vertices, numbered as in cells.h.
[[nodiscard]] std::array<Vertex, 6> prism_vertices(const Mesh& mesh, const Prism& prism);
[[nodiscard]] std::array<Vec3, 6> prism_corners(const Mesh& mesh, const Prism& prism);

/// The volume [m^3] of a prism whose quads are bilinear; exact.
[[nodiscard]] double prism_volume(const std::array<Vec3, 6>& corners);

/// The least scaled Jacobian of the six corners: the determinant of the three edges there by their lengths,
/// against that of a corner of a right prism on an equilateral triangle (sin 60 degrees): 1 is perfect, below
/// 0 turned over.
[[nodiscard]] double scaled_corner_jacobian(const std::array<Vec3, 6>& corners);

/// What is reported of one layer. Heights are lengths of column edges.
struct LayerSummary {
    int prisms = 0;
    double min_jacobian = 1;                          // [-] least scaled corner Jacobian
    double min_first_height = 0, max_first_height = 0;  // [m]
    double min_growth = 0, max_growth = 0;            // [-] between heights of one column
    double min_thickness = 0, max_thickness = 0;      // [m] of columns
};
[[nodiscard]] LayerSummary summarise_layer(const Mesh& mesh, Layer layer);

}  // namespace kropla
