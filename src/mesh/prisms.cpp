// Prisms of the layers: numbering, volume, quality.

#include <kropla/mesh/prisms.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace kropla {

int count_prisms(const Mesh& mesh) {
    int sum = 0;
    for (const PrismLayer& layer : mesh.layers) sum += count_prisms(layer);
    return sum;
}

void add_layer(Mesh& mesh, PrismLayer layer) {
    const Layer name(mesh.layers.size());
    for (Vertex v : layer.columns)
        if (!mesh.layer_at[v].exists()) mesh.layer_at[v] = name;
    std::erase_if(mesh.free_vertices, [&](Vertex v) { return alive(mesh, v); });
    mesh.layers.push_back(std::move(layer));
}

std::vector<Prism> all_prisms(const Mesh& mesh) {
    std::vector<Prism> prisms;
    prisms.reserve(as_size(count_prisms(mesh)));
    for (std::size_t l = 0; l < mesh.layers.size(); ++l)
        for (int triangle = 0; triangle < static_cast<int>(mesh.layers[l].triangles.size()); ++triangle)
            for (int k = 0; k < mesh.layers[l].count; ++k) prisms.push_back({Layer(l), triangle, k});
    return prisms;
}

std::array<Vertex, 6> prism_vertices(const Mesh& mesh, const Prism& prism) {
    const PrismLayer& layer = layer_of(mesh, prism.layer);
    const auto [a, b, c] = layer.triangles[as_size(prism.triangle)];
    const auto corner = [&](int column, int k) { return column_vertex(layer, column, k); };
    return {corner(a, prism.k),     corner(b, prism.k),     corner(c, prism.k),
            corner(a, prism.k + 1), corner(b, prism.k + 1), corner(c, prism.k + 1)};
}

std::array<Vec3, 6> prism_corners(const Mesh& mesh, const Prism& prism) {
    std::array<Vec3, 6> corners;
    const auto vertices = prism_vertices(mesh, prism);
    for (std::size_t i = 0; i < 6; ++i) corners[i] = mesh.position[vertices[i]];
    return corners;
}

double prism_volume(const std::array<Vec3, 6>& x) {
    // The mean over the six ways to cut it into three tets is exact: each bilinear quad lies half-way between
    // its two pairs of triangles. The flux of x/3 through two triangles and the mean of both cuts of each
    // quad is the same.
    const auto through = [&](std::size_t a, std::size_t b, std::size_t c) {
        return determinant(x[a] - x[0], x[b] - x[0], x[c] - x[0]) / 6;
    };
    double volume = through(0, 2, 1) + through(3, 4, 5);
    for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 1}, {1, 2}, {2, 0}}) {
        const std::size_t c = a + 3, d = b + 3;
        volume += (through(a, b, d) + through(a, d, c) + through(a, b, c) + through(b, d, c)) / 2;
    }
    return volume;
}

double scaled_corner_jacobian(const std::array<Vec3, 6>& x) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 6; ++i) {
        const std::size_t base = i < 3 ? 0 : 3, k = i % 3;
        const Vec3 next = x[base + (k + 1) % 3] - x[i], last = x[base + (k + 2) % 3] - x[i];
        const Vec3 along = x[k + 3] - x[k];
        const double size = norm(next) * norm(last) * norm(along);
        least = std::min(least, size > 0 ? determinant(next, last, along) / size : 0.0);
    }
    return least / (std::numbers::sqrt3 / 2);
}

LayerSummary summarise_layer(const Mesh& mesh, Layer l) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const PrismLayer& layer = layer_of(mesh, l);
    LayerSummary summary{.prisms = count_prisms(layer), .min_jacobian = infinity};
    summary.min_first_height = summary.min_growth = summary.min_thickness = infinity;
    const auto note = [](double value, double& least, double& largest) {
        least = std::min(least, value);
        largest = std::max(largest, value);
    };
    for (int column = 0; column < count_columns(layer); ++column) {
        double thickness = 0, below = 0;
        for (int k = 0; k < layer.count; ++k) {
            const double height = distance(mesh.position[column_vertex(layer, column, k)],
                                           mesh.position[column_vertex(layer, column, k + 1)]);
            if (k == 0) note(height, summary.min_first_height, summary.max_first_height);
            else note(height / below, summary.min_growth, summary.max_growth);
            thickness += height;
            below = height;
        }
        note(thickness, summary.min_thickness, summary.max_thickness);
    }
    if (layer.count < 2) summary.min_growth = summary.max_growth = 1;
    for (int triangle = 0; triangle < static_cast<int>(layer.triangles.size()); ++triangle)
        for (int k = 0; k < layer.count; ++k)
            summary.min_jacobian =
                std::min(summary.min_jacobian, scaled_corner_jacobian(prism_corners(mesh, {l, triangle, k})));
    return summary;
}

}  // namespace kropla
