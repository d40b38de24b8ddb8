// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where sensors sit, for a calibration: a model's stated places (Robot::mounted) are where it
// starts, and what it finds of them goes back there.
//
//   effects lever, antenna, truth_heading, scanner ...   constant ones: added to the stated places
//   scanner, at a start   by loops and the wheels alone, in closed form (Censi, Franchi, Marchionni
//                           & Oriolo 2013). A loop (m, phi) in the scanner's axes, seen by a robot
//                           that moved by (d, phi) with its scanner at s, turned by y:
//
//                               c R(y) m - (R(phi) - I) s = d
//
//                           is linear in (c cos y, c sin y) and s; c takes up what the wheels have
//                           too large
//   sensor, at a start    the same by two sightings z, z' of a landmark: m = z - R(phi) z'
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/robot.hpp"

#include <optional>
#include <string_view>
#include <vector>

namespace trussmap::calibration {

/// The model with its constant effects of places in [robot]; they stay, with 0.
[[nodiscard]] Model with_places_in_robot(Model model);

/// The place that a CalibratedMounting is of, by its name: antenna, sensor, tracked or scanner.
using MountingPlace = std::optional<Mounting> Mountings::*;
[[nodiscard]] MountingPlace place_named(std::string_view of);
/// As stated; the axle's centre where nothing is.
[[nodiscard]] Mounting stated_place(const Mountings& stated, std::string_view of);

/// Where nothing is stated of the scanner or the sensor, what loops, and landmarks that are seen
/// again by range and bearing or stood on, say of it; as stated where they tell no place.
[[nodiscard]] Mountings started_places(const std::vector<DrivenRecording>& recordings,
                                       const Robot& robot);

}  // namespace trussmap::calibration
