// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How a robot has to drive, and may drive, with its wheels.
//
//   two wheels, skid-steer   turns on the spot, drives ahead
//   rollers                  the same, and drives legs at an angle to ahead
//   tricycle                 turns in one arc with its wheel nearly across (0.17 rad off, so that
//                            forwards and backwards stay two things); drives some legs backwards
//   ackermann                goes to and fro on arcs of its tightest bend, each turning it further
//                            the same way; drives some legs backwards
//
//      <--.  2          A turn a in n arcs of about a/n, forwards (1, 3) and backwards (2). Each
//        / \  .         pair takes the robot about R (a/n)^2 to the inner side: the more arcs, the
//       /   \  `. 3     less room. A small turn is one arc. Arcs forwards are longer than those
//      1     `---       backwards: the mean speed over a while is never just 0.
#pragma once

#include "trussmap/model.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace trussmap::simulation {

struct DrivingManner {
  double turning_radius = 0.0;  ///< m, R, of the rear axle's middle; 0: turns on the spot
  double longest_arc = 0.0;     ///< rad of turn
  double backwards = 0.0;       ///< fraction of legs
  double aside = 0.0;           ///< rad: legs go up to so far to either side of ahead
  bool bends_by_way = false;    ///< legs bend evenly along their way, not in time
};

[[nodiscard]] DrivingManner manner_of(const Robot& robot);

/// n for a turn [rad].
[[nodiscard]] int arcs_of_turn(double turn, const DrivingManner& manner);

/// How many rows so long a time takes [s], one at least.
[[nodiscard]] int whole_rows(double seconds, double row_duration);

/// Of each arc, at so many rad/s; or as many as an earlier path has. None where nothing is turned.
[[nodiscard]] std::vector<int> rows_of_arcs(double turn, const std::vector<double>& rates,
                                            double row_duration, std::span<const int> earlier);

/// One row of a turn in arcs.
struct ArcRow {
  double way = 0.0;   ///< m, backwards below 0
  double turn = 0.0;  ///< rad
};

/// Of n arcs, how much each turns [rad].
[[nodiscard]] std::vector<double> turns_of_arcs(double turn, std::size_t arcs);

/// The arcs one after the other, each in so many rows (where it has none: no arc).
[[nodiscard]] std::vector<ArcRow> turning_arcs(double turn, double radius,
                                               const std::vector<int>& rows);

}  // namespace trussmap::simulation
