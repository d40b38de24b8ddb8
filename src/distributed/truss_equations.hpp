// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The equations K u = f of a distributed truss, for PETSc: K in rows of this process's landmarks,
// two unknowns each.
//
// What is held keeps two equations of its own, k u = 0 with k the size of its bars, and has no
// couplings: K stays symmetric and positive definite. Bars between the same landmarks are added in
// the order of the file, on every number of processes.
#pragma once

#include "distributed/petsc_objects.hpp"
#include "distributed/truss_share.hpp"

namespace trussmap::distributed {

struct TrussEquations {
  OwnedMatrix K;
  OwnedVector f;
};

[[nodiscard]] TrussEquations make_equations(const Communicator& all, const Placing& placing,
                                            const std::vector<ShareBar>& bars);

/// Tells multigrid what a truss hardly resists: the rigid-body modes.
void tell_rigid_body_modes(const Communicator& all, const Placing& placing, Mat K);

}  // namespace trussmap::distributed
