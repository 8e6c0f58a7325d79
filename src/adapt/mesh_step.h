#pragma once

#include <kropla/adapt/attempt.h>
#include "adapt/correction.h"
#include "adapt/zone.h"

#include <map>

namespace kropla {

/// The three meshes of a moving mesh and the step it may be in: what the stages of attempt.h do, to be called in this
/// order and guarded by them.
///
///     begin_step(); refine();                       // 2.1, 2.2
///     aim_at(t + dt); move_boundary(); optimise();  // 2.3, 2.4
///     if (refusal()) refuse();                      // the reference is as it was; the next refine() knows where it stuck
///     else { remesh(); accept(); }                  // 2.6
class MeshStep {
public:
    MeshStep(Domain domain, PlannedMotions planned, Mesh mesh, double t, const AdaptOptions& options = {});

    [[nodiscard]] const Mesh& reference() const { return reference_; }
    [[nodiscard]] double time() const { return time_; }  ///< of the reference [s]
    [[nodiscard]] double target_time() const { return target_time_; }  ///< of the current mesh
    [[nodiscard]] const Domain& domain() const { return domain_; }
    [[nodiscard]] bool under_way() const { return under_way_; }
    [[nodiscard]] const StepStatistics& statistics() const { return statistics_; }

    /// An attempt is under way, until it is ended; unless it was accepted, bodies move as they did before it.
    void begin_attempt() { under_way_ = true; }
    void end_attempt() noexcept;
    /// The current mesh becomes a copy of the reference.
    void begin_step();
    /// After a refusal, remeshes where the motion got stuck; else does nothing. The solution is to be carried
    /// from reference() to before() at the vertices that are returned.
    const Changes& refine();
    /// The step is to end at `t` [s].
    void aim_at(double t) { target_time_ = t; }
    /// Moves bodies to where they are at its end, and their surroundings with them.
    void move_boundary();
    /// Optimises the places of the surroundings' vertices; if a cell would be turned over on the way, goes it again in
    /// as many legs as it takes for all cells to stay valid.
    void optimise();

    /// The current mesh is the one before the motion again, which is to end with these bodies there, or deformed so.
    void correct(std::span<const BodyPlace> places, std::span<const BodyCourse> courses);

    /// The mesh of the step at its beginning and at its end: one connectivity, two sets of places. After
    /// remesh() and accept(), before() is the mesh at the end of the step, not yet remeshed.
    [[nodiscard]] const Mesh& before() const { return before_; }
    [[nodiscard]] const Mesh& current() const { return current_; }

    /// Empty if the motion arrived and every cell meets the floors, all along its way.
    [[nodiscard]] std::optional<Refusal> refusal() const;
    void refuse();
    /// Drops the attempt under way, of which an exception may have left anything: the reference is as it was.
    void drop() { dropped_ = true; }
    /// Remeshes the current mesh where needed; the reference is not touched. The solution is to be carried from
    /// before() to current() at the vertices that are returned.
    const Changes& remesh();
    /// The current mesh, which is remeshed, becomes the reference.
    void accept();

private:
    struct Told {
        CorrectedStep step;
        Motion before;  // what the domain had
    };

    /// Bodies move and deform as the domain was made, or go on.
    void forget_told() noexcept;
    /// Looks for the surfaces of deforming bodies in the reference; for what gaps have left uneven.
    void find_deforming();
    void find_uneven();
    /// With the bodies where the current mesh has them.
    [[nodiscard]] Snapshot snapshot_at(double t) const;
    [[nodiscard]] std::optional<Refusal> what_limits() const;
    [[nodiscard]] Refusal refused(Tet cell, const std::string& fault, double advised_dt) const;
    [[nodiscard]] std::optional<Refusal> narrow_gap() const;
    [[nodiscard]] std::optional<Refusal> worst_cell() const;
    [[nodiscard]] std::optional<Refusal> squeezed_prism() const;
    [[nodiscard]] std::optional<Refusal> turned_too_far() const;
    [[nodiscard]] std::optional<Refusal> turned_on_its_way() const;
    Changes refine_by_size();
    Changes refine_by_paper();
    Changes remesh_by_size(const AdaptOptions& options);
    Changes remesh_by_paper();
    /// The surfaces that are to be adapted: of bodies that deform, and of those whose triangles do not have the sizes that
    /// gaps ask for, or had to have.
    [[nodiscard]] std::vector<BodySurface> surfaces_to_adapt(const Snapshot& at_time);
    void adapt_surfaces(const Snapshot& at_time, const AdaptOptions& options, Changes& changes);
    void improve_surfaces(std::vector<Tet> cells, const Snapshot& at_time, const AdaptOptions& options, Changes& changes);
    void move_in_legs();
    void note_turned_over(double reached);
    bool optimise_placed();
    [[nodiscard]] std::vector<Tet> cells_above(double ratio) const;
    void note_moved();
    void note_replaced(const Changes& changes);

    Domain domain_;                          // with motions that go on from where bodies really are
    PlannedMotions planned_;
    std::map<std::size_t, Told> told_;       // by bodies: this step
    std::map<std::size_t, Deformation> not_told_;  // what the domain had, by bodies that are told another for this step
    AdaptOptions options_;
    MovedBodies bodies_;
    std::vector<BodySurface> adapted_;  // surfaces that the step changes
    std::vector<char> is_uneven_;    // per body: its triangles became smaller once for the sake of a gap
    std::vector<Tet> at_inner_shells_;  // cells of bodies that move rigidly: at the shells of inner layers
    Mesh reference_, before_, current_;
    double time_, target_time_;
    Zone zone_;                      // what the step moves,
    ZoneMotion motion_;              // and where to
    MoveReport way_;                 // from before() to current()
    std::vector<Tet> refined_;       // cells that are new in the step
    IndexSet<Tet> replaced_;         // in which slots the three meshes may differ,
    std::vector<Vertex> moved_;      // and which vertices may have other places
    std::vector<Vec3> trouble_;      // where the attempts refused since the last accepted step got stuck
    std::optional<Refusal> stuck_;   // the motion did not arrive, or not as it should
    bool under_way_ = false;         // an attempt
    bool dropped_ = false;           // the other two meshes may differ from the reference anywhere
    StepStatistics statistics_;
};

}  // namespace kropla
