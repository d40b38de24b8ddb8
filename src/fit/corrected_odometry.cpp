// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/corrected_odometry.hpp"

#include "drive/body_motion.hpp"
#include "drive/row_motion.hpp"
#include "drive/wheel_kinematics.hpp"
#include "effects/channel_physics.hpp"
#include "estimation/mounted_views.hpp"
#include "fit/online_effects.hpp"
#include "odometry/row_reckoner.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "recording/variable_names.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

/// Where the robot is, and by what.
struct Reckoning {
  RowReckoner reckoner;
  Pose start_map = {};           ///< where the pose is counted from
  bool heading_known = false;    ///< by a reading
  double turned_variance = 0.0;  ///< rad^2, since the start, until a reading comes

  [[nodiscard]] Pose map_pose(const Pose& pose) const { return compose(start_map, pose); }
  [[nodiscard]] Pose map_pose() const { return map_pose(reckoner.at().pose); }
};

[[noreturn]] void refuse(const std::string& why) {
  throw std::invalid_argument(why);
}

OdometryInputs checked(OdometryInputs inputs) {
  std::vector<std::string> taken = reserved_variables();
  for (const std::string& name : inputs.covariates) {
    if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
      refuse("covariate \"" + name + "\" has the name of another variable");
    }
    taken.push_back(name);
  }
  return inputs;
}

void check_sensors(const WheelRow& row, const OdometryInputs& inputs) {
  if (std::isinf(row.compass)) refuse("a compass reading is infinite");
  if (std::isinf(row.yaw_rate)) refuse("a yaw rate is infinite");
  if (!inputs.gyro && !std::isnan(row.yaw_rate)) {
    refuse("a row has a yaw rate, but the robot was said to have no gyro");
  }
  if (!inputs.compass && !std::isnan(row.compass)) {
    refuse("a row has a compass reading, but the robot was said to have no compass");
  }
}

void check_covariates(std::span<const double> covariates, const OdometryInputs& inputs) {
  if (covariates.size() != inputs.covariates.size()) {
    refuse(joined("a row has ", covariates.size(), " covariates, expected ",
                  inputs.covariates.size()));
  }
  for (std::size_t k = 0; k < covariates.size(); ++k) {
    if (std::isfinite(covariates[k])) continue;
    refuse("covariate \"" + inputs.covariates[k] + "\" is not finite");
  }
}

/// What wheels and gyro say of one row.
class RowAtHand {
 public:
  RowAtHand(Robot robot, const Noise& noise, bool gyro)
      : robot_(std::move(robot)), noise_(noise), gyro_(gyro) {
    if (!(robot_.wheelbase > 0.0)) refuse("the wheelbase must be above 0 m");
    if (robot_.drive == DriveKind::unicycle && (columns() < 1 || columns() > 2)) {
      refuse(joined("drive unicycle has ", columns(), " columns, expected 1 or 2"));
    }
    drive_.left = drive_.right = {0.0};
    if (robot_.drive == DriveKind::differential || robot_.drive == DriveKind::unicycle) return;
    kinematics_.emplace(robot_);
    kinematics_->prepare(drive_, 1);
  }

  void check(const WheelRow& row) const {
    if (!std::isfinite(row.duration) || row.duration <= 0.0) {
      refuse("a row lasts " + short_text(row.duration) + " s, expected more than 0");
    }
    if (!std::isfinite(row.left) || !std::isfinite(row.right)) {
      refuse("a row's travel is not finite");
    }
    if (row.readings.size() != columns()) {
      refuse(joined("a row has readings of ", row.readings.size(), " wheels, expected ",
                    expected_readings()));
    }
    if (columns() > 0 && (row.left != 0.0 || row.right != 0.0)) {
      refuse("a row has travels left and right, expected readings of " + expected_readings());
    }
    if (turns_by_gyro() && std::isnan(row.yaw_rate)) {
      refuse("a row has no yaw rate, expected one: it is how the robot turns");
    }
    for (std::size_t k = 0; k < row.readings.size(); ++k) {
      if (is_possible_reading(row.readings[k])) continue;
      refuse(joined("column ", robot_.columns[k], " reads ", short_text(row.readings[k]),
                    ", expected a travel in metres or an angle in radians"));
    }
  }

