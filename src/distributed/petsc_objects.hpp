// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// PETSc's objects, owned; its errors as SolveError.
#pragma once

#include "distributed/communicator.hpp"

#include <petscksp.h>

namespace trussmap::distributed {

/// Throws SolveError unless a call of PETSc's has succeeded; `what` was it doing.
void require_petsc(PetscErrorCode error, const char* what);

/// PETSc, from here to the end of its life. PETSC_OPTIONS of the environment is obeyed.
class PetscSession {
 public:
  PetscSession();
  ~PetscSession();
  PetscSession(const PetscSession&) = delete;
  PetscSession& operator=(const PetscSession&) = delete;
};

/// One of PETSc's objects, destroyed in the end.
template <typename Object, PetscErrorCode (*kDestroy)(Object*)>
class Owned {
 public:
  Owned() = default;
  ~Owned() { static_cast<void>(kDestroy(&object_)); }
  Owned(Owned&& other) noexcept : object_(other.object_) { other.object_ = nullptr; }
  Owned& operator=(Owned&&) = delete;
  Owned(const Owned&) = delete;
  Owned& operator=(const Owned&) = delete;

  [[nodiscard]] Object get() const { return object_; }
  /// For the call that makes it.
  [[nodiscard]] Object* place() { return &object_; }

 private:
  Object object_ = nullptr;
};

using OwnedMatrix = Owned<Mat, MatDestroy>;
using OwnedVector = Owned<Vec, VecDestroy>;
using OwnedSolver = Owned<KSP, KSPDestroy>;
using OwnedNullSpace = Owned<MatNullSpace, MatNullSpaceDestroy>;

}  // namespace trussmap::distributed
