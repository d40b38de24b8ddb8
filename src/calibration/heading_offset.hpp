// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How the truth's headings lie to the direction of travel, before anything is fitted.
//
//   a     direction in which the wheels say the robot went between two truth rows, robot axes
//   b     direction of the line between the two rows, truth's axes
//   h     truth's heading at the first of them
//
// h + a - b is 0 where the truth's heading is that of the robot, and a constant where the truth's
// axes are turned on the robot. Its mean on the circle, each pair of rows weighted by their
// distance, is the offset; the length of the mean vector says how well the pairs agree. With
// headings counted clockwise -h + a - b agrees and h + a - b does not.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <string>
#include <vector>

namespace trussmap::calibration {

struct HeadingOffset {
  double angle = 0.0;      ///< rad: the truth's heading less the robot's
  double agreement = 0.0;  ///< length of the mean vector, 0 to 1
  bool clockwise = false;  ///< headings agree better if their sign is changed
};

/// By the nominal wheelbase. An agreement of 0 where no two truth rows lie far enough apart.
[[nodiscard]] HeadingOffset heading_offset(const std::vector<DrivenRecording>& recordings);

/// What is wrong with the truth's heading and how to mend it, one sentence; empty where nothing
/// stands out.
[[nodiscard]] std::string describe(const HeadingOffset& offset);

}  // namespace trussmap::calibration