  /// The row as it is read, what the gyro adds to it.
  GyroShare take(const WheelRow& row) {
    if (!kinematics_) {
      const WheelTravel shown =
          columns() > 0 ? unicycle_travel(row) : WheelTravel{row.left, row.right};
      drive_.left.front() = shown.left;
      drive_.right.front() = shown.right;
      return share_of(row);
    }
    for (std::size_t k = 0; k < row.readings.size(); ++k) {
      drive_.wheels[k].reading.front() = row.readings[k];
    }
    if (!kinematics_->move(drive_, 0)) {
      refuse("a steering angle of " + short_text(row.readings.back()) +
             " rad leaves the measured wheel no way ahead, expected a smaller one");
    }
    return share_of(row);
  }

  /// The same, steered by so many rad more.
  GyroShare steer(const WheelRow& row, double more) {
    if (kinematics_ && !kinematics_->move(drive_, 0, more)) {
      refuse("a steering angle of " + short_text(row.readings.back() + more) +
             " rad, which the model's steering effects lead to, leaves the measured wheel no way "
             "ahead");
    }
    return share_of(row);
  }

  /// As wheels and gyro together say.
  ReckonedRow recorded(const WheelRow& row, const GyroShare& gyro) {
    ReckonedRow result{together(gyro, robot_), row.duration, 0.0, row.compass};
    result.sideways = gyro.sideways;
    if (!drive_.sideways.empty()) result.sideways += gyro.aside * gyro.excess;
    result.noise = noise_of(result, gyro);
    return result;
  }

  /// The row less what is added to it.
  ReckonedRow cleared(const ReckonedRow& row, const GyroShare& gyro, const DrivePattern& more) {
    ReckonedRow clear = row;
    const WheelTravel turned = wheel_travel({0.0, 0.0, more.turn}, robot_);
    clear.travel = {row.travel.left + more.advance + turned.left,
                    row.travel.right + more.advance + turned.right};
    clear.slip = more.slip;
    clear.noise = noise_of(clear, gyro);
    return clear;
  }

  /// As shapes of the rates see it.
  [[nodiscard]] BodyMotion body(const ReckonedRow& row) const {
    return body_motion(row.travel, robot_, row.sideways);
  }

  /// As channels see it.
  [[nodiscard]] RowMotion shown(const ReckonedRow& row, const GyroShare& gyro) const {
    RowMotion shown = row_motion(gyro, row.duration, robot_);
    if (kinematics_) shown.wheels = &drive_.wheels;
    return shown;
  }

  [[nodiscard]] Motion motion(const ReckonedRow& row) const {
    return {displacement_of(body_motion(row.travel, robot_, row.slip + row.sideways)),
            covariance_of(row, robot_, noise_)};
  }

  [[nodiscard]] const Robot& robot() const { return robot_; }
  [[nodiscard]] const Noise& noise() const { return noise_; }

 private:
  /// Of two wheels none: they are left and right.
  [[nodiscard]] std::size_t columns() const {
    return robot_.drive == DriveKind::differential ? 0 : robot_.columns.size();
  }

  /// Where travel is a unicycle's one column, the gyro says how it turns, and is no further sensor.
  [[nodiscard]] bool turns_by_gyro() const {
    return robot_.drive == DriveKind::unicycle && columns() == 1;
  }

  [[nodiscard]] WheelTravel unicycle_travel(const WheelRow& row) const {
    const double turn = turns_by_gyro() ? row.yaw_rate * row.duration : row.readings[1];
    return wheel_travel({row.readings[0], 0.0, turn}, robot_);
  }

