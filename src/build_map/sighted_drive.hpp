// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One recording under a model: where the robot drives, and where its landmarks are seen.
#pragma once

#include "fit/cleared_recording.hpp"
#include "trussmap/dead_reckoning.hpp"

#include <limits>
#include <vector>

namespace trussmap::map_building {

/// What the best fit of everything says of one session, per sighting of its cleared recording.
struct SessionGuide {
  std::vector<double> headings;  ///< rad, map frame: of the robot at that instant
  std::vector<bool> left_out;
  std::vector<bool> yaw_left_out;
};

class SightedDrive {
 public:
  /// Keeps references to all.
  SightedDrive(const fitting::ClearedRecording& cleared, const Model& model,
               const SessionGuide& guide)
      : cleared_(cleared), model_(model), guide_(guide) {}

  [[nodiscard]] const DrivenRecording& recording() const { return cleared_.recording; }
  [[nodiscard]] const MotionRows& drive() const { return recording().drive; }

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

  /// Where a sighting of this recording puts its landmark.
  [[nodiscard]] LandmarkOffset offset_of(const Sighting& sighting) const;

  [[nodiscard]] bool is_left_out(const Sighting& sighting) const {
    return guide_.left_out[place_of(sighting)];
  }
  [[nodiscard]] double guided_heading(const Sighting& sighting) const {
    return guide_.headings[place_of(sighting)];
  }
  /// The sighting's yaw, rad; NaN where it has none or was left out.
  [[nodiscard]] double yaw_of(const Sighting& sighting) const {
    return guide_.yaw_left_out[place_of(sighting)] ? kAbsent : sighting.yaw;
  }
  [[nodiscard]] double yaw_sd() const { return model_.noise.yaw; }

 private:
  [[nodiscard]] std::size_t place_of(const Sighting& sighting) const {
    return static_cast<std::size_t>(&sighting - recording().sightings.data());
  }

  const fitting::ClearedRecording& cleared_;
  const Model& model_;
  const SessionGuide& guide_;
};

}  // namespace trussmap::map_building
