#pragma once

#include <kropla/simulate/petsc.h>

namespace kropla {

/// Interrupted on all ranks at once: none waits for another.
struct AllInterrupted : Interrupted { using Interrupted::Interrupted; };

/// Where all ranks meet: says whether the watch of any of them says stop; if so, all of them say it from here on.
/// All ranks ask together.
[[nodiscard]] bool stop_anywhere(const Ranks& ranks);

/// The same; throws AllInterrupted if so.
void heed(const Ranks& ranks);

/// For a rank that will not come where the others meet next, as an error or its own watch has ended its work: meets
/// them once more, and they throw AllInterrupted there, or are leaving too.
void leave(const Ranks& ranks);

/// Has the solver ask stop_anywhere on its way: it ends, not converged, if so. What it asks each iteration already
/// (its convergence test) is asked first. The watch is to outlive it.
void listen_on_the_way(KSP solver, const Ranks& ranks);

}  // namespace kropla