  [[nodiscard]] GyroShare share_of(const WheelRow& row) const {
    const double beside = turns_by_gyro() ? kAbsent : row.yaw_rate;
    return gyro_share(drive_, 0, beside, row.duration, robot_, noise_);
  }

  /// Nothing of two wheels without a gyro: then that of the wheels.
  [[nodiscard]] std::optional<ArcNoise> noise_of(const ReckonedRow& row, const GyroShare& gyro) {
    if (!gyro_ && !kinematics_) return std::nullopt;
    drive_.left.front() = row.travel.left;
    drive_.right.front() = row.travel.right;
    drive_.gyro.clear();
    if (gyro_) drive_.gyro.push_back(gyro);
    return row_noise(drive_, 0, 1.0, row.duration, robot_, noise_);
  }

  [[nodiscard]] std::string expected_readings() const {
    if (columns() == 0) return "none of two wheels, but left and right";
    std::string names;
    for (const std::string& one : robot_.columns) names += (names.empty() ? "" : ", ") + one;
    return names;
  }

  Robot robot_;
  Noise noise_;
  bool gyro_;
  std::optional<WheelKinematics> kinematics_;  ///< of other wheels than two
  MotionRows drive_;                           ///< of this row alone
};

/// Where a row leads from now.
Reckoning reckoned(const Reckoning& now, ReckonedRow row, const RowAtHand& by, bool compass) {
  Reckoning after = now;
  const double reading = row.reading;
  if (compass && !now.heading_known) {
    row.reading = kAbsent;
    after.reckoner.take(row, by.robot(), by.noise());
    after.turned_variance += covariance_of(row, by.robot(), by.noise())(2, 2);
    if (std::isnan(reading)) return after;
    after.start_map.heading = wrap_angle(reading - after.reckoner.at().pose.heading);
    after.reckoner.add_first_variance(reading_variance(by.noise()) + after.turned_variance);
    after.heading_known = true;
    return after;
  }
  row.reading -= now.start_map.heading;
  after.reckoner.take(row, by.robot(), by.noise());
  return after;
}

}  // namespace

class __attribute__((visibility("hidden"))) CorrectedOdometry::State {
 public:
  State(const Model& model, OdometryInputs inputs)
      : at_hand_(model.robot, model.noise, inputs.gyro),
        inputs_(checked(std::move(inputs))),
        effects_(model.effects, inputs_.covariates),
        covariates_(inputs_.covariates.size(), kAbsent),
        now_{RowReckoner({}, inputs_.compass)} {
    for (const Effect& effect : model.effects) require_of_drive(effect, model.robot);
  }

  CorrectedRow drive(const WheelRow& row, std::span<const double> covariates) {
    at_hand_.check(row);
    check_sensors(row, inputs_);
    check_covariates(covariates, inputs_);
    const GyroShare gyro = at_hand_.take(row);
    const ReckonedRow recorded = at_hand_.recorded(row, gyro);
    const WheelWay wheels{gyro.left, gyro.right, gyro.sideways};
    const BodyMotion both = at_hand_.body(recorded);
    const OnlineFacts facts{variables_.next(wheels, both, row.duration), covariates};
    // Shapes that speak of the pose see it first as the row says, then as corrected.
    const bool twice = effects_.see_the_pose();
    ReckonedRow clear = recorded;
    Reckoning after = twice ? reckoned(now_, clear, at_hand_, inputs_.compass) : now_;
    for (int pass = twice ? 0 : 1; pass < 2; ++pass) {
      if (!effects_.steer()) {
        clear = cleared(recorded, gyro, facts, after);
      } else {
        const double more = effects_.steering(facts, middle_of(after), row.readings);
        const GyroShare steered = at_hand_.steer(row, more);
        clear = cleared(at_hand_.recorded(row, steered), steered, facts, after);
      }
      after = reckoned(now_, clear, at_hand_, inputs_.compass);
    }
    variables_.take(wheels, both, row.duration);
    last_ = facts.row;
    std::copy(covariates.begin(), covariates.end(), covariates_.begin());
    now_ = after;
    return {at_hand_.motion(clear), pose()};
  }

