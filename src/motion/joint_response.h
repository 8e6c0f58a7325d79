#pragma once

#include "motion/rigid_motion.h"
#include <kropla/domain/domain.h>

#include <cstddef>
#include <deque>
#include <utility>
#include <vector>

namespace kropla {

/// The step of each body that is free, by its number in the domain.
using FreeSteps = std::deque<std::pair<std::size_t, RigidStep>>;

// How the forces of the flow on free bodies depend on the rates of them all. Of bodies that are near each other the one
// that is pushed takes the other along; if each learnt from its own rate alone (RigidStep::improve), it would take that for
// its own doing, and rounds would be many. By Broyden's method for matrices with blocks of zeros:
//   [Schubert 1970] Modification of a quasi-Newton method for nonlinear equations with a sparse Jacobian. Math. Comp. 24.
// A body's own block goes on with it to the next step; blocks between bodies begin with zero in each.

class JointResponse {
public:
    /// Bodies are near if less than the smaller one's largest radius is between balls around them.
    JointResponse(const Domain& domain, const FreeSteps& bodies);

    /// After the flow was taken: learns from what it did since `remember`.
    void learn(FreeSteps& bodies);
    /// Before the bodies go on with other rates and leaps.
    void remember(const FreeSteps& bodies, const std::vector<SixVector>& rates, const std::vector<SixVector>& leaps);

    /// What a change of the rates takes of all equations [N], [N m]: inertia, and with `of_flow` the response.
    [[nodiscard]] std::vector<SixVector> taken(const FreeSteps& bodies, const std::vector<SixVector>& change, bool of_flow) const;
    /// The change that takes that.
    [[nodiscard]] std::vector<SixVector> solved_for(const FreeSteps& bodies, const std::vector<SixVector>& wrenches,
                                                    bool of_flow) const;

private:
    [[nodiscard]] SixMatrix block(const FreeSteps& bodies, std::size_t row, std::size_t column, bool of_flow) const;

    struct Near {
        std::size_t other;
        SixMatrix response = {};  // of the body to the other's rate
    };
    std::vector<std::vector<Near>> near_;         // per body
    std::vector<std::vector<std::size_t>> groups_;  // of bodies that are near each other, by and by
    std::vector<SixVector> last_rates_, last_left_;  // tried before; empty: nothing
    std::vector<bool> tells_;                        // per body: it went evenly, so that there is something to learn from
};

}  // namespace kropla
