// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a process of variance 1 does over a lag, and over the rows of a segment.
#pragma once

#include "estimation/segment_motion.hpp"
#include "trussmap/model.hpp"

#include <vector>

namespace trussmap::estimation {

/// Correlated in it, or walking: else, where a process is either, in time.
[[nodiscard]] bool goes_with_distance(ProcessKind process);
/// Neither correlated nor constant: from 0 at a recording's start.
[[nodiscard]] bool is_walk(ProcessKind process);
/// What a unit process does over a lag, given where it was: z' = keep z + eta, and its mean over
/// the lag, mean_keep z + nu.
struct Lag {
  double keep = 1.0;
  double mean_keep = 1.0;
  double end = 0.0;   ///< var eta
  double both = 0.0;  ///< cov(eta, nu)
  double mean = 0.0;  ///< var nu
};

/// A lag in s or m, as the process goes.
[[nodiscard]] Lag lag_of(ProcessKind process, double lag, double length);

/// What a unit process adds to the four numbers of some rows in which it acts by c: K_from and
/// K_to as above before they are told apart, e = by_start z_start + u.
struct ProcessMoments {
  Vector4 by_start = Vector4::Zero();
  double keep = 1.0;             ///< z_end = keep z_start + w
  Matrix4 uu = Matrix4::Zero();  ///< cov u
  Vector4 uw = Vector4::Zero();  ///< cov(u, w)
  double ww = 0.0;               ///< var w
};

/// Of a chain. `at_ends`: it acts at the rows' ends (a reading), else by its means over the rows.
[[nodiscard]] ProcessMoments process_moments(const std::vector<SegmentRow>& rows,
                                             const std::vector<Vector4>& c, ProcessKind process,
                                             double length, bool at_ends);

}  // namespace trussmap::estimation
