// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The robot's constants as functions of effects with the shape 1 (calibrate.hpp).
#pragma once

#include "trussmap/channel.hpp"
#include "trussmap/robot.hpp"

#include <map>
#include <string>
#include <vector>

namespace trussmap::calibration {

/// g by channel, side by side; 0 of others.
using ChannelGains = std::map<Channel, double>;

[[nodiscard]] double gain_of(const ChannelGains& gains, Channel channel);

/// What a constant is of.
enum class ConstantKind { wheel, length, other };

struct ConstantValue {
  std::string name;
  std::string unit;
  double value = 0.0;
  ConstantKind kind = ConstantKind::other;
  std::vector<Channel> of;  ///< channels of which one at least has to be asked for
  std::string note = {};    ///< how it is meant
};

/// All that a drive of this kind can have, in the order in which they are told. Lengths that are
/// not there (drive `wheels`) are a factor of the turn instead. NaN of wheels and lengths where the
/// drive would go, or turn, backwards.
[[nodiscard]] std::vector<ConstantValue> constant_values(const Robot& robot,
                                                         const ChannelGains& gains);

/// By what its lengths are larger, the mean of its wheels, and what goes sideways.
struct DriveScales {
  double length = 1.0;    ///< l
  double wheels = 1.0;    ///< c
  double sideways = 1.0;  ///< beside the wheels' own
};
[[nodiscard]] DriveScales drive_scales(const Robot& robot, const ChannelGains& gains);

/// g side by side of constants that were found one after the other (sought_constants.hpp), each on
/// what those before it had corrected: they multiply.
[[nodiscard]] ChannelGains side_by_side(const Robot& robot, const ChannelGains& in_turn);

}  // namespace trussmap::calibration
