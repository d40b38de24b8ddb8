// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where something else than the wheels has the robot, and the pieces of a drive over which the two
// are compared.
//
//   stops    on surveyed landmarks
//   fixes    as recorded
//   ranges   to three surveyed landmarks and more within two seconds: place and velocity that
//            explain them best
//   truth    its positions
#pragma once

#include "trussmap/planar.hpp"
#include "trussmap/robot.hpp"

#include <string>
#include <vector>

namespace trussmap::check {

struct TimedPlace {
  double t = 0.0;  ///< s
  Vector2 at = Vector2::Zero();
};

/// Places of one kind, in order of time.
struct PlacesSeen {
  const char* name = "";  ///< "the fixes": whose places they are, as a finding says
  std::vector<TimedPlace> all = {};
  double noise = 0.0;  ///< m, as nearly as they tell themselves
};

[[nodiscard]] PlacesSeen places_by_stops(const DrivenRecording& recording);
[[nodiscard]] PlacesSeen places_by_fixes(const DrivenRecording& recording);
[[nodiscard]] PlacesSeen places_by_ranges(const DrivenRecording& recording);
[[nodiscard]] PlacesSeen places_by_truth(const DrivenRecording& recording);

}  // namespace trussmap::check
