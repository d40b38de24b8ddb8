// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Legs of recordings with truth, some of them kept aside to judge a model by.
//
// A leg ends at the first truth row that lies `leg` metres of driven path after its start. Legs are
// counted on through all sessions and taken in blocks of five; which blocks are held out depends on
// their number alone, spread evenly. A held-out leg is predicted from its true start; the start's
// heading is the mean of what the truth rows of the last second say, brought there by the wheels,
// for one row's noise would hide what a leg is off by.
//
// Whole drives are judged too: dead reckoning from the first truth row's pose, as it stands, to the
// time of the last.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

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
struct TrainingSegments {
  std::vector<Recording> recordings;
  std::vector<int> sessions;  ///< which recording each was cut from
};
[[nodiscard]] TrainingSegments without_held_out(const std::vector<Recording>& recordings,
                                                const std::vector<TruthLeg>& legs);

struct ArrivalErrors {
  std::vector<double> distances;  ///< between predicted and true end, m, per held-out leg

  [[nodiscard]] int legs() const { return static_cast<int>(distances.size()); }
  /// m; 0 without legs.
  [[nodiscard]] double rms() const;
};

/// Of the held-out legs, with the model's effects taken out of the rows.
[[nodiscard]] ArrivalErrors arrival_errors(const std::vector<Recording>& recordings,
                                           const std::vector<TruthLeg>& legs, const Model& model);

/// Of one whole drive.
struct DriveError {
  double end = 0.0;      ///< m, between reckoned and true end
  double heading = 0.0;  ///< rad: reckoned less true change of heading from start to end
  double driven = 0.0;   ///< m, mean of the wheels' travels, each counted forwards: turns count too

  [[nodiscard]] double heading_per_metre() const { return driven > 0.0 ? heading / driven : 0.0; }
};

/// One per recording. Throws InputError where one has no two truth rows in its drive.
[[nodiscard]] std::vector<DriveError> drive_errors(const std::vector<Recording>& recordings,
                                                   const Model& model);

}  // namespace trussmap
