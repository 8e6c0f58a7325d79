#pragma once

#include "simulate/petsc.h"

namespace kropla {

/// PETSc, as long as the test program runs.
const PetscSession& petsc();

}  // namespace kropla
