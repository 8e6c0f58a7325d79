#include "session.h"

#include <gtest/gtest.h>

#include <memory>

namespace kropla {
namespace {

std::unique_ptr<PetscSession> session;

class Petsc : public testing::Environment {
    void TearDown() override { session.reset(); }
};

[[maybe_unused]] const auto* const environment = testing::AddGlobalTestEnvironment(new Petsc);

}  // namespace

const PetscSession& petsc() {
    if (!session) session = std::make_unique<PetscSession>();
    return *session;
}

}  // namespace kropla
