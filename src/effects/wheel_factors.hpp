// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Constant effects that are factors of what two wheels show, taken in. A wheel that is a fifth as
// large as stated moves the body by a fifth of its noise, too, and beside a gyro its weight follows
// from that. So where factors are far from one, a fit drives the rows with those that it believes
// so far and is linear about them (EffectPattern::reference). With u the travels that the wheels
// show, of noise R, and B the motion by them as the effects have it,
//
//   s = B u,   Cov(s) = B R B'
//
// All effects, these too, act on what the wheels show, B0 u, and all shapes see it.
#pragma once

#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/robot.hpp"

#include <optional>
#include <vector>

namespace trussmap::effects {

/// travel, turn, difference, wheels, left or right.
[[nodiscard]] bool is_wheel_factor(Channel channel);
/// A constant one.
[[nodiscard]] bool is_wheel_factor(const Effect& effect);

/// By which share factors are far from one: nearer to it, no noise is stated as exactly.
inline constexpr double kFarFactors = 0.03;

/// What each effect acts on: a fit's act side by side on what the wheels show, a correction takes
/// out one after the other.
enum class FactorsAct { side_by_side, in_turn };

/// By these effects; nothing of another drive than two wheels or a unicycle, or where different
/// motions would show the same. Per session, coefficients of `session` are taken.
[[nodiscard]] std::optional<WheelFactors> wheel_factors(const std::vector<Effect>& effects,
                                                        const Robot& robot, int session,
                                                        FactorsAct act = FactorsAct::side_by_side);

/// The largest share of a wheel's travel by which what the body does of it differs.
[[nodiscard]] double difference(const WheelFactors& a, const WheelFactors& b, const Robot& robot);
/// The same beside the robot as it is stated.
[[nodiscard]] double difference(const WheelFactors& a, const Robot& robot);

/// The drive by them. Throws std::logic_error where factors or the gyro were taken in before.
[[nodiscard]] MotionRows with_factors(MotionRows drive, const WheelFactors& factors,
                                      const Robot& robot);

}  // namespace trussmap::effects
