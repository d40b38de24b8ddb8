// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What effects do to a simulated robot. The true motion is given; the sensors are found by turning
// the physics round: which wheel travels, readings and times would the model with its effects take
// for this motion?
//
//   travel, left, right, wheels, difference, turn, drift, advance, rotate
//           the two equations of a row (forward travel, rotation), solved for the two wheels
//   creep   the robot slips sideways by g of its forward travel: the path is laid so that it still
//           arrives; the wheels show the forward part
//   lever   the robot stops with its sensor on the landmark: the axle is beside it
//   compass, range, range_scale, bearing, delay
//           added to the reading or the time stamp
//
// No formula here is one of an estimator's. Several effects act on what the wheels show side by
// side, not one on the other's result.
#pragma once

#include "simulation/motion_variables.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"
#include "trussmap/simulation.hpp"

#include <map>
#include <vector>

namespace trussmap {

/// g of each channel that something acts on, one value per row.
using ChannelGains = std::map<Channel, std::vector<double>>;

/// Sums of coefficient x shape, on the middles of the rows or, for compass, range and bearing, at
/// their ends. Effects without coefficients count as 0. Throws std::invalid_argument, naming the
/// effect.
[[nodiscard]] ChannelGains channel_gains(const std::vector<Effect>& effects,
                                         const MotionVariables& variables);

struct WheelTravels {
  double left = 0.0;   ///< m
  double right = 0.0;  ///< m
};

/// What each row's wheels show without noise. Throws std::invalid_argument where effects leave no
/// travels that would give the motion (a gain of -1).
[[nodiscard]] std::vector<WheelTravels> wheels_under(const TrueMotion& motion,
                                                     const ChannelGains& gains, double wheelbase);

/// A motion and all that acts on it.
struct MotionUnderEffects {
  TrueMotion motion;
  ChannelGains gains;
};

/// Lays the path along the walk and finds the gains, the path again where it depends on them
/// (creep, lever), the gains again where they depend on what is recorded (Rates::as_recorded).
/// Throws std::invalid_argument as lay_path and channel_gains do.
[[nodiscard]] MotionUnderEffects lay_path_under(const Mesh& mesh, const std::vector<int>& walk,
                                                const DrivingStyle& style, double wheelbase,
                                                const std::vector<Effect>& effects, Rates rates,
                                                std::uint64_t seed);

}  // namespace trussmap
