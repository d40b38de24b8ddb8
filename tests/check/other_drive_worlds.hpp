// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings of robots with other drives than two wheels, with every other sensor: along streets of
// a town, round its corners, past landmarks in the middle of each street.
#pragma once

#include "other_drives.hpp"
#include "trussmap/recording.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::testing {

struct Sensors {
  bool compass = false;
  bool gyro = false;
  bool truth = false;
  bool survey = false;
  bool views = false;
  bool fixes = false;

  [[nodiscard]] bool turns() const { return compass || gyro; }
  [[nodiscard]] bool places() const { return truth || survey || views || fixes; }
  [[nodiscard]] std::string text() const {
    return std::string(compass ? "compass " : "") + (gyro ? "gyro " : "") +
           (truth ? "truth " : "") + (survey ? "survey " : "") + (views ? "views " : "") +
           (fixes ? "fixes " : "");
  }
};

/// All of them, and each alone.
inline std::vector<Sensors> all_sensors() {
  return {{true, true, true, true, true, true},
          {.compass = true},
          {.gyro = true},
          {.truth = true},
          {.survey = true},
          {.views = true},
          {.fixes = true}};
}

struct DriveWorld {
  Recording recording;  ///< columns as a folder has them
  Model model;
  DriveKind kind = DriveKind::wheels;
  Sensors sensors;
  std::mt19937_64 random;

  [[nodiscard]] std::vector<double>& column(std::size_t k) {
    return recording.drive.covariates[k].values;
  }
  [[nodiscard]] const std::string& name(std::size_t k) const { return model.robot.columns[k]; }
};

/// Streets of 4 m in a town of 4 x 3 blocks; corners are arcs of 1 m.
class Town {
 public:
  explicit Town(std::mt19937_64& random) : random_(random) {}

  struct Stop {
    std::size_t row = 0;  ///< at whose end the robot is there
    std::string landmark;
  };

  /// Poses at the rows' ends, after the first one, of so many streets.
  void drive(int streets, double speed) {
    step_ = speed * kOtherRow;
    poses_.push_back({2.0, 0.0, 0.0});
    for (int k = 0; k < streets; ++k) {
      const Pose& at = poses_.back();
      const int quarter = static_cast<int>(std::lround(at.heading / kQuarter));
      std::vector<int> ways;  // quarter turns at the crossing ahead
      for (const int turn : {-1, 0, 1}) {
        const Vector2 ahead = rotation(kQuarter * quarter).col(0);
        const Vector2 next =
            at.position() + 2.0 * ahead + 2.0 * rotation(kQuarter * (quarter + turn)).col(0);
        if (next.x() > -0.1 && next.x() < 16.1 && next.y() > -0.1 && next.y() < 12.1) {
          ways.push_back(turn);
        }
      }
      const int turn = ways[random_() % ways.size()];
      if (turn == 0) {
        go(4.0, 0.0);
      } else {
        go(1.0, 0.0);
        go(0.5 * std::numbers::pi, turn);
        go(1.0, 0.0);
      }
      Pose& end = poses_.back();
      stops_.push_back({poses_.size() - 2, "street " + std::to_string(std::lround(end.x)) + "/" +
                                               std::to_string(std::lround(end.y))});
      places_[stops_.back().landmark] = end.position();
      if (k % 3 == 0) poses_.insert(poses_.end(), 15, Pose(poses_.back()));  // rest
    }
  }
  [[nodiscard]] const std::vector<Pose>& poses() const { return poses_; }
  [[nodiscard]] const std::vector<Stop>& stops() const { return stops_; }
  [[nodiscard]] const std::map<std::string, Vector2>& places() const { return places_; }

 private:
  static constexpr double kQuarter = 0.5 * std::numbers::pi;

  void go(double length, double curvature) {
    const auto rows = static_cast<int>(std::ceil(length / step_));
    const double way = length / rows;
    for (int k = 0; k < rows; ++k) {
      poses_.push_back(after(poses_.back(), {way, 0.0, curvature * way}));
    }
  }

  std::mt19937_64& random_;
  double step_ = 0.0;
  std::vector<Pose> poses_;
  std::vector<Stop> stops_;
  std::map<std::string, Vector2> places_;
};

inline Twist twist_between(const Pose& from, const Pose& to) {
  const double a = to.heading - from.heading;
  const double chord = std::abs(a) < 1e-12 ? 1.0 : std::sin(0.5 * a) / (0.5 * a);
  const Vector2 way = rotation(-from.heading - 0.5 * a) * (to.position() - from.position()) / chord;
  return {way.x(), way.y(), a};
}

