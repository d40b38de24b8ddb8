// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/body_motion.hpp"
#include "drive/row_variables.hpp"
#include "effects/channel_physics.hpp"
#include "effects/corrected_recording.hpp"
#include "estimation/kinds/sighted.hpp"
#include "estimation/noise_states.hpp"
#include "fit/replica_stages.hpp"
#include "odometry/wheels_and_gyro.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Eigenvalues>

namespace trussmap::fitting {
namespace {

/// A value of a row, and what the effects add to it.
double with_effects(double value, const Replica& replica,
                    const std::vector<const std::vector<effects::DrivePattern>*>& patterns,
                    std::size_t row, double effects::DrivePattern::*part) {
  for (std::size_t k = 0; k < patterns.size(); ++k) {
    if (patterns[k] == nullptr) continue;
    value += replica.offsets[static_cast<Eigen::Index>(k)] * (*patterns[k])[row].*part;
  }
  return value;
}

/// Of other wheels than two: what their noise does to the body.
void disturb_columns(std::size_t row, const Model& model, MotionRows& drive,
                     statistics::NormalDraws& draw) {
  const ArcNoise own =
      odometry::row_noise(drive, row, 1.0, drive.duration(row), model.robot, model.noise);
  Matrix3 Q;
  Q << own.along, own.along_lateral, own.shared,            //
      own.along_lateral, own.lateral, own.heading_lateral,  //
      own.shared, own.heading_lateral, own.heading;
  const Eigen::SelfAdjointEigenSolver<Matrix3> axes(Q);
  Eigen::Vector3d more = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    more += draw(std::sqrt(std::max(axes.eigenvalues()[k], 0.0))) * axes.eigenvectors().col(k);
  }
  drive::add_motion(drive, row, {more[0], more[1], more[2]}, model.robot);
}

/// g of a process's channel, drawn for every row's end.
std::vector<double> drawn_gains(const NoiseProcess& process, const MotionRows& drive,
                                const std::vector<double>& ends_of_legs,
                                statistics::NormalDraws& draw) {
  const bool way = estimation::goes_with_distance(process.process);
  std::vector<double> g(drive.rows(), 0.0);
  double value = estimation::is_walk(process.process) ? 0.0 : draw(process.sd);
  int leg = 0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double lag = way ? std::abs(drive.forward[row]) : drive.duration(row);
    const double middle = drive.t[row] - 0.5 * drive.duration(row);
    const double before = value;
    switch (process.process) {
      case ProcessKind::white:
        value = draw(process.sd);
        break;
      case ProcessKind::per_leg: {
        const int at = estimation::leg_at(ends_of_legs, middle);
        if (at != leg) value = draw(process.sd);
        leg = at;
        break;
      }
      case ProcessKind::per_session:
      case ProcessKind::per_pass:
        break;
      case ProcessKind::correlated_in_t:
      case ProcessKind::correlated_in_distance: {
        const double keep = std::exp(-lag / process.length);
        value = keep * value + draw(process.sd * std::sqrt(1.0 - keep * keep));
        break;
      }
      case ProcessKind::walk_in_t:
      case ProcessKind::walk_in_distance:
        value += draw(process.sd * std::sqrt(lag));
        break;
    }
    // Wheels take the mean over a row, of a chain nearly that of its ends.
    const bool mean =
        is_chain(process.process) && effects::acts_on(process.channel) == effects::ActsOn::drives;
    g[row] = mean ? 0.5 * (before + value) : value;
  }
  return g;
}

void add_to_fixes(const NoiseProcess& process, const std::vector<double>& g,
                  DrivenRecording& recording, statistics::NormalDraws& draw) {
  for (Fix& one : recording.fixes) {
    const bool white = process.process == ProcessKind::white;
    const double value = white ? draw(process.sd) : g[drive::row_at(recording.drive, one.t)];
    (process.channel == Channel::fix_x ? one.x : one.y) += value;
  }
}

void add_to_sightings(const NoiseProcess& process, const std::vector<double>& g,
                      DrivenRecording& recording, statistics::NormalDraws& draw) {
  struct Pass {
    double seen = 0.0;
    double value = 0.0;
  };
  std::map<std::string, Pass> passes;
  for (Sighting& one : recording.sightings) {
    if (one.standing() && process.channel != Channel::sighting_yaw) continue;
    double value = g[drive::row_at(recording.drive, one.t)];
    if (process.process == ProcessKind::white) value = draw(process.sd);
    if (process.process == ProcessKind::per_pass) {
      const auto [at, fresh] = passes.try_emplace(one.landmark, Pass{});
      if (fresh || one.t - at->second.seen > estimation::kLongestGap)
        at->second.value = draw(process.sd);
      at->second.seen = one.t;
      value = at->second.value;
    }
    one = effects::without(process.channel, value, one);
    one.range = std::max(one.range, estimation::kLeastDrawnRange);
  }
}

}  // namespace

