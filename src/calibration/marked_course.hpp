// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What was driven from one place that something tells of to the next: merged into steps that hardly
// turn, so that other constants are tried on them quickly.
#pragma once

#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::calibration {

/// Where something tells of the robot's place.
struct Mark {
  std::size_t step = 0;              ///< so many steps have been driven
  Vector2 offset = Vector2::Zero();  ///< m, robot frame
  std::string landmark = {};
  std::optional<Vector2> known = {};  ///< m, map frame
};

struct Chord {
  std::size_t from = 0, to = 0;  ///< marks
  double length = 0.0;           ///< m, as known; of a return the path as driven
};

/// A session's rows, merged from mark to mark into what hardly turns.
struct Course {
  std::vector<BodyMotion> steps;
  std::vector<Mark> marks;
  std::vector<Chord> chords;
  std::vector<Chord> returns;
};

/// A few hundred places at most, evenly in time; `robot`: where its sensors sit.
[[nodiscard]] Course course_of(const DrivenRecording& recording, const Robot& robot);

}  // namespace trussmap::calibration
