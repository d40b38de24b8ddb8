// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The parts of the speed benchmark; each prints what it measures, and its "must hold" lines.
#pragma once

#include <filesystem>
#include <vector>

namespace trussmap::bench {

/// Square grids of n x n landmarks, every route measured five times: the whole way from raw
/// measurements to positions, and all covariances.
void grid_part(const std::vector<int>& sides, int repetitions, bool ceres);

/// On the same grids: all covariances beside a repeated factorisation, in turn; operations of both,
/// counted over the fronts, and the speed of the kernels and of the memory.
void covariances_part(const std::vector<int>& sides, int repetitions);

/// Refinements with eta = 50 at random places in maps of these many landmarks.
void refinement_part(const std::vector<int>& landmarks, int corrections);

/// A grid toured once, each route driven once, with the exact increment after every leg.
void increments_part(int side);

/// Pose graphs in this folder, against Ceres from the file's own start.
void nonlinear_part(const std::filesystem::path& folder, int repetitions);

/// Reading a recording of this many rows against a plain strtod loop over the same file.
void input_part(int rows, int repetitions);

}  // namespace trussmap::bench
