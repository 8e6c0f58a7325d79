#include <kropla/step/fields.h>

#include <stdexcept>
#include <string>

namespace kropla {
namespace {

std::size_t slots(const Mesh& mesh, bool of_vertices) {
    return of_vertices ? mesh.position.size() : mesh.tets.size();
}

}  // namespace

Fields::Copy Fields::copy() const {
    Copy copy;
    for (const Field& field : fields_) copy.restore_.push_back(field.copy());
    return copy;
}

std::vector<TransferReport> Fields::carry(const TransferPlan& plan, const Watch* watch) {
    std::vector<TransferReport> reports;
    for (const Field& field : fields_) {
        TransferReport& report = reports.emplace_back();
        const std::size_t size = slots(*plan.after, field.of_vertices);
        if (field.size() < size) field.resize(size);
        if (size == 0) continue;
        const ProjectOptions options{field.how.limit, field.how.weight, field.how.only, watch};
        for (const auto& component : field.components)
            for (double& first : component())
                report += field.of_vertices ? project(plan, NodalData{&first, field.stride}, options)
                                            : project(plan, CellData{&first, field.stride}, options);
        field.resize(size);
    }
    return reports;
}

void Fields::check_sizes(const Mesh& mesh) const {
    for (std::size_t i = 0; i < fields_.size(); ++i) {
        const std::size_t wanted = slots(mesh, fields_[i].of_vertices);
        if (fields_[i].size() >= wanted) continue;
        throw std::logic_error("field " + std::to_string(i + 1) + " of a step has " + std::to_string(fields_[i].size()) +
                               " items, but the mesh has " + std::to_string(wanted) + " slots of " +
                               (fields_[i].of_vertices ? "vertices" : "cells"));
    }
}

}  // namespace kropla
