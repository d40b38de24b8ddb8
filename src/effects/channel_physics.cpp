// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/channel_physics.hpp"

#include "effects/channel_record.hpp"
#include "text/number_text.hpp"

#include <cmath>
#include <stdexcept>

namespace trussmap::effects {

ActsOn acts_on(Channel channel) {
  return record_of(channel).target.kind;
}

bool acts_on_sightings(Channel channel) {
  return record_of(channel).target.sightings;
}

bool acts_on_truth(Channel channel) {
  return record_of(channel).target.truth;
}

bool acts_on_fixes(Channel channel) {
  return record_of(channel).target.fixes;
}

bool acts_on_loops(Channel channel) {
  return record_of(channel).target.loops;
}

bool is_delay(Channel channel) {
  return record_of(channel).delay;
}

bool is_recordable(Channel channel) {
  return record_of(channel).recordable;
}

bool is_of_drive(Channel channel, const Robot& robot) {
  const auto of_drive = record_of(channel).of_drive;
  return of_drive == nullptr || of_drive(robot);
}

void require_of_drive(const Effect& effect, const Robot& robot) {
  if (is_of_drive(effect.channel, robot)) return;
  throw std::invalid_argument(text::joined("effect \"", effect.name, "\": channel \"",
                                           name_of(effect.channel), "\" is of another drive than ",
                                           name_of(robot.drive)));
}

DrivePattern drive_pattern(Channel channel, double g, const drive::RowMotion& row) {
  const ChannelRecord& physics = record_of(channel);
  DrivePattern pattern;
  if (physics.wheel_pattern != nullptr) pattern = physics.wheel_pattern(g, row);
  if (!row.gyro_reads) return pattern;
  const double gyro = physics.gyro_pattern == nullptr ? 0.0 : physics.gyro_pattern(g, row);
  pattern.excess = gyro - pattern.turn;
  pattern.advance += row.gyro_along * pattern.excess;
  pattern.slip += row.gyro_lateral * pattern.excess;
  pattern.turn += row.gyro_share * pattern.excess;
  return pattern;
}

ViewPattern view_pattern(Channel channel, double g, double speed, double turn_rate) {
  const auto pattern = record_of(channel).view_pattern;
  return pattern == nullptr ? ViewPattern() : pattern(g, speed, turn_rate);
}

double yaw_rate_without(Channel channel, double g, double yaw_rate) {
  const auto without_g = record_of(channel).yaw_rate_without;
  return without_g == nullptr ? yaw_rate : without_g(g, yaw_rate);
}

Sighting without(Channel channel, double g, const Sighting& sighting) {
  const ViewPattern more = view_pattern(channel, g, 0.0, 0.0);
  Sighting result = sighting;
  result.range = (sighting.range - more.range) / (1.0 + more.range_scale);
  if (more.bearing != 0.0) result.bearing = wrap_angle(sighting.bearing - more.bearing);
  if (more.yaw != 0.0) result.yaw = wrap_angle(sighting.yaw - more.yaw);
  return result;
}

}  // namespace trussmap::effects
