// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Steering effects, taken in exactly. With b the angle that is read in a row,
//
//   the wheel stands at   b' = b + sum of g over `steer` + b sum of g over `steer_gain`    rad
//   the wheels' places    sum of g over `wheel_left`, `steer_left` further left            m
//
// and the row is driven with these. A fit takes in what it believes so far and is linear about that
// (EffectPattern::reference); `drive_pattern` is the derivative there. All other effects act on the
// row as it was steered.
#pragma once

#include "drive/steered_motion.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <vector>

namespace trussmap::effects {

/// steer, steer_gain, wheel_left or steer_left.
[[nodiscard]] bool is_steering(Channel channel);
/// wheel_left or steer_left.
[[nodiscard]] bool is_wheels_place(Channel channel);
/// is_steering, or other_axle: of robots that steer alone.
[[nodiscard]] bool is_of_steered_drive(Channel channel);
/// What g of one of them adds where this angle [rad] is read.
void add_steering(Channel channel, double g, double angle, drive::SteeringChange& change);
/// Whether any effect is of one.
[[nodiscard]] bool steers(const std::vector<Effect>& effects);

/// Whether they leave the measured wheel a way ahead in every row; true where no wheel is steered.
/// Throws as gains_of does.
[[nodiscard]] bool leave_a_way(const std::vector<Effect>& effects, const MotionRows& drive,
                               const Robot& robot, const RowVariables& variables, int session);

/// The drive with what its robot's steering effects say of it: `left`, `right`, `steered` and the
/// columns' `by_reading`. `variables` are this drive's; per session, coefficients of `session` are
/// taken. Unchanged where no wheel is steered. Throws std::invalid_argument, naming the effects,
/// where the measured wheel would have no way ahead; std::logic_error where the gyro or steering
/// was taken in before.
[[nodiscard]] MotionRows steered(MotionRows drive, const Robot& robot,
                                 const std::vector<Effect>& effects, const RowVariables& variables,
                                 int session);

}  // namespace trussmap::effects
