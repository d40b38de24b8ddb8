// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/corrected_odometry.hpp"

#include "drive/body_motion.hpp"
#include "drive/row_motion.hpp"
#include "drive/wheel_kinematics.hpp"
#include "effects/channel_physics.hpp"
#include "effects/steering.hpp"
#include "fit/effect_columns.hpp"
#include "fit/online_terms.hpp"
#include "odometry/row_reckoner.hpp"
#include "odometry/wheels_and_gyro.hpp"
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
};

[[noreturn]] void refuse(const std::string& why) {
  throw std::invalid_argument(why);
}

}  // namespace

class __attribute__((visibility("hidden"))) CorrectedOdometry::State {
 public:
  State(const Model& model, OdometryInputs inputs)
      : robot_(model.robot),
        noise_(model.noise),
        inputs_(std::move(inputs)),
        covariates_(inputs_.covariates.size(), kAbsent),
        now_{RowReckoner({}, inputs_.compass)} {
    if (!(robot_.wheelbase > 0.0)) refuse("the wheelbase must be above 0 m");
    one_row_.left = one_row_.right = {0.0};
    if (robot_.drive != DriveKind::differential) {
      kinematics_.emplace(robot_);
      kinematics_->prepare(one_row_, 1);
    }
    std::vector<std::string> taken = reserved_variables();
    for (const std::string& name : inputs_.covariates) {
      if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
        refuse("covariate \"" + name + "\" has the name of another variable");
      }
      taken.push_back(name);
    }
    for (const Effect& effect : model.effects) add(effect);
  }

  CorrectedRow drive(const WheelRow& row, std::span<const double> covariates) {
    check(row, covariates);
    take_wheels(row);
    const GyroShare gyro = gyro_share(one_row_, 0, row.yaw_rate, row.duration, robot_, noise_);
    const ReckonedRow recorded = as_recorded(row, gyro);
    const WheelWay wheels{gyro.left, gyro.right, gyro.sideways};
    const BodyMotion both = kinematics_
                                ? body_motion(recorded.travel, robot_, recorded.sideways)
                                : body_motion({wheels.left, wheels.right}, robot_, wheels.sideways);
    const CausalRow facts = variables_.next(wheels, both, row.duration);
    // Shapes that speak of the pose see it first as the row says, then as corrected.
    const bool twice =
        steering_.see_the_pose() || drives_.see_the_pose() || readings_.see_the_pose();
    ReckonedRow clear = recorded;
    Reckoning after = twice ? reckoned(clear) : now_;
    for (int pass = twice ? 0 : 1; pass < 2; ++pass) {
      if (steering_.all().empty()) {
        clear = cleared(recorded, gyro, facts, covariates, after);
      } else {
        const GyroShare share = steered(row, facts, covariates, after);
        clear = cleared(as_recorded(row, share), share, facts, covariates, after);
      }
      after = reckoned(clear);
    }
    variables_.take(wheels, both, row.duration);
    last_ = facts;
    std::copy(covariates.begin(), covariates.end(), covariates_.begin());
    now_ = after;
    return {{displacement_of(body_motion(clear.travel, robot_, clear.slip + clear.sideways)),
             covariance_of(clear, robot_, noise_)},
            now_.reckoner.at()};
  }

  [[nodiscard]] const PoseEstimate& pose() const { return now_.reckoner.at(); }

  void reset() {
    PoseEstimate start;
    if (now_.heading_known) start.covariance(2, 2) = pose().covariance(2, 2);
    now_ = {RowReckoner(start, inputs_.compass), now_.map_pose(pose().pose), now_.heading_known};
  }

  void set_map_pose(const Pose& pose_map) {
    Pose& start = now_.start_map;
    if (!now_.heading_known) start.heading = pose_map.heading - pose().pose.heading;
    const Vector2 place = pose_map.position() - rotation(start.heading) * pose().pose.position();
    start.x = place.x();
    start.y = place.y();
  }

  [[nodiscard]] CorrectedSighting corrected(const Sighting& sighting) const {
    CorrectedSighting result{sighting};
    OnlineTerms delays = delays_;
    delays.fill(last_, {}, covariates_);
    for (const OnlineTerm& term : delays.all()) {
      result.sighting.t -= term.coefficient * delays.value(term);
    }
    OnlineTerms views = views_;
    views.fill(last_, now_.map_pose(pose().pose), covariates_);
    ViewPattern sum;
    for (const OnlineTerm& term : views.all()) {
      const double g = term.coefficient * views.value(term);
      const ViewPattern more = view_pattern(term.channel, g, 0.0, 0.0);
      sum.ahead += more.ahead;
      sum.left += more.left;
      sum.range += more.range;
      sum.range_scale += more.range_scale;
      sum.bearing += more.bearing;
      sum.yaw += more.yaw;
    }
    result.sensor_robot = {sum.ahead, sum.left};
    result.sighting.yaw = wrap_angle(sighting.yaw - sum.yaw);
    if (sighting.standing()) return result;
    result.sighting.range = std::max((sighting.range - sum.range) / (1.0 + sum.range_scale), 0.0);
    result.sighting.bearing = wrap_angle(sighting.bearing - sum.bearing);
    return result;
  }

 private:
  void add(const Effect& effect) {
    const std::vector<double> coefficients = coefficients_of(effect, 1);
    const ActsOn acts = acts_on(effect.channel);
    OnlineTerms& terms = effect.channel == Channel::delay ? delays_
                         : acts == ActsOn::views          ? views_
                         : acts == ActsOn::readings       ? readings_
                         : is_steering(effect.channel)    ? steering_
                                                          : drives_;
    for (std::size_t k = 0; k < effect.shape.size(); ++k) {
      try {
        terms.add({effect.channel, coefficients[k], effect.shape[k], effect.name},
                  inputs_.covariates);
      } catch (const std::invalid_argument& error) {
        throw std::invalid_argument("effect \"" + effect.name + "\": " + error.what());
      }
    }
  }

  void check(const WheelRow& row, std::span<const double> covariates) const {
    if (!std::isfinite(row.duration) || row.duration <= 0.0) {
      refuse("a row lasts " + short_text(row.duration) + " s, expected more than 0");
    }
    if (!std::isfinite(row.left) || !std::isfinite(row.right)) {
      refuse("a row's travel is not finite");
    }
    if (row.readings.size() != one_row_.wheels.size()) {
      refuse(joined("a row has readings of ", row.readings.size(), " wheels, expected ",
                    expected_readings()));
    }
    if (kinematics_ && (row.left != 0.0 || row.right != 0.0)) {
      refuse("a row has travels left and right, expected readings of " + expected_readings());
    }
    for (std::size_t k = 0; k < row.readings.size(); ++k) {
      if (is_possible_reading(row.readings[k])) continue;
      refuse(joined("column ", one_row_.wheels[k].name, " reads ", short_text(row.readings[k]),
                    ", expected a travel in metres or an angle in radians"));
    }
    if (std::isinf(row.compass)) refuse("a compass reading is infinite");
    if (std::isinf(row.yaw_rate)) refuse("a yaw rate is infinite");
    if (!inputs_.gyro && !std::isnan(row.yaw_rate)) {
      refuse("a row has a yaw rate, but the robot was said to have no gyro");
    }
    if (!inputs_.compass && !std::isnan(row.compass)) {
      refuse("a row has a compass reading, but the robot was said to have no compass");
    }
    if (covariates.size() != inputs_.covariates.size()) {
      refuse(joined("a row has ", covariates.size(), " covariates, expected ",
                    inputs_.covariates.size()));
    }
    for (std::size_t k = 0; k < covariates.size(); ++k) {
      if (std::isfinite(covariates[k])) continue;
      refuse("covariate \"" + inputs_.covariates[k] + "\" is not finite");
    }
  }

  [[nodiscard]] std::string expected_readings() const {
    if (!kinematics_) return "none of two wheels, but left and right";
    std::string names;
    for (const WheelColumn& one : one_row_.wheels) names += (names.empty() ? "" : ", ") + one.name;
    return names;
  }

  /// What the row's wheels say, as a drive of this row alone.
  void take_wheels(const WheelRow& row) {
    if (!kinematics_) {
      one_row_.left.front() = row.left;
      one_row_.right.front() = row.right;
      return;
    }
    for (std::size_t k = 0; k < row.readings.size(); ++k) {
      one_row_.wheels[k].reading.front() = row.readings[k];
    }
    if (kinematics_->move(one_row_, 0)) return;
    refuse("a steering angle of " + short_text(row.readings.back()) +
           " rad leaves the measured wheel no way ahead, expected a smaller one");
  }

  /// The row as wheels and gyro together say.
  ReckonedRow as_recorded(const WheelRow& row, const GyroShare& gyro) {
    ReckonedRow result{together(gyro, robot_), row.duration, 0.0, row.compass};
    result.sideways = gyro.sideways;
    if (!one_row_.sideways.empty()) result.sideways += gyro.aside * gyro.excess;
    result.noise = noise_of(result, gyro);
    return result;
  }

  /// Nothing of two wheels without a gyro: then that of the wheels.
  [[nodiscard]] std::optional<ArcNoise> noise_of(const ReckonedRow& row, const GyroShare& gyro) {
    if (!inputs_.gyro && !kinematics_) return std::nullopt;
    one_row_.left.front() = row.travel.left;
    one_row_.right.front() = row.travel.right;
    one_row_.gyro.clear();
    if (inputs_.gyro) one_row_.gyro.push_back(gyro);
    return row_noise(one_row_, 0, 1.0, row.duration, robot_, noise_);
  }

  /// The row in its middle, with `after` where it leads as far as is known.
  [[nodiscard]] Pose middle_of(const Reckoning& after) const {
    const Pose before = after.map_pose(pose().pose);
    const Pose end = after.map_pose(after.reckoner.at().pose);
    return {0.5 * (before.x + end.x), 0.5 * (before.y + end.y),
            before.heading + 0.5 * wrap_angle(end.heading - before.heading)};
  }

  /// The row at hand, steered as the effects say; what the gyro adds to it then.
  GyroShare steered(const WheelRow& row, const CausalRow& facts, std::span<const double> covariates,
                    const Reckoning& after) {
    steering_.fill(facts, middle_of(after), covariates);
    double more = 0.0;  // rad
    for (const OnlineTerm& term : steering_.all()) {
      const double g = term.coefficient * steering_.value(term);
      more += term.channel == Channel::steer ? g : g * row.readings.back();
    }
    if (kinematics_ && !kinematics_->move(one_row_, 0, more)) {
      refuse("a steering angle of " + short_text(row.readings.back() + more) +
             " rad, which the model's steering effects lead to, leaves the measured wheel no way "
             "ahead");
    }
    return gyro_share(one_row_, 0, row.yaw_rate, row.duration, robot_, noise_);
  }

  /// The row less what the effects add to it; `after` is where it leads as far as is known.
  ReckonedRow cleared(const ReckonedRow& row, const GyroShare& gyro, const CausalRow& facts,
                      std::span<const double> covariates, const Reckoning& after) {
    const Pose middle = middle_of(after);
    const Pose end = after.map_pose(after.reckoner.at().pose);
    RowMotion shown = row_motion(gyro, row.duration, robot_);
    if (kinematics_) shown.wheels = &one_row_.wheels;
    DrivePattern more;
    drives_.fill(facts, middle, covariates);
    for (const OnlineTerm& term : drives_.all()) {
      const DrivePattern unit = drive_pattern(term.channel, drives_.value(term), shown);
      more.advance += term.coefficient * unit.advance;
      more.slip += term.coefficient * unit.slip;
      more.turn += term.coefficient * unit.turn;
    }
    ReckonedRow clear = row;
    const WheelTravel turned = wheel_travel({0.0, 0.0, more.turn}, robot_);
    clear.travel = {row.travel.left + more.advance + turned.left,
                    row.travel.right + more.advance + turned.right};
    clear.slip = more.slip;
    clear.noise = noise_of(clear, gyro);
    if (std::isnan(row.reading)) return clear;
    readings_.fill(facts, end, covariates);
    for (const OnlineTerm& term : readings_.all()) {
      clear.reading -= term.coefficient * readings_.value(term);
    }
    return clear;
  }

  /// Where a row leads from now.
  [[nodiscard]] Reckoning reckoned(ReckonedRow row) const {
    Reckoning after = now_;
    const double reading = row.reading;
    if (inputs_.compass && !now_.heading_known) {
      row.reading = kAbsent;
      after.reckoner.take(row, robot_, noise_);
      after.turned_variance += covariance_of(row, robot_, noise_)(2, 2);
      if (std::isnan(reading)) return after;
      after.start_map.heading = wrap_angle(reading - after.reckoner.at().pose.heading);
      after.reckoner.add_first_variance(reading_variance(noise_) + after.turned_variance);
      after.heading_known = true;
      return after;
    }
    row.reading -= now_.start_map.heading;
    after.reckoner.take(row, robot_, noise_);
    return after;
  }

  Robot robot_;
  Noise noise_;
  OdometryInputs inputs_;
  std::optional<WheelKinematics> kinematics_;  ///< of other wheels than two
  Drive one_row_;                              ///< the row at hand
  OnlineTerms steering_{OnlineTerms::Instant::middle};
  OnlineTerms drives_{OnlineTerms::Instant::middle};
  OnlineTerms readings_{OnlineTerms::Instant::end};
  OnlineTerms views_{OnlineTerms::Instant::end};
  OnlineTerms delays_{OnlineTerms::Instant::end};
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
