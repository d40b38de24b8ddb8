// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the wheels of any drive show of a true motion. The physics is turned round: which travels
// and which steering angle would the robot's nominal wheels, with the effects that act, take for
// it?
//
//   (f, s, a)   what the body does in a row: ahead, to the left [m], turn [rad]
//   J           3 columns: each wheel's own way when its place moves by f, s or a with the body
//   J+          its least squares inverse: what the wheels together say of f, s, a
//   D           1 + g of each wheel (wheel1 ..., wheels): its way per travel that is shown
//   T           g of travel, sideways and turn
//   m           what the wheels do together, D w = J m
//
//   rolling     m + T J+ w = (f - advance, s, a - rotate - drift dt),   w = D^-1 J m
//   steered     travel d at the angle b, to which steer, steer_gain add theirs: f and a go by d's
//               shares ahead and turning, (1 + g) of each. The angle comes from f : a
//
// Several effects act side by side on what the wheels show, not one on the other's result. At rest
// the steering stays as it was. A tricycle's wheel rolls backwards only where the robot drives so.
#pragma once

#include "simulation/motion_variables.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"
#include "trussmap/simulation.hpp"

#include <cstddef>
#include <map>
#include <vector>

namespace trussmap::simulation {

/// g of each channel that something acts on, one value per row.
using ChannelGains = std::map<Channel, std::vector<double>>;

/// The gain of a channel in a row; 0 where nothing acts on it.
[[nodiscard]] double gain(const ChannelGains& gains, Channel channel, std::size_t row);

struct ShownRow {
  std::vector<double> readings;  ///< m, of the steering rad, in the order of the robot's columns
  RowRates rates;                ///< by the readings alone, as if no effect acted
};

/// What each row's wheels show without noise. Throws std::invalid_argument where effects leave no
/// readings that would give the motion (a gain of -1).
[[nodiscard]] std::vector<ShownRow> readings_under(const TrueMotion& motion,
                                                   const ChannelGains& gains, const Robot& robot);

/// By how much more a row's readings show where the wheels misread its travel by one share and its
/// turning by another.
[[nodiscard]] std::vector<double> misreading_of(const ShownRow& row, double duration,
                                                double travel_share, double turn_share,
                                                const Robot& robot);

}  // namespace trussmap::simulation
