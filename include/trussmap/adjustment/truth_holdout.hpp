// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Legs of recordings with truth, some of them kept aside to judge a model by.
//
// A leg ends at the first truth row that lies `leg` metres of driven path after its start. Legs are
// counted on through all sessions and taken in blocks of five; which blocks are held out depends on
// their number alone, spread evenly. A held-out leg is predicted from the truth at its start.
#pragma once

#include "trussmap/effects/model.hpp"
#include "trussmap/recording/recording.hpp"

#include <vector>

namespace trussmap {

struct TruthLeg {
  int session = 0;
  std::size_t from = 0;  ///< truth row
  std::size_t to = 0;    ///< truth row
  bool held_out = false;
};

/// `share` of the legs, in [0, 1), is held out; `leg` in m.
[[nodiscard]] std::vector<TruthLeg> truth_legs(const std::vector<Recording>& recordings,
                                               double share, double leg = 1.0);

/// What is left to fit: each unbroken stretch of legs that are not held out, as a recording.
[[nodiscard]] std::vector<Recording> without_held_out(const std::vector<Recording>& recordings,
                                                      const std::vector<TruthLeg>& legs);

struct ArrivalErrors {
  int legs = 0;
  double rms = 0.0;  ///< of the distance between predicted and true end, m; 0 without legs
};

/// Of the held-out legs, with the model's effects taken out of the rows.
[[nodiscard]] ArrivalErrors arrival_errors(const std::vector<Recording>& recordings,
                                           const std::vector<TruthLeg>& legs, const Model& model);

}  // namespace trussmap