  [[nodiscard]] const PoseEstimate& pose() const { return now_.reckoner.at(); }

  void reset() {
    PoseEstimate start;
    if (now_.heading_known) start.covariance(2, 2) = pose().covariance(2, 2);
    now_ = {RowReckoner(start, inputs_.compass), now_.map_pose(), now_.heading_known};
  }

  void set_map_pose(const Pose& pose_map) {
    Pose& start = now_.start_map;
    if (!now_.heading_known) start.heading = pose_map.heading - pose().pose.heading;
    const Vector2 place = pose_map.position() - rotation(start.heading) * pose().pose.position();
    start.x = place.x();
    start.y = place.y();
  }

  [[nodiscard]] CorrectedSighting corrected(const Sighting& sighting) const {
    const OnlineFacts facts{last_, covariates_};
    CorrectedSighting result{sighting};
    result.sighting.t = effects_.cleared_time(sighting.t, facts);
    ViewPattern added = mounted_view(at_hand_.robot().mounted, RecordingStream::sightings);
    added.add(1.0, effects_.view(facts, now_.map_pose()));
    result.sensor_robot = {added.ahead, added.left};
    result.sighting.yaw = wrap_angle(sighting.yaw - added.yaw + added.heading);
    if (sighting.standing()) return result;
    result.sighting.range =
        std::max((sighting.range - added.range) / (1.0 + added.range_scale), 0.0);
    result.sighting.bearing = wrap_angle(sighting.bearing - added.bearing + added.heading);
    return result;
  }

 private:
  /// The row in its middle, with `after` where it leads as far as is known.
  [[nodiscard]] Pose middle_of(const Reckoning& after) const {
    const Pose before = after.map_pose(pose().pose);
    const Pose end = after.map_pose();
    return {0.5 * (before.x + end.x), 0.5 * (before.y + end.y),
            before.heading + 0.5 * wrap_angle(end.heading - before.heading)};
  }

  /// The row less what the effects add to it; `after` is where it leads as far as is known.
  ReckonedRow cleared(const ReckonedRow& row, const GyroShare& gyro, const OnlineFacts& facts,
                      const Reckoning& after) {
    const RowMotion shown = at_hand_.shown(row, gyro);
    ReckonedRow clear = at_hand_.cleared(row, gyro, effects_.drive(facts, middle_of(after), shown));
    if (std::isnan(row.reading)) return clear;
    clear.reading = effects_.cleared_reading(clear.reading, facts, after.map_pose());
    return clear;
  }

  RowAtHand at_hand_;
  OdometryInputs inputs_;
  OnlineEffects effects_;
  CausalVariables variables_;
  CausalRow last_;
  std::vector<double> covariates_;  ///< of the last row
  Reckoning now_;
};

CorrectedOdometry::CorrectedOdometry(const Model& model, const OdometryInputs& inputs)
    : state_(std::make_unique<State>(model, inputs)) {}
CorrectedOdometry::~CorrectedOdometry() = default;
CorrectedOdometry::CorrectedOdometry(CorrectedOdometry&&) noexcept = default;
CorrectedOdometry& CorrectedOdometry::operator=(CorrectedOdometry&&) noexcept = default;

CorrectedRow CorrectedOdometry::drive(const WheelRow& row, std::span<const double> covariates) {
  return state_->drive(row, covariates);
}
const PoseEstimate& CorrectedOdometry::pose() const {
  return state_->pose();
}
void CorrectedOdometry::reset() {
  state_->reset();
}
void CorrectedOdometry::set_map_pose(const Pose& pose_map) {
  state_->set_map_pose(pose_map);
}
CorrectedSighting CorrectedOdometry::corrected(const Sighting& sighting) const {
  return state_->corrected(sighting);
}

}  // namespace trussmap
