#pragma once

#include "adapt/refusal.h"
#include "adapt/zone.h"

namespace kropla {

/// What a step did to the mesh, for reports.
struct StepStatistics {
    Changes refined;     // (2.2), before the motion
    Changes optimised;   // (2.4), along with it
    Changes remeshed;    // (2.6), after it
    int legs = 0;        // into which the motion was cut
    bool redone = false; // whether 2.6 was taken back and done again, without passing the floor on its way
    int cells_touched = 0;
};

/// A mesh that follows its bodies, by the paper's step (1, 2.1-2.6): a reference mesh that is not touched
/// before a step has been accepted, and a current mesh on which the step is prepared.
///
///     moving.begin_step();                    // 2.1
///     moving.refine();                        // 2.2
///     moving.move_boundary(t + dt);           // 2.3
///     moving.optimise();                      // 2.4
///     if (moving.refusal()) moving.refuse();  // the reference is as it was; the next refine() knows where it stuck
///     else moving.accept();                   // 2.6
///
/// Between the question and accept() stands remesh() where a step may still be refused after it.
class MovingMesh {
public:
    /// `mesh` is the mesh of `domain` at time `t` [s].
    MovingMesh(Domain domain, Mesh mesh, double t, const AdaptOptions& options = {});

    [[nodiscard]] const Mesh& reference() const { return reference_; }
    [[nodiscard]] double time() const { return time_; }  ///< of the reference [s]
    [[nodiscard]] const StepStatistics& statistics() const { return statistics_; }

    /// The current mesh becomes a copy of the reference.
    void begin_step();
    /// After a refusal, remeshes where the motion got stuck; else does nothing. The solution is to be carried
    /// from reference() to before() at the vertices that are returned.
    const Changes& refine();
    /// Moves bodies to where they are at `t` [s], and their surroundings with them.
    void move_boundary(double t);
    /// Optimises the places of the surroundings' vertices; if a cell would be turned over on the way, goes it again in
    /// as many legs as it takes for all cells to stay valid.
    void optimise();

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
    /// The current mesh, remeshed unless it is, becomes the reference. The solution is to be carried from before()
    /// to reference() at the vertices that are returned.
    const Changes& accept();

private:
    [[nodiscard]] std::optional<Refusal> what_limits() const;
    [[nodiscard]] Refusal refused(Tet cell, const std::string& fault, double advised_dt) const;
    [[nodiscard]] std::optional<Refusal> narrow_gap() const;
    [[nodiscard]] std::optional<Refusal> worst_cell() const;
    [[nodiscard]] std::optional<Refusal> squeezed_prism() const;
    [[nodiscard]] std::optional<Refusal> turned_too_far() const;
    [[nodiscard]] std::optional<Refusal> turned_on_its_way() const;
    Changes remesh(const AdaptOptions& options);  // the current mesh
    void move_in_legs();
    void note_turned_over(double reached);
    bool optimise_at(double t);
    [[nodiscard]] std::vector<Tet> cells_above(double ratio) const;
    void note_moved();
    void note_replaced(const Changes& changes);

    Domain domain_;
    AdaptOptions options_;
    std::vector<std::vector<Vertex>> bodies_;  // the vertices of each body's cells
    std::vector<Tet> at_inner_shells_;         // cells of bodies that do not move rigidly: at the shells of inner layers
    Mesh reference_, before_, current_;
    double time_, target_time_;
    Zone zone_;                      // what the step moves
    MoveReport way_;                 // from before() to current()
    std::vector<Tet> refined_;       // cells that are new in the step
    IndexSet<Tet> replaced_;         // in which slots the three meshes may differ,
    std::vector<Vertex> moved_;      // and which vertices may have other places
    std::vector<Vec3> trouble_;      // where the attempts refused since the last accepted step got stuck
    std::optional<Refusal> stuck_;   // the motion did not arrive
    bool dropped_ = false;           // the other two meshes may differ from the reference anywhere
    bool remeshed_ = false;          // the current mesh is
    StepStatistics statistics_;
};

}  // namespace kropla
