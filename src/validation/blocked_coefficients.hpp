// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Blocked cross-validation of a fit's coefficients: what they would be without what was seen during
// one block of each drive. Blocks, not single sightings, because neighbours err alike.
//
//   session    |--- 0 ---|--- 1 ---|--- 2 ---|--- 3 ---|--- 4 ---|   from first to last sighting
//
// A step of Gauss-Newton from the fit: the rows of the block's sightings and truth weigh nothing,
// those of the drive stay. A coefficient that only the block tells of goes back to 0.
#pragma once

#include "fit/fit_state.hpp"

#include <vector>

namespace trussmap::validation {

class TimeBlocks {
 public:
  TimeBlocks(const estimation::RecordingProblem& problem, int count);

  [[nodiscard]] int count() const { return count_; }
  /// The block of an instant; the first and the last one reach on.
  [[nodiscard]] int at(int session, double t) const;

 private:
  std::vector<TimeSpan> spans_;  ///< per session
  int count_;
};

/// Per block, offsets_of(fit) with the coefficients that it has without the block.
[[nodiscard]] std::vector<Eigen::VectorXd> offsets_without_blocks(const fitting::FitState& fit,
                                                                  const TimeBlocks& blocks);

}  // namespace trussmap::validation
