// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "distributed/truss_solver.hpp"

#include "trussmap/error.hpp"

#include <limits>

#include <fmt/format.h>

// Of OpenBLAS, where it is the BLAS in use: processes are the threads here.
extern "C" void openblas_set_num_threads(int threads) __attribute__((weak));

namespace trussmap::distributed {
namespace {

constexpr int kRounds = 4;  // of correction from the true residual

/// Options that the environment has not set.
void set_default(const char* name, const char* value) {
  PetscBool set = PETSC_FALSE;
  require_petsc(PetscOptionsHasName(nullptr, nullptr, name, &set), "an option of PETSc");
  if (set == PETSC_FALSE) {
    require_petsc(PetscOptionsSetValue(nullptr, name, value), "an option of PETSc");
  }
}

void use_multigrid(KSP solver, PC preconditioner) {
  require_petsc(KSPSetType(solver, KSPCG), "conjugate gradients");
  require_petsc(KSPSetNormType(solver, KSP_NORM_UNPRECONDITIONED), "conjugate gradients");
  require_petsc(PCSetType(preconditioner, PCGAMG), "multigrid");
  int processes = 1;
  require_mpi(MPI_Comm_size(PetscObjectComm(reinterpret_cast<PetscObject>(solver)), &processes),
              "ranks");
  // The other ways to form P'KP add what comes from other processes as it arrives. One process
  // knows no such way.
  if (processes > 1) set_default("-matptap_via", "allatonce");
  set_default("-pc_gamg_agg_nsmooths", "1");
  set_default("-pc_gamg_threshold", "0.0");
  set_default("-mg_levels_ksp_type", "chebyshev");
  set_default("-mg_levels_ksp_max_it", "2");
  set_default("-mg_levels_pc_type", "jacobi");
  set_default("-pc_gamg_esteig_ksp_type", "cg");
}

void use_mumps(KSP solver, PC preconditioner) {
  require_petsc(KSPSetType(solver, KSPPREONLY), "MUMPS");
  require_petsc(PCSetType(preconditioner, PCCHOLESKY), "MUMPS");
  require_petsc(PCFactorSetMatSolverType(preconditioner, MATSOLVERMUMPS), "MUMPS");
}

double norm(Vec v) {
  PetscReal value = 0.0;
  require_petsc(VecNorm(v, NORM_2, &value), "a norm");
  return value;
}

/// |f - K u| that rounding of K u alone can leave.
double rounding(Mat K, Vec u, Vec work) {
  require_petsc(MatGetDiagonal(K, work), "the matrix's diagonal");
  require_petsc(VecPointwiseMult(work, work, u), "the matrix's diagonal");
  constexpr double kTerms = 8.0;
  return kTerms * std::numeric_limits<double>::epsilon() * norm(work);
}

void require_no_failure(KSP solver, bool mumps) {
  KSPConvergedReason reason = KSP_CONVERGED_ITERATING;
  require_petsc(KSPGetConvergedReason(solver, &reason), "the solver");
  if (reason > 0 || reason == KSP_DIVERGED_ITS) return;
  const char* words = nullptr;
  require_petsc(KSPGetConvergedReasonString(solver, &words), "the solver");
  throw SolveError(fmt::format(
      "the equations cannot be solved ({}, {}): some landmark can still slide, its measurements "
      "hardly hold it",
      mumps ? "MUMPS" : "conjugate gradients", words));
}

double complexity_of(PC preconditioner) {
  PetscBool multigrid = PETSC_FALSE;
  require_petsc(
      PetscObjectTypeCompare(reinterpret_cast<PetscObject>(preconditioner), PCGAMG, &multigrid),
      "multigrid");
  if (multigrid == PETSC_FALSE) return 0.0;
  PetscReal grid = 0.0;
  PetscReal operators = 0.0;
  require_petsc(PCMGGetGridComplexity(preconditioner, &grid, &operators), "multigrid");
  return operators;
}

}  // namespace

Solution solve_equations(Mat K, Vec f, const DistributedOptions& options) {
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  const bool mumps = options.solver == DistributedOptions::Solver::mumps;
  Solution result;
  OwnedVector residual;
  OwnedVector step;
  for (OwnedVector* vector : {&result.u, &residual, &step}) {
    require_petsc(VecDuplicate(f, vector->place()), "memory");
  }
  OwnedSolver solver;
  require_petsc(KSPCreate(PetscObjectComm(reinterpret_cast<PetscObject>(K)), solver.place()),
                "the solver");
  require_petsc(KSPSetOperators(solver.get(), K, K), "the solver");
  PC preconditioner = nullptr;
  require_petsc(KSPGetPC(solver.get(), &preconditioner), "the solver");
  (mumps ? use_mumps : use_multigrid)(solver.get(), preconditioner);
  require_petsc(KSPSetFromOptions(solver.get()), "the solver");
  const double began = MPI_Wtime();
  require_petsc(KSPSetUp(solver.get()), mumps ? "the factor (MUMPS)" : "multigrid");
  const double ready = MPI_Wtime();
  result.seconds_preparing = ready - began;

  const double size = norm(f);
  double left = size;
  require_petsc(VecSet(result.u.get(), 0.0), "the solution");
  require_petsc(VecCopy(f, residual.get()), "the residual");
  double enough = options.tolerance * size;
  for (int round = 0; round < kRounds && left > enough; ++round) {
    // A correction needs no more digits than are missing.
    require_petsc(KSPSetTolerances(solver.get(), 0.5 * enough / left, 0.0, PETSC_DEFAULT,
                                   options.max_iterations - result.iterations),
                  "the solver");
    require_petsc(KSPSolve(solver.get(), residual.get(), step.get()), "the solver");
    require_no_failure(solver.get(), mumps);
    PetscInt iterations = 0;
    require_petsc(KSPGetIterationNumber(solver.get(), &iterations), "the solver");
    result.iterations += static_cast<int>(iterations);
    require_petsc(VecAXPY(result.u.get(), 1.0, step.get()), "the solution");
    require_petsc(MatMult(K, result.u.get(), residual.get()), "the residual");
    require_petsc(VecAYPX(residual.get(), -1.0, f), "the residual");
    left = norm(residual.get());
    enough = std::max(options.tolerance * size, rounding(K, result.u.get(), step.get()));
    if (result.iterations >= options.max_iterations) break;
  }
  result.converged = left <= enough;
  result.residual = size > 0.0 ? left / size : 0.0;
  result.seconds_solving = MPI_Wtime() - ready;
  if (!mumps) result.complexity = complexity_of(preconditioner);
  return result;
}

}  // namespace trussmap::distributed
