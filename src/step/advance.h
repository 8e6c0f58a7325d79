#pragma once

#include <kropla/adapt/attempt.h>
#include <kropla/step/fields.h>
#include <kropla/step/stuck.h>

#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace kropla {

/// A step as a solver sees it: one connectivity, two sets of places. The fields hold what they were at its beginning.
struct StepToSolve {
    const Mesh& before;   // at `time`
    const Mesh& current;  // at `time` + `dt`
    double time, dt;      // [s]
    int round;            // 1; 2, 3, ... after the boundary went elsewhere
};

/// What a solver says of a step.
struct Solved {};  ///< the fields hold what they are at the end of the step
struct NotSolved { ///< it did not converge, or dt is too large for it
    std::string why;
    double advised_dt = 0;  // [s] that would do; 0: none is known
};
struct BodiesMoved {  ///< these bodies really went there: the mesh is to follow them, and to be solved on again
    std::vector<BodyPlace> places;         // of those that move rigidly
    std::vector<BodyCourse> courses = {};  // of those that deform
};
using Answer = std::variant<Solved, NotSolved, BodiesMoved>;
/// May throw: then the step did not happen. Empty: nothing is solved for.
using Solve = std::function<Answer(const StepToSolve&)>;

/// Something that is looked at around each transfer, as the content of a conserved quantity.
using Content = std::function<double(const Mesh&)>;

struct AdvanceOptions {
    double least_dt = 0;     // [s]: if less would be left of dt, the step cannot be done; 0: a thousandth of dt
    int rounds = 20;         // of a solver that says where bodies went
    /// Where bodies of which the solver says so are expected at `end` [s]: the first round begins with that.
    /// `before` is the mesh of the step at its begin, on which the fields are then.
    std::function<BodiesMoved(const Mesh& before, double end)> expected = {};
    std::vector<Content> contents = {};
    /// Asked when all is done and can still be taken back, with the mesh that is to be the reference; may throw.
    std::function<void(const Mesh&)> last_look = {};
    const Watch* watch = nullptr;
};

/// What a content was around the transfers of the accepted attempt.
struct ContentReport {
    double before_transfer = 0;  // before the last one
    double after = 0;            // after it
    double by_transfer = 0;      // that all of them added
};

/// What an accepted step was and cost.
struct Advanced {
    double time = 0, dt = 0;  // [s] reached, and how far it went
    int attempts = 0;
    std::string refused;      // why the last refused attempt was, if one was
    Changes changes;          // of the mesh, at all stages of the accepted attempt
    int cells_touched = 0;                    // that the step looked at
    double touched_fraction = 0;              // [-] of all
    double kept_vertices = 0, kept_tets = 0;  // [-] of those there are now, those that were there before
    std::vector<TransferReport> transfer;     // per field, of all its transfers in the accepted attempt
    double transferred_fraction = 0;          // [-] of the cells that took part in the largest of them
    std::vector<ContentReport> contents;
    double mesh_seconds = 0, solve_seconds = 0, transfer_seconds = 0;  // all attempts
    double mesh_cpu_seconds = 0;              // of all threads
};

/// Takes mesh and fields one step on, by `dt` [s] or as much of it as can be done: the paper's 2.1 to 2.6.
///
/// An attempt that a tet stops is tried again, remeshed where it got stuck; then, as one that a gap, a prism, the solver or the
/// transfer refuses, with the dt that was advised, if that is between an eighth and a half of it, else with half. On any
/// exception mesh, fields and the caller's arrays are as they were, bit for bit.
///
/// Throws StuckError if what is left of dt is below `least_dt`; Interrupted if the watch says stop, before or within;
/// std::logic_error if dt is not positive, an array has not an item for each slot, or an attempt is under way; what
/// `project` throws for values that are not finite; and what `solve` throws.
[[nodiscard]] Advanced advance(MovingMesh& moving, Fields& fields, double dt, const Solve& solve,
                               const AdvanceOptions& options = {});

/// The dt to be tried after an accepted step, of which `tried` [s] was hoped for before a wanted time cut it: if it had
/// to be cut otherwise, its length, else twice as much. The caller has a largest one.
[[nodiscard]] double next_dt(const Advanced& done, double tried);

}  // namespace kropla
