// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Where to start from when a drive's constants are wrong by a factor: a track of outer wheels for
// inner ones, a diameter for a radius, a wheel of another size. Least squares from the stated
// constants lose their way then, for the map of the start is twisted. Figures that no start can
// spoil are asked instead:
//
//   turns     of compass, gyro or truth beside those of the wheels: a straight line, by least
//             absolute residuals
//   chords    between places that a survey, fixes or truth know, a few at a time, beside those of
//             dead reckoning: their ratios are all the same
//   returns   to a landmark: how far dead reckoning misses it, as a share of how far away it was;
//             where it was seen from afar, with the factor of the way that the sightings have it
//
// Chords and returns are tried over a grid of factors of turning (1/5 to 5) and, of two wheels, of
// right wheel over left (1/5 to 5); of a robot that steers, of the steering's offset (0.36 rad).
#pragma once

#include "estimation/recording_problem.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <optional>
#include <vector>

namespace trussmap::calibration {

/// g of the channels of effects, with the shape 1.
struct GrossStart {
  double turn = 0.0;
  double difference = 0.0;                      ///< of two wheels; else 0
  double steer = 0.0;                           ///< rad; of a robot that steers, else 0
  std::optional<double> travel = std::nullopt;  ///< where chords or returns tell it
};

/// The most promising first, a handful at most; none where the stated constants are as good. The
/// drives' wheels are taken in (with_wheels). `options`: what of the recordings is used.
[[nodiscard]] std::vector<GrossStart> gross_starts(const std::vector<DrivenRecording>& recordings,
                                                   const Robot& robot,
                                                   const estimation::ProblemOptions& options = {});

}  // namespace trussmap::calibration
