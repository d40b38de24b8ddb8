// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings of two wheels as motion of a robot, for what takes no recording as it is read.
#pragma once

#include "trussmap/robot.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace trussmap::testing {

inline DrivenRecording driven(const Recording& recording, const Robot& robot = Robot()) {
  return with_wheels(recording, robot);
}
inline std::vector<DrivenRecording> driven(const std::vector<Recording>& recordings) {
  return with_wheels(recordings, Robot());
}

/// One more row's travels of two wheels that are so far apart, m.
inline void add_travels(MotionRows& drive, double left, double right,
                        double wheelbase = Robot().wheelbase) {
  drive.pair.left.push_back(left);
  drive.pair.right.push_back(right);
  drive.forward.push_back((left + right) / 2.0);
  drive.turn.push_back((right - left) / wheelbase);
}

/// The motion anew, by travels that were changed.
inline void retake(MotionRows& drive, double wheelbase = Robot().wheelbase) {
  const WheelPair pair = std::exchange(drive.pair, {});
  drive.forward.clear();
  drive.turn.clear();
  for (std::size_t row = 0; row < pair.left.size(); ++row) {
    add_travels(drive, pair.left[row], pair.right[row], wheelbase);
  }
}

}  // namespace trussmap::testing
