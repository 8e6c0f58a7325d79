// Projection of cell fields: a new cell gets the mean of the old ones by their shares of it.

#include "base/tetrahedron.h"
#include "transfer/transfer.h"

#include <algorithm>
#include <cmath>

namespace kropla {
namespace {

double volume_of(const Mesh& mesh, Tet t) {
    const auto& v = mesh.tets[t];
    return tet_volume(mesh.position[v[0]], mesh.position[v[1]], mesh.position[v[2]], mesh.position[v[3]]);
}

}  // namespace

TransferReport project(const TransferPlan& plan, CellData values, const ProjectOptions& options) {
    const auto weighted_volume = [&](const Mesh& mesh, Tet t) {
        const auto region = static_cast<std::size_t>(mesh.region[t].value);
        return volume_of(mesh, t) * (options.weight.empty() ? 1 : options.weight[region]);
    };
    TransferReport report;
    for (Tet t : plan.changed.gone) {
        const double part = weighted_volume(*plan.before, t) * values[t];
        report.before += part;
        report.size += std::abs(part);
    }
    std::vector<double> fresh(plan.changed.come.size());
    for (std::size_t i = 0; i < fresh.size(); ++i)
        for (const CellShare& share : plan.overlaps.cell(i))
            fresh[i] += share.share * values[plan.changed.gone[static_cast<std::size_t>(share.gone)]];
    for (std::size_t i = 0; i < fresh.size(); ++i) {
        const Tet t = plan.changed.come[i];
        values[t] = fresh[i];
        report.after += weighted_volume(*plan.after, t) * fresh[i];
    }
    return report;
}

TransferReport project(const TransferPlan& plan, Array<Tet, double>& values, const ProjectOptions& options) {
    values.resize(std::max(values.size(), plan.after->tets.size()));
    const TransferReport report = project(plan, CellData{values.data()}, options);
    values.resize(plan.after->tets.size());
    return report;
}

}  // namespace kropla