void part_wheels_and_gyro(std::size_t session, Replica& replica, statistics::NormalDraws& draw) {
  MotionRows& drive = replica.timed[session].drive;
  const auto patterns = estimation::drive_patterns(replica.border, session);
  const Robot& robot = replica.fit.model.robot;
  for (std::size_t row = 0; row < drive.gyro.size(); ++row) {
    const GyroShare& gyro = drive.gyro[row];
    if (!std::isfinite(gyro.variance)) continue;
    const double excess = with_effects(0.0, replica, patterns, row, &effects::DrivePattern::excess);
    drive::add_motion(drive, row, excess * BodyMotion{gyro.along, gyro.lateral, gyro.turn}, robot);
    const double duration = drive.duration(row);
    const double turn = drive.turn[row] - excess;
    drive.yaw_rate[row] =
        (turn + draw(replica.fit.model.noise.gyro * std::sqrt(duration))) / duration;
  }
  if (drive.gyro.empty()) return;
  drive.gyro.clear();
  for (std::size_t row = 0; row < drive.pair.left.size(); ++row) {
    const WheelTravel own = drive::wheel_travel(drive.motion(row), robot);
    drive.pair.left[row] = own.left;
    drive.pair.right[row] = own.right;
  }
}

void disturb_drive(std::size_t session, Replica& replica, statistics::NormalDraws& draw) {
  MotionRows& drive = replica.timed[session].drive;
  const Noise& noise = replica.fit.model.noise;
  const auto patterns = estimation::drive_patterns(replica.border, session);
  const Robot& robot = replica.fit.model.robot;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double duration = drive.duration(row);
    const double turn = std::abs(drive.turn[row]);
    const double heading = draw(std::sqrt(noise.heading_per_s * noise.heading_per_s * duration +
                                          noise.heading_per_rad * noise.heading_per_rad * turn));
    const double travel = draw(noise.travel_per_s * std::sqrt(duration));
    if (drive.wheels.empty()) {
      const auto [left, right] = drive::own_travel(drive, row, robot);
      const double of_left = draw(noise.left * std::sqrt(std::abs(left)));
      const double of_right = draw(noise.right * std::sqrt(std::abs(right)));
      const Vector2 more = drive::by_travel(drive, robot) * Vector2(of_left, of_right);
      drive::add_motion(drive, row, {more[0] + travel, 0.0, more[1] + heading}, robot);
    } else {
      disturb_columns(row, replica.fit.model, drive, draw);
    }
    if (!drive.has_compass() || std::isnan(drive.heading[row])) continue;
    const double shown = with_effects(replica.paths[session].ends[row].heading, replica, patterns,
                                      row, &effects::DrivePattern::compass);
    drive.heading[row] = wrap_angle(shown + draw(noise.compass));
  }
}

void add_process(const NoiseProcess& process, std::size_t session, Replica& replica,
                 statistics::NormalDraws& draw) {
  const bool of_fixes = process.channel == Channel::fix_x || process.channel == Channel::fix_y;
  if (!of_fixes && !effects::is_recordable(process.channel)) {
    throw std::invalid_argument("noise of channel \"" + std::string(name_of(process.channel)) +
                                "\" cannot be drawn: no recording can hold it");
  }
  DrivenRecording& recording = replica.timed[session];
  MotionRows& drive = recording.drive;
  // Legs of the recording as it was: rests may be none any more.
  const std::vector<double> g =
      drawn_gains(process, drive, estimation::ends_of_legs(replica.fit.recordings[session]), draw);
  if (of_fixes) {
    add_to_fixes(process, g, recording, draw);
    return;
  }
  switch (effects::acts_on(process.channel)) {
    case effects::ActsOn::readings:
      for (std::size_t row = 0; row < drive.heading.size(); ++row) {
        drive.heading[row] = wrap_angle(drive.heading[row] + g[row]);
      }
      return;
    case effects::ActsOn::drives:
      effects::free_drive(process.channel, g, replica.fit.model.robot, drive);
      return;
    case effects::ActsOn::views:
      add_to_sightings(process, g, recording, draw);
      return;
  }
}

}  // namespace trussmap::fitting
