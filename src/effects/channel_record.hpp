// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// All that is known of a channel in one record: where it acts, its physics, what it is called. A
// further channel is a row of channel_table.cpp and an enumerator.
#pragma once

#include "drive/row_motion.hpp"
#include "effects/channel_physics.hpp"
#include "trussmap/channel.hpp"

#include <string_view>
#include <vector>

namespace trussmap::effects {

struct ChannelTarget {
  ActsOn kind = ActsOn::drives;
  bool sightings = false;  ///< these four of views alone
  bool truth = false;
  bool fixes = false;
  bool loops = false;
};

/// Sentences on a channel's error.
struct ChannelPhrase {
  std::string_view subject;  ///< followed by the size
  std::string_view more;
  std::string_view less;
};

struct ChannelRecord {
  ChannelFacts facts;
  ChannelTarget target = {};
  /// Whether a recording without the effect can be written down.
  bool recordable = true;
  bool delay = false;  ///< moves the instants of what it acts on

  /// Whether a robot's drive has what the channel acts on; nullptr: every drive has.
  bool (*of_drive)(const Robot& robot) = nullptr;
  // What g adds, nullptr: nothing. To what the wheels say of a row, or to its compass reading; to
  // the gyro's turn, rad; to a view, truth row or fix.
  DrivePattern (*wheel_pattern)(double g, const drive::RowMotion& row) = nullptr;
  double (*gyro_pattern)(double g, const drive::RowMotion& row) = nullptr;
  ViewPattern (*view_pattern)(double g, double speed, double turn_rate) = nullptr;
  /// The yaw rate [rad/s] that the gyro would have read without g; nullptr: what it read.
  double (*yaw_rate_without)(double g, double yaw_rate) = nullptr;

  /// The model's white noise that a process of this channel takes its part of.
  std::string_view noise_source = "wheels";
  /// It is a sensor's reading itself: it shows in rows of that noise, and a white one is part of
  /// it.
  bool reading = false;
  /// What an error is drawn against where its shape goes with nothing.
  std::string_view drawn_against = "speed";
  /// Its error may go with any variable of a row; what acts per event, or is a place, has none.
  bool varies = true;

  ChannelPhrase phrase;
  std::string_view noun;  ///< what its error is called in a name: "turning error"
  std::string_view axis;  ///< and at an axis: "robot turns more than measured by"
  /// What a factor 1 + g below zero means; empty where nothing can have one.
  std::string_view below_zero = {};
};

/// A record per channel, in their order.
[[nodiscard]] const std::vector<ChannelRecord>& channel_records();
[[nodiscard]] const ChannelRecord& record_of(Channel channel);

}  // namespace trussmap::effects
