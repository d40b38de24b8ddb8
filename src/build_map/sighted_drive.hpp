// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One recording under a model: where the robot drives, and where its landmarks are seen.
#pragma once

#include "fit/cleared_recording.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <limits>

namespace trussmap {

class SightedDrive {
 public:
  /// Keeps references to both.
  SightedDrive(const ClearedRecording& cleared, const Model& model)
      : cleared_(cleared), model_(model) {}

  [[nodiscard]] const Recording& recording() const { return cleared_.recording; }
  [[nodiscard]] const Drive& drive() const { return recording().drive; }

  /// Heading at time `t` from the compass, 0 without one.
  [[nodiscard]] InitialHeading heading_at(double t) const {
    return initial_heading(drive(), t, model_.robot, model_.noise);
  }

  /// As dead_reckon.
  [[nodiscard]] PoseEstimate reckon(
      const PoseEstimate& start, double from, double to,
      double readings_used_until = -std::numeric_limits<double>::infinity()) const {
    return dead_reckon(start, drive(), from, to, model_.robot, model_.noise, readings_used_until,
                       cleared_.slip);
  }

  /// Where a sighting of this recording puts its landmark. `bearing_slack` adds to the bearing's
  /// noise, rad.
  [[nodiscard]] LandmarkOffset offset_of(const Sighting& sighting,
                                         double bearing_slack = 0.0) const;

 private:
  const ClearedRecording& cleared_;
  const Model& model_;
};

}  // namespace trussmap
