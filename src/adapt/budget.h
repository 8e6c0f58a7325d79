#pragma once

#include <kropla/adapt/adapt.h>

#include "adapt/constants.h"
namespace kropla {

/// What a loop may still do: counted in what it handles, never in seconds, so that the result is the same on every
/// machine.
class Budget {
public:
    explicit Budget(double count) : left_(count) {}

    void add(double count) { left_ += count; }
    /// What is handled last may cost more than is left; then it is spent.
    void take(double count) { left_ -= count; }
    [[nodiscard]] bool spent() const { return left_ < 0; }
    [[nodiscard]] double left() const { return left_; }

private:
    double left_;
};

/// The cells that may be cut out for the sake of bad ones among so many.
[[nodiscard]] inline double cells_to_cut_out(std::size_t cells, const AdaptOptions& options) {
    return options.cut_out * static_cast<double>(cells) + least_cut_out;
}

/// As in adapt.h, with a budget of cells that it shares with other attempts; nothing if that is spent.
[[nodiscard]] std::optional<Cavity> cluster_remesh(const Mesh& mesh, std::vector<Tet> cluster, const Snapshot& at,
                                                   const AdaptOptions& options, Budget& cells);

}  // namespace kropla
