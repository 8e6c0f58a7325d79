#include <kropla/adapt/moving_mesh.h>

#include "adapt/mesh_step.h"
#include "adapt/fits_domain.h"
#include <kropla/domain/solids.h>

#include <stdexcept>
#include <utility>

namespace kropla {
namespace {

const MeshStep& there(const std::shared_ptr<MeshStep>& step) {
    if (!step) throw std::logic_error("a moving mesh that was moved from");
    return *step;
}

}  // namespace

MovingMesh::MovingMesh(Domain domain, Mesh mesh, double t, const AdaptOptions& options,
                       std::span<const BodyPlace> places) {
    for (Body& body : domain.bodies) body = cut_body(std::move(body));  // what reaches through faces of the box
    PlannedMotions planned(domain, t);
    for (const BodyPlace& place : places) planned.correct(domain, place, t);
    for (const BodySurface& surface : deforming_surfaces(domain, mesh))  // it is where the mesh has it
        domain.bodies[surface.body].shape = shape_of(surface, mesh.position, domain.box);
    check_fits(domain, mesh, t);
    step_ = std::make_shared<MeshStep>(std::move(domain), std::move(planned), std::move(mesh), t, options);
}

MovingMesh::MovingMesh(const MovingMesh& other) : step_(std::make_shared<MeshStep>(there(other.step_))) {
    step_->end_attempt();
    step_->drop();
}

MovingMesh& MovingMesh::operator=(const MovingMesh& other) {
    MovingMesh copy(other);
    return *this = std::move(copy);
}

const Mesh& MovingMesh::reference() const { return there(step_).reference(); }
double MovingMesh::time() const { return there(step_).time(); }
const Domain& MovingMesh::domain() const { return there(step_).domain(); }

}  // namespace kropla
