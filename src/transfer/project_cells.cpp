// Projection of cell fields: a new cell gets the mean of the old ones by their shares of it.

#include <kropla/mesh/quality.h>
#include "transfer/kept.h"
#include "transfer/geometry.h"

#include <algorithm>
#include <cmath>

namespace kropla {
TransferReport project(const TransferPlan& plan, CellData values, const ProjectOptions& options) {
    heed(options.watch);
    check_weights(*plan.after, plan.geometry->changed, options.weight);
    for (Tet t : plan.geometry->changed.gone) check_value(values[t], "cell", t.value);
    RegionSums sums(plan);
    std::vector<double> fresh(plan.geometry->changed.come.size());
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        const Tet t = plan.geometry->changed.come[i];
        for (const CellShare& share : plan.geometry->overlaps.cell(i))
            fresh[i] += share.share * values[plan.geometry->changed.gone[static_cast<std::size_t>(share.gone)]];
        sums.add_new(t, volume(*plan.after, t) * fresh[i]);
    }
    for (Tet t : plan.geometry->changed.gone) {
        const double part = volume(*plan.before, t) * values[t];
        sums.add_old(plan.before->region[t], part, std::abs(part));
    }
    sums.check();
    for (std::size_t i = 0; i < fresh.size(); ++i) values[plan.geometry->changed.come[i]] = fresh[i];
    TransferReport report;
    sums.report(report, options.weight);
    return report;
}

TransferReport project(const TransferPlan& plan, Array<Tet, double>& values, const ProjectOptions& options) {
    return with_all_slots(values, plan.after->tets.size(),
                          [&] { return project(plan, CellData{values.data()}, options); });
}

}  // namespace kropla
