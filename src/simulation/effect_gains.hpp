// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What effects do to a simulated robot. The true motion is given; the sensors are found by turning
// the physics round: which wheel travels, readings and times would the model with its effects take
// for this motion?
//
//   travel, left, right, wheels, difference, turn, drift, advance, rotate, sideways, wheel1 ...,
//   steer, steer_gain
//           what the wheels then show (wheel_readings.hpp)
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
#include "simulation/wheel_readings.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"
#include "trussmap/simulation.hpp"

#include <vector>

namespace trussmap::simulation {

/// Sums of coefficient x shape, on the middles of the rows or, for compass, range and bearing, at
/// their ends. Effects without coefficients count as 0. Throws std::invalid_argument, naming the
/// effect.
[[nodiscard]] ChannelGains channel_gains(const std::vector<Effect>& effects,
                                         const MotionVariables& variables);

/// A motion and all that acts on it.
struct MotionUnderEffects {
  TrueMotion motion;
  ChannelGains gains;
};

/// Lays the path along the walk and finds the gains, the path again where it depends on them
/// (creep, lever), the gains again where they depend on what is recorded (Rates::as_recorded).
/// Throws std::invalid_argument as lay_path, channel_gains and readings_under do, and on an effect
/// that the robot's drive does not have.
[[nodiscard]] MotionUnderEffects lay_path_under(const Mesh& mesh, const std::vector<int>& walk,
                                                const DrivingStyle& style, const Robot& robot,
                                                const std::vector<Effect>& effects, Rates rates,
                                                std::uint64_t seed);

}  // namespace trussmap::simulation
