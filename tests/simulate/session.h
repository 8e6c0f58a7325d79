#pragma once

#include <kropla/simulate/petsc.h>

namespace kropla {

/// PETSc, from the first call to the end of the test program.
const PetscSession& petsc();

}  // namespace kropla
