// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/petsc_objects.hpp"

#include "trussmap/error.hpp"

#include <fmt/format.h>

namespace trussmap::distributed {
namespace {

/// Says nothing: the exception does.
PetscErrorCode stay_silent(MPI_Comm /*comm*/, int /*line*/, const char* /*function*/,
                           const char* /*file*/, PetscErrorCode error, PetscErrorType /*type*/,
                           const char* /*message*/, void* /*context*/) {
  return error;
}

}  // namespace

void require_petsc(PetscErrorCode error, const char* what) {
  if (error == 0) return;
  const char* text = nullptr;
  static_cast<void>(PetscErrorMessage(error, &text, nullptr));
  throw SolveError(fmt::format("{} failed: PETSc error {}{}{}", what, static_cast<int>(error),
                               text != nullptr ? ", " : "", text != nullptr ? text : ""));
}

PetscSession::PetscSession() {
  require_petsc(PetscInitializeNoArguments(), "the start of PETSc");
  require_petsc(PetscPushErrorHandler(stay_silent, nullptr), "the start of PETSc");
  // What comes from other processes is added in one order, not as it arrives.
  for (const char* option : {"-matstash_legacy", "-matstash_reproduce"}) {
    require_petsc(PetscOptionsSetValue(nullptr, option, nullptr), "the start of PETSc");
  }
  require_petsc(PetscPopSignalHandler(), "the start of PETSc");
}

PetscSession::~PetscSession() {
  static_cast<void>(PetscFinalize());
}

}  // namespace trussmap::distributed
