#pragma once

#include "transfer/geometry.h"

#include <algorithm>
#include <span>
#include <vector>

namespace kropla {

/// The integrals of a field over what changed in each region, before and after: whether a transfer has kept them
/// is asked of these sums, before anything is written.
class RegionSums {
public:
    explicit RegionSums(const TransferPlan& plan);

    /// Parts of the integral of the field, and of its absolute value, over an old cell and over a new one.
    void add_old(Region region, double part, double size);
    void add_new(Tet cell, double part);

    /// Throws TransferError if a region's integral differs by more than 1e-12 of that of the absolute value.
    void check() const;
    /// Adds the integrals, weighted, to a report.
    void report(TransferReport& report, std::span<const double> weight) const;

private:
    struct Sums {
        double before = 0, after = 0, size = 0;
        std::size_t cells = 0;  // old ones
        Tet first = {};  // of the new ones
    };
    const Mesh& after_;
    std::vector<Sums> regions_;
};

/// Throws FieldError if there is not a finite weight for each region of cells that changed; no weights at all
/// are all one.
void check_weights(const Mesh& after, const ChangedCells& changed, std::span<const double> weight);
/// Throws FieldError, naming "vertex" or "cell" and its slot, if the value is not finite.
void check_value(double value, const char* what, std::int32_t slot);

/// Does the deed on an array that has a value for every slot of both meshes, and leaves it with one for each of
/// the new; if the deed throws, with those it had.
template <class Values, class Deed>
TransferReport with_all_slots(Values& values, std::size_t after, const Deed& deed) {
    const std::size_t before = values.size();
    values.resize(std::max(before, after));
    try {
        const TransferReport report = deed();
        values.resize(after);
        return report;
    } catch (...) {
        values.resize(before);
        throw;
    }
}

}  // namespace kropla
