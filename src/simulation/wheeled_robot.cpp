// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/simulation/wheeled_robot.hpp"

#include "trussmap/core/index.hpp"
#include "trussmap/simulation/random_stream.hpp"

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

namespace trussmap {
namespace {

/// Chance, of one kind.
class Dice {
 public:
  Dice(std::uint64_t seed, Stream stream) : random_(random_stream(seed, stream)) {}

  double deviation(double sd) { return sd * normal_(random_); }
  bool falls(double share) {
    return std::uniform_real_distribution<double>(0.0, 1.0)(random_) < share;
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

/// What the sensors would say of a row without noise.
struct SensorRow {
  double left = 0.0;     ///< m
  double right = 0.0;    ///< m
  double heading = 0.0;  ///< rad, not wrapped
};

SensorRow sense(const TrueRow& row, const WheeledRobot& robot) {
  const double speed_about_centre = row.turn_rate * 0.5 * robot.wheelbase;
  return {(row.speed - speed_about_centre) * row.duration,
          (row.speed + speed_about_centre) * row.duration, row.pose.heading};
}

Drive record_drive(const TrueMotion& motion, const WheeledRobot& robot, std::uint64_t seed) {
  Dice wheels(seed, Stream::wheels);
  Dice compass(seed, Stream::compass);
  Drive drive;
  Covariate payload{"payload_kg", {}};
  Covariate lights{"lights", {}};
  Covariate temperature{"temperature_C", {}};
  for (const TrueRow& row : motion.rows) {
    const SensorRow seen = sense(row, robot);
    drive.t.push_back(row.t);
    drive.left.push_back(seen.left +
                         wheels.deviation(robot.noise.left * std::sqrt(std::abs(seen.left))));
    drive.right.push_back(seen.right +
                          wheels.deviation(robot.noise.right * std::sqrt(std::abs(seen.right))));
    if (robot.compass) {
      drive.heading.push_back(wrap_angle(seen.heading + compass.deviation(robot.noise.compass)));
    }
    payload.values.push_back(row.surroundings.payload_kg);
    lights.values.push_back(row.surroundings.lights);
    temperature.values.push_back(row.surroundings.temperature_C);
  }
  drive.covariates = {payload, lights, temperature};
  return drive;
}

/// Standing on the landmark first, then what the range sensor sees from there.
std::vector<Sighting> sight(const TrueStop& stop, const Mesh& mesh, const WheeledRobot& robot,
                            Dice& dice) {
  std::vector<Sighting> sightings = {{stop.t, landmark_name(mesh, stop.landmark)}};
  if (!robot.range_sensor) return sightings;
  for (int k = 0; k < mesh.landmarks(); ++k) {
    const Vector2 view = mesh.positions[idx(k)] - stop.pose.position();
    if (k == stop.landmark || view.norm() > robot.reach) continue;
    const bool recognised = dice.falls(robot.recognition);
    const double range = view.norm() + dice.deviation(robot.noise.range);
    const double bearing =
        wrap_angle(direction(view) - stop.pose.heading + dice.deviation(robot.noise.bearing));
    if (recognised && range > 0.0) {
      sightings.push_back({stop.t, landmark_name(mesh, k), range, bearing});
    }
  }
  return sightings;
}

void check(const WheeledRobot& robot) {
  const SensorNoise& noise = robot.noise;
  for (const double sd : {noise.left, noise.right, noise.compass, noise.range, noise.bearing}) {
    if (!std::isfinite(sd) || sd < 0.0) {
      throw std::invalid_argument("a sensor's noise must be a number of 0 or more");
    }
  }
  if (!std::isfinite(robot.wheelbase) || robot.wheelbase <= 0.0) {
    throw std::invalid_argument("the wheelbase must be above 0 m");
  }
  if (!(robot.reach > 0.0) || !(robot.recognition >= 0.0 && robot.recognition <= 1.0)) {
    throw std::invalid_argument("the range sensor must reach above 0 m and recognise 0 to 1");
  }
}

}  // namespace

Recording record(const TrueMotion& motion, const Mesh& mesh, const WheeledRobot& robot,
                 std::uint64_t seed) {
  check(robot);
  Dice dice(seed, Stream::range);
  Recording recording;
  recording.name = "simulation";
  recording.drive = record_drive(motion, robot, seed);
  for (const TrueStop& stop : motion.stops) {
    for (const Sighting& sighting : sight(stop, mesh, robot, dice)) {
      recording.sightings.push_back(sighting);
    }
  }
  return recording;
}

std::vector<SurveyPoint> survey(const Mesh& mesh, double sd, std::uint64_t seed) {
  if (!std::isfinite(sd) || sd < 0.0) {
    throw std::invalid_argument("the survey's noise must be a number of 0 or more");
  }
  Dice dice(seed, Stream::survey);
  std::vector<SurveyPoint> points;
  for (int k = 0; k < mesh.landmarks(); ++k) {
    const Vector2& position = mesh.positions[idx(k)];
    const double dx = dice.deviation(sd);
    const double dy = dice.deviation(sd);
    points.push_back({landmark_name(mesh, k), position.x() + dx, position.y() + dy});
  }
  return points;
}

SimulatedDrive simulate_drive(const Mesh& mesh, const std::vector<int>& walk,
                              const DrivingStyle& style, const WheeledRobot& robot,
                              std::uint64_t seed) {
  SimulatedDrive drive;
  drive.motion = lay_path(mesh, walk, style, seed);
  drive.recording = record(drive.motion, mesh, robot, seed);
  drive.recording.survey = survey(mesh, robot.noise.survey, seed);
  return drive;
}

}  // namespace trussmap
