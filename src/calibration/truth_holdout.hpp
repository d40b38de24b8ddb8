// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Legs of recordings with truth, and those of them that are held out (trussmap/calibrate.hpp). The
// start's heading of a predicted leg is a mean over a second, for one row's noise would hide what a
// leg is off by.
#pragma once

#include "trussmap/calibrate.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap::calibration {

struct TruthLeg {
  int session = 0;
  std::size_t from = 0;  ///< truth row
  std::size_t to = 0;    ///< truth row
  bool held_out = false;
};

/// `share` of the legs, in [0, 1), is held out; `leg` in m.
[[nodiscard]] std::vector<TruthLeg> truth_legs(const std::vector<DrivenRecording>& recordings,
                                               double share, double leg = 1.0);

/// What is left to fit: each unbroken run of legs that are not held out, as a recording.
struct TrainingSegments {
  std::vector<DrivenRecording> recordings;
  std::vector<int> sessions;  ///< which recording each was cut from
};
[[nodiscard]] TrainingSegments without_held_out(const std::vector<DrivenRecording>& recordings,
                                                const std::vector<TruthLeg>& legs);

/// Of the held-out legs, with the model's effects taken out of the rows.
[[nodiscard]] ArrivalErrors arrival_errors(const std::vector<DrivenRecording>& recordings,
                                           const std::vector<TruthLeg>& legs, const Model& model);

}  // namespace trussmap::calibration
