// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings of two wheels as motion of a robot, for what takes no recording as it is read.
#pragma once

#include "trussmap/robot.hpp"

#include <vector>

namespace trussmap::testing {

inline DrivenRecording driven(const Recording& recording) {
  return with_wheels(recording, Robot());
}
inline std::vector<DrivenRecording> driven(const std::vector<Recording>& recordings) {
  return with_wheels(recordings, Robot());
}

}  // namespace trussmap::testing
