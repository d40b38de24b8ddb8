// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far the motion by a drive's columns is from what each other sensor says of it.
//
//   misfit   mean over samples of |by columns - by the sensor|/the larger of the two, at most 1:
//            0 agrees, 1 has nothing to do with it
//
//   other_wheels  readings beyond what the body's motion makes of them, where there are more
//                 columns than motions
//   compass, gyro turns of half a radian
//   truth         turns, and ways of half a metre in the robot's axes
//   views         landmarks seen again, as views_and_wheels.cpp
//   survey, fixes corners from stop to stop, from fix to fix
//
// Each as recorded, and with the mistake of the sensor's own (unit, sign, axes) that suits it best:
// where even that does not agree, it is the columns.
#pragma once

#include "check/track.hpp"
#include "trussmap/recording.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace trussmap::check {

enum class Witness { other_wheels, compass, gyro, truth, views, survey, fixes };
/// "the compass", ...
[[nodiscard]] std::string_view name_of(Witness witness);

struct Misfit {
  Witness witness = Witness::compass;
  double stated = 0.0;
  double best = 0.0;  ///< with a mistake of the sensor's own
};

/// Where and with what they are taken.
struct MisfitFrame {
  double bearing_unit = 1.0;  ///< rad per unit of bearings
  double from = 0.0;          ///< s
  double to = 0.0;            ///< s
};

/// Of the witnesses that tell enough.
[[nodiscard]] std::vector<Misfit> misfits(const DrivenRecording& recording, const MotionRows& drive,
                                          const MisfitFrame& frame);
/// The same as recorded alone; nothing where one exceeds the limit.
[[nodiscard]] std::optional<std::vector<Misfit>> misfits_below(double limit,
                                                               const DrivenRecording& recording,
                                                               const MotionRows& drive,
                                                               const MisfitFrame& frame);

}  // namespace trussmap::check
