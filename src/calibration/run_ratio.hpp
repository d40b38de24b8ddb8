// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One number by several runs, y = ratio x: least squares through the origin, and how sure it is.
//
//   stated       each run's variance of y is known: the error follows from it, and is as much wider
//                as the runs scatter more than that, where this is no chance (Birge 1932)
//   not stated   `variance` is in proportion: the runs' own scatter gives the error; one run has
//                none
#pragma once

#include "trussmap/umbmark.hpp"

#include <vector>

namespace trussmap::calibration {

inline constexpr double kStatedDof = 1e6;    ///< behind a standard error that was stated
inline constexpr double kSureOfRuns = 1e-3;  ///< p below which runs contradict each other

struct RunOfRatio {
  double x = 0.0;
  double y = 0.0;
  double variance = 1.0;  ///< of y
};

struct RunRatio {
  Estimate ratio;
  double scatter = 0.0;  ///< sqrt(chi^2 per degree of freedom); 0 of one run
  double p_value = 1.0;  ///< of a scatter as large; 1 where none was stated
};

/// One run or more; not all x are 0.
[[nodiscard]] RunRatio ratio_of(const std::vector<RunOfRatio>& runs, bool stated);

/// y = ratio x + c z.
struct RatioBeside {
  double ratio = 0.0;
  Estimate c;
};

/// `z`: one per run. None with fewer than four runs, or where x and z tell the same.
[[nodiscard]] std::optional<RatioBeside> ratio_beside(const std::vector<RunOfRatio>& runs,
                                                      bool stated, const std::vector<double>& z);

}  // namespace trussmap::calibration
