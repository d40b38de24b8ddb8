// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fit/online_odometry.hpp"

#include "estimation/mounted_views.hpp"
#include "recording/variable_names.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::fitting {
namespace {

OdometryInputs checked(OdometryInputs inputs) {
  std::vector<std::string> taken = recording::reserved_variables();
  for (const std::string& name : inputs.covariates) {
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      refuse_row("covariate \"" + name + "\" has the name of another variable");
    }
    taken.push_back(name);
  }
  return inputs;
}

void check_sensors(const WheelRow& row, const OdometryInputs& inputs) {
  if (std::isinf(row.compass)) refuse_row("a compass reading is infinite");
  if (std::isinf(row.yaw_rate)) refuse_row("a yaw rate is infinite");
  if (!inputs.gyro && !std::isnan(row.yaw_rate)) {
    refuse_row("a row has a yaw rate, but the robot was said to have no gyro");
  }
  if (!inputs.compass && !std::isnan(row.compass)) {
    refuse_row("a row has a compass reading, but the robot was said to have no compass");
  }
}

void check_covariates(std::span<const double> covariates, const OdometryInputs& inputs) {
  if (covariates.size() != inputs.covariates.size()) {
    refuse_row(text::joined("a row has ", covariates.size(), " covariates, expected ",
                            inputs.covariates.size()));
  }
  for (std::size_t k = 0; k < covariates.size(); ++k) {
    if (std::isfinite(covariates[k])) continue;
    refuse_row("covariate \"" + inputs.covariates[k] + "\" is not finite");
  }
}

/// Where a row leads from now.
Reckoning reckoned(const Reckoning& now, odometry::ReckonedRow row, const RowAtHand& by,
                   bool compass) {
  Reckoning after = now;
  const double reading = row.reading;
  if (compass && !now.heading_known) {
    row.reading = kAbsent;
    after.reckoner.take(row, by.robot(), by.noise());
    after.turned_variance += odometry::covariance_of(row, by.robot(), by.noise())(2, 2);
    if (std::isnan(reading)) return after;
    after.start_map.heading = wrap_angle(reading - after.reckoner.at().pose.heading);
    after.reckoner.add_first_variance(odometry::reading_variance(by.noise()) +
                                      after.turned_variance);
    after.heading_known = true;
    return after;
  }
  row.reading -= now.start_map.heading;
  after.reckoner.take(row, by.robot(), by.noise());
  return after;
}

}  // namespace

OnlineOdometry::OnlineOdometry(const Model& model, OdometryInputs inputs)
    : at_hand_(model.robot, model.noise, inputs.gyro),
      inputs_(checked(std::move(inputs))),
      effects_(model.effects, inputs_.covariates),
      covariates_(inputs_.covariates.size(), kAbsent),
      now_{odometry::RowReckoner({}, inputs_.compass)} {
  for (const Effect& effect : model.effects) effects::require_of_drive(effect, model.robot);
}

CorrectedRow OnlineOdometry::drive(const WheelRow& row, std::span<const double> covariates) {
  at_hand_.check(row);
  check_sensors(row, inputs_);
  check_covariates(covariates, inputs_);
  const GyroShare gyro = at_hand_.take(row);
  const odometry::ReckonedRow recorded = at_hand_.recorded(row, gyro);
  const drive::WheelWay wheels = at_hand_.wheels(gyro);
  const BodyMotion& both = recorded.motion;
  const OnlineFacts facts{variables_.next(wheels, both, row.duration), covariates};
  // Shapes that speak of the pose see it first as the row says, then as corrected.
  const bool twice = effects_.see_the_pose();
  odometry::ReckonedRow clear = recorded;
  Reckoning after = twice ? reckoned(now_, clear, at_hand_, inputs_.compass) : now_;
  for (int pass = twice ? 0 : 1; pass < 2; ++pass) {
    if (!effects_.steer()) {
      clear = cleared(recorded, gyro, facts, after);
    } else {
      const drive::SteeringChange more = effects_.steering(facts, middle_of(after), row.readings);
      const GyroShare steered = at_hand_.steer(row, more);
      clear = cleared(at_hand_.recorded(row, steered), steered, facts, after);
    }
    after = reckoned(now_, clear, at_hand_, inputs_.compass);
  }
  variables_.take(wheels, both, row.duration);
  last_ = facts.row;
  shown_ = at_hand_.shown(recorded, gyro);
  reading_ = clear.reading;
  excess_ = shown_.gyro_reads ? shown_.gyro_turn - shown_.body.turn + added_excess_ : 0.0;
  std::copy(covariates.begin(), covariates.end(), covariates_.begin());
  now_ = after;
  return {at_hand_.motion(clear), pose()};
}

void OnlineOdometry::reset() {
  PoseEstimate start;
  if (now_.heading_known) start.covariance(2, 2) = pose().covariance(2, 2);
  now_ = {odometry::RowReckoner(start, inputs_.compass), now_.map_pose(), now_.heading_known};
}

void OnlineOdometry::set_map_pose(const Pose& pose_map) {
  Pose& start = now_.start_map;
  if (!now_.heading_known) start.heading = pose_map.heading - pose().pose.heading;
  const Vector2 place = pose_map.position() - rotation(start.heading) * pose().pose.position();
  start.x = place.x();
  start.y = place.y();
}

void OnlineOdometry::set_effects(const std::vector<Effect>& effects) {
  for (const Effect& effect : effects) effects::require_of_drive(effect, at_hand_.robot());
  effects_ = OnlineEffects(effects, inputs_.covariates);
}

CorrectedSighting OnlineOdometry::corrected(const Sighting& sighting) const {
  const OnlineFacts facts{last_, covariates_};
  CorrectedSighting result{sighting};
  result.sighting.t = effects_.cleared_time(sighting.t, facts);
  effects::ViewPattern added =
      estimation::mounted_view(at_hand_.robot().mounted, estimation::RecordingStream::sightings);
  added.add(1.0, effects_.view(facts, now_.map_pose()));
  result.sensor_robot = {added.ahead, added.left};
  result.sighting.yaw = wrap_angle(sighting.yaw - added.yaw + added.heading);
  if (sighting.standing()) return result;
  result.sighting.range = std::max((sighting.range - added.range) / (1.0 + added.range_scale), 0.0);
  result.sighting.bearing = wrap_angle(sighting.bearing - added.bearing + added.heading);
  return result;
}

/// The row in its middle, with `after` where it leads as far as is known.
Pose OnlineOdometry::middle_of(const Reckoning& after) const {
  const Pose before = after.map_pose(pose().pose);
  const Pose end = after.map_pose();
  return {0.5 * (before.x + end.x), 0.5 * (before.y + end.y),
          before.heading + 0.5 * wrap_angle(end.heading - before.heading)};
}

/// The row less what the effects add to it; `after` is where it leads as far as is known.
odometry::ReckonedRow OnlineOdometry::cleared(const odometry::ReckonedRow& row,
                                              const GyroShare& gyro, const OnlineFacts& facts,
                                              const Reckoning& after) {
  const drive::RowMotion shown = at_hand_.shown(row, gyro);
  const effects::DrivePattern more = effects_.drive(facts, middle_of(after), shown);
  added_excess_ = more.excess;
  odometry::ReckonedRow clear = at_hand_.cleared(row, gyro, more);
  if (std::isnan(row.reading)) return clear;
  clear.reading = effects_.cleared_reading(clear.reading, facts, after.map_pose());
  return clear;
}

}  // namespace trussmap::fitting