/// What the columns show, with noise; at rest the steering stays.
inline std::vector<double> shown_by(const OtherDrive& drive, const Wheels& wheels, const Twist& row,
                                    std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  if (row.f == 0.0 && row.s == 0.0 && row.a == 0.0) {
    return std::vector<double>(drive.model.robot.columns.size(), 0.0);
  }
  std::vector<double> shown = wheels(row);
  for (std::size_t n = 0; n < shown.size(); ++n) {
    const bool steers = drive.steers && n == 1;
    shown[n] += normal(random) * (steers ? 0.01 : 0.004 * std::sqrt(std::abs(shown[n])));
  }
  return shown;
}

inline DriveWorld drive_world(DriveKind kind, const Sensors& sensors, std::uint64_t seed,
                              bool effect = false) {
  DriveWorld world;
  world.random.seed(seed);
  world.kind = kind;
  world.sensors = sensors;
  const OtherDrive drive = other_drive(kind);
  world.model = drive.model;
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto noise = [&](double sd) { return sd * normal(world.random); };
  Town town(world.random);
  town.drive(60, 0.4 + 0.1 * uniform(world.random));
  std::vector<Pose> poses = town.poses();
  if (kind == DriveKind::omni3 || kind == DriveKind::mecanum || kind == DriveKind::wheels) {
    const double phase = 3.0 * uniform(world.random);
    double psi = 0.0;  // looks to the sides as it goes, not at rest
    for (std::size_t k = 0; k < poses.size(); ++k) {
      if (k > 0 && town.poses()[k].position() != town.poses()[k - 1].position()) psi += 0.015;
      poses[k].heading += 0.7 * std::sin(psi + phase);
    }
  }
  Wheels wheels = drive.wheels;
  if (effect) {
    const Channel channel = drive.constants[world.random() % drive.constants.size()];
    wheels = with_effect(drive, channel, 0.03 * uniform(world.random));
  }
  Recording& recording = world.recording;
  recording.name = "drive";
  for (const std::string& name : world.model.robot.columns) {
    recording.drive.covariates.push_back({name, {}});
  }
  const double bias = noise(0.002);
  for (std::size_t k = 0; k + 1 < poses.size(); ++k) {
    const double t = kOtherRow * static_cast<double>(k + 1);
    const Pose& at = poses[k + 1];
    const Twist row = twist_between(poses[k], at);
    recording.drive.t.push_back(t);
    const std::vector<double> shown = shown_by(drive, wheels, row, world.random);
    for (std::size_t n = 0; n < shown.size(); ++n) world.column(n).push_back(shown[n]);
    if (sensors.compass) recording.drive.heading.push_back(wrap_angle(at.heading + noise(0.03)));
    if (sensors.gyro) recording.drive.yaw_rate.push_back(row.a / kOtherRow + bias + noise(0.005));
    if (sensors.truth && k % 3 == 0) {
      recording.truth.push_back(
          {t, at.x + noise(0.005), at.y + noise(0.005), wrap_angle(at.heading + noise(0.005))});
    }
  }
  for (std::size_t row = 9; sensors.fixes && row < recording.drive.rows(); row += 10) {
    const Pose& at = poses[row + 1];
    recording.fixes.push_back({recording.drive.t[row], at.x + noise(0.05), at.y + noise(0.05)});
  }
  for (const Town::Stop& stop : town.stops()) {
    recording.sightings.push_back({recording.drive.t[stop.row], stop.landmark});
  }
  for (std::size_t row = 4; sensors.views && row < recording.drive.rows(); row += 10) {
    for (const auto& [name, place] : town.places()) {
      const Vector2 seen = rotation(-poses[row + 1].heading) * (place - poses[row + 1].position());
      if (seen.norm() > 5.0 || seen.norm() < 0.3) continue;
      recording.sightings.push_back({recording.drive.t[row], name, seen.norm() + noise(0.03),
                                     wrap_angle(direction(seen) + noise(0.02))});
    }
  }
  std::stable_sort(recording.sightings.begin(), recording.sightings.end(),
                   [](const Sighting& a, const Sighting& b) { return a.t < b.t; });
  for (const auto& [name, place] : town.places()) {
    if (sensors.survey) recording.survey.push_back({name, place.x(), place.y()});
  }
  return world;
}

}  // namespace trussmap::testing
