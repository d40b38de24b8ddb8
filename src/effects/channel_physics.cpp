// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/channel_physics.hpp"

#include <array>
#include <cmath>
#include <optional>

namespace trussmap {

ActsOn acts_on(Channel channel) {
  switch (channel) {
    case Channel::compass:
      return ActsOn::readings;
    case Channel::lever:
    case Channel::lever_left:
    case Channel::range:
    case Channel::range_scale:
    case Channel::bearing:
    case Channel::delay:
    case Channel::truth_heading:
    case Channel::antenna:
    case Channel::antenna_left:
    case Channel::fix_delay:
    case Channel::fix_x:
    case Channel::fix_y:
    case Channel::sighting_yaw:
      return ActsOn::views;
    case Channel::travel:
    case Channel::left:
    case Channel::right:
    case Channel::wheels:
    case Channel::difference:
    case Channel::turn:
    case Channel::drift:
    case Channel::advance:
    case Channel::rotate:
    case Channel::creep:
    case Channel::gyro:
    case Channel::gyro_scale:
    case Channel::sideways:
    case Channel::wheel1:
    case Channel::wheel2:
    case Channel::wheel3:
    case Channel::wheel4:
    case Channel::wheel5:
    case Channel::wheel6:
    case Channel::steer:
    case Channel::steer_gain:
      break;
  }
  return ActsOn::drives;
}

namespace {

/// What so much more of one column's reading adds.
DrivePattern more_of(const WheelColumn& column, std::size_t row, double reading) {
  const std::array<double, 3>& by = column.by_reading[row];
  return {by[0] * reading, by[1] * reading, by[2] * reading, 0.0};
}

/// What g adds to the n-th wheel of the row.
DrivePattern wheel_column_pattern(std::size_t n, double g, const RowTravel& row) {
  if (row.wheels == nullptr || n >= row.wheels->size()) return {};
  const WheelColumn& column = (*row.wheels)[n];
  return column.steers ? DrivePattern() : more_of(column, row.row, g * column.reading[row.row]);
}

DrivePattern steer_pattern(Channel channel, double g, const RowTravel& row) {
  if (row.wheels == nullptr) return {};
  for (const WheelColumn& column : *row.wheels) {
    if (!column.steers) continue;
    return more_of(column, row.row, channel == Channel::steer ? g : g * column.reading[row.row]);
  }
  return {};
}

/// What g adds to what the wheels say of a row, or to its compass reading.
DrivePattern wheel_pattern(Channel channel, double g, const RowTravel& row, double wheelbase) {
  const double path = 0.5 * (row.left + row.right);
  const double turn = (row.right - row.left) / wheelbase;
  switch (channel) {
    case Channel::travel:
      return {g * path, 0.0, 0.0, 0.0};
    case Channel::left:
      return {0.5 * g * row.left, 0.0, -g * row.left / wheelbase, 0.0};
    case Channel::right:
      return {0.5 * g * row.right, 0.0, g * row.right / wheelbase, 0.0};
    case Channel::wheels:
      return {g * path, g * row.sideways, g * turn, 0.0};
    case Channel::sideways:
      return {0.0, g * row.sideways, 0.0, 0.0};
    case Channel::wheel1:
    case Channel::wheel2:
    case Channel::wheel3:
    case Channel::wheel4:
    case Channel::wheel5:
    case Channel::wheel6:
      return wheel_column_pattern(*wheel_of(channel), g, row);
    case Channel::steer:
    case Channel::steer_gain:
      return steer_pattern(channel, g, row);
    case Channel::difference:
      return {0.25 * g * (row.right - row.left), 0.0, g * path / wheelbase, 0.0};
    case Channel::turn:
      return {0.0, 0.0, g * turn, 0.0};
    case Channel::drift:
      return {0.0, 0.0, g * row.duration, 0.0};
    case Channel::advance:
      return {g, 0.0, 0.0, 0.0};
    case Channel::rotate:
      return {0.0, 0.0, g, 0.0};
    case Channel::creep:
      return {0.0, g * path, 0.0, 0.0};
    case Channel::compass:
      return {0.0, 0.0, 0.0, g};
    case Channel::lever:
    case Channel::lever_left:
    case Channel::range:
    case Channel::range_scale:
    case Channel::bearing:
    case Channel::delay:
    case Channel::truth_heading:
    case Channel::gyro:
    case Channel::gyro_scale:
    case Channel::antenna:
    case Channel::antenna_left:
    case Channel::fix_delay:
    case Channel::fix_x:
    case Channel::sighting_yaw:
    case Channel::fix_y:
      break;
  }
  return {};
}

/// rad that g adds to the gyro's turn.
double gyro_pattern(Channel channel, double g, const RowTravel& row) {
  if (channel == Channel::gyro) return -g * row.duration;
  return channel == Channel::gyro_scale ? g * row.gyro_turn : 0.0;
}

}  // namespace

bool is_of_drive(Channel channel, const Robot& robot) {
  const bool two = robot.drive == DriveKind::differential;
  const bool steers = robot.drive == DriveKind::tricycle || robot.drive == DriveKind::ackermann;
  if (const std::optional<std::size_t> wheel = wheel_of(channel)) {
    return !two && !steers && *wheel < robot.columns.size();  // one that is steered: `wheels`
  }
  switch (channel) {
    case Channel::left:
    case Channel::right:
    case Channel::difference:
      return two;
    case Channel::steer:
    case Channel::steer_gain:
      return steers;
    case Channel::sideways:
      return robot.drive == DriveKind::omni3 || robot.drive == DriveKind::mecanum ||
             (robot.drive == DriveKind::wheels && !robot.matrix.row(1).isZero(0.0));
    default:
      return true;
  }
}

RowTravel shown_travel(const Drive& drive, std::size_t row) {
  RowTravel travel{drive.left[row], drive.right[row], drive.duration(row)};
  travel.sideways = drive.slip(row);
  travel.wheels = drive.wheels.empty() ? nullptr : &drive.wheels;
  travel.row = row;
  return travel;
}

RowTravel row_travel(const Drive& drive, std::size_t row, double wheelbase) {
  if (drive.gyro.empty()) return shown_travel(drive, row);
  RowTravel travel = row_travel(drive.gyro[row], drive.duration(row), wheelbase);
  travel.wheels = drive.wheels.empty() ? nullptr : &drive.wheels;
  travel.row = row;
  return travel;
}

RowTravel row_travel(const GyroShare& gyro, double duration, double wheelbase) {
  RowTravel travel{gyro.left, gyro.right, duration};
  travel.gyro_turn = (gyro.right - gyro.left) / wheelbase + gyro.excess;
  travel.gyro_along = gyro.along;
  travel.gyro_share = gyro.turn;
  travel.gyro_reads = std::isfinite(gyro.variance);
  travel.sideways = gyro.sideways;
  travel.gyro_aside = gyro.aside;
  return travel;
}

DrivePattern drive_pattern(Channel channel, double g, const RowTravel& row, double wheelbase) {
  DrivePattern pattern = wheel_pattern(channel, g, row, wheelbase);
  if (!row.gyro_reads) return pattern;
  pattern.excess = gyro_pattern(channel, g, row) - pattern.turn;
  pattern.advance += row.gyro_along * pattern.excess;
  pattern.slip += row.gyro_aside * pattern.excess;
  pattern.turn += row.gyro_share * pattern.excess;
  return pattern;
}

ViewPattern view_pattern(Channel channel, double g, double speed, double turn_rate) {
  ViewPattern view;
  switch (channel) {
    case Channel::lever:
    case Channel::antenna:
      view.ahead = g;
      break;
    case Channel::lever_left:
    case Channel::antenna_left:
      view.left = g;
      break;
    case Channel::range:
      view.range = g;
      break;
    case Channel::range_scale:
      view.range_scale = g;
      break;
    case Channel::bearing:
      view.bearing = g;
      break;
    case Channel::delay:
    case Channel::fix_delay:
      view.ahead = -g * speed;
      view.heading = -g * turn_rate;
      break;
    case Channel::truth_heading:
      view.heading = g;
      break;
    case Channel::fix_x:
      view.x = g;
      break;
    case Channel::fix_y:
      view.y = g;
      break;
    case Channel::sighting_yaw:
      view.yaw = g;
      break;
    default:
      break;
  }
  return view;
}

bool is_recordable(Channel channel) {
  return channel != Channel::creep && channel != Channel::lever && channel != Channel::lever_left &&
         channel != Channel::delay && channel != Channel::truth_heading && !acts_on_fixes(channel);
}

bool acts_on_sightings(Channel channel) {
  return acts_on(channel) == ActsOn::views && !acts_on_fixes(channel) &&
         channel != Channel::truth_heading;
}

bool acts_on_truth(Channel channel) {
  return acts_on(channel) == ActsOn::views && !acts_on_fixes(channel) &&
         channel != Channel::sighting_yaw;
}

bool acts_on_fixes(Channel channel) {
  return channel == Channel::antenna || channel == Channel::antenna_left ||
         channel == Channel::fix_delay || channel == Channel::fix_x || channel == Channel::fix_y;
}

bool is_delay(Channel channel) {
  return channel == Channel::delay || channel == Channel::fix_delay;
}

RowTravel without(Channel channel, double g, const RowTravel& row, double wheelbase) {
  const DrivePattern more = drive_pattern(channel, g, row, wheelbase);
  RowTravel nominal = row;
  nominal.left = row.left + more.advance - 0.5 * wheelbase * more.turn;
  nominal.right = row.right + more.advance + 0.5 * wheelbase * more.turn;
  nominal.sideways = row.sideways + more.slip;
  return nominal;
}

double yaw_rate_without(Channel channel, double g, double yaw_rate) {
  if (channel == Channel::gyro) return yaw_rate - g;
  return channel == Channel::gyro_scale ? yaw_rate * (1.0 + g) : yaw_rate;
}

Sighting without(Channel channel, double g, const Sighting& sighting) {
  const ViewPattern more = view_pattern(channel, g, 0.0, 0.0);
  Sighting result = sighting;
  result.range = (sighting.range - more.range) / (1.0 + more.range_scale);
  if (more.bearing != 0.0) result.bearing = wrap_angle(sighting.bearing - more.bearing);
  if (more.yaw != 0.0) result.yaw = wrap_angle(sighting.yaw - more.yaw);
  return result;
}

}  // namespace trussmap
