// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/wheeled_robot.hpp"

#include "geometry/index.hpp"
#include "simulation/tours.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include <gtest/gtest.h>

namespace trussmap::wheeled_robot_test {
namespace {

struct Field {
  Mesh mesh;
  std::vector<int> walk;
  DrivingStyle style;
  WheeledRobot robot;
};

Field field(int tours) {
  std::mt19937_64 random(41);
  Field f;
  const std::vector<double> x = random_lines(6, 3.0, 7.0, random);
  const std::vector<double> y = random_lines(6, 3.0, 7.0, random);
  f.mesh = jittered(mesh_of_lines(x, y), 0.3, random);
  f.walk = make_tours(f.mesh, WalkKind::euler, tours, random).walk;
  f.style.rest_share = 0.05;
  f.style.full_spins = 2;
  return f;
}

SimulatedDrive simulate(const Field& f, std::uint64_t seed) {
  return simulate_drive(f.mesh, f.walk, f.style, f.robot, seed);
}

/// The differential drive's equation of motion, integrated in many small steps (midpoint rule)
/// at constant wheel speeds over the row.
Pose roll(Pose pose, double left, double right, double wheelbase) {
  constexpr int steps = 200;
  const double ds = 0.5 * (left + right) / steps;
  const double turn = (right - left) / wheelbase / steps;
  for (int k = 0; k < steps; ++k) {
    pose.x += ds * std::cos(pose.heading + 0.5 * turn);
    pose.y += ds * std::sin(pose.heading + 0.5 * turn);
    pose.heading += turn;
  }
  return pose;
}

TEST(WheeledRobot, WithoutNoiseItsWheelsLeadToEveryLandmark) {
  Field f = field(2);
  f.robot.noise = kNoiseFree;
  f.style.standing = 0.0;
  const Recording recording = simulate(f, 1).recording;
  const Drive& drive = recording.drive;
  const Vector2 origin = f.mesh.positions[idx(f.walk[0])];
  Pose pose{origin.x(), origin.y(), 0.0};
  double length = 0.0;
  std::size_t row = 0;
  ASSERT_EQ(recording.sightings.size(), f.walk.size());
  for (std::size_t k = 0; k < f.walk.size(); ++k) {
    for (; row < drive.rows() && drive.t[row] <= recording.sightings[k].t; ++row) {
      pose = roll(pose, drive.left[row], drive.right[row], f.robot.geometry.wheelbase);
      length += 0.5 * std::abs(drive.left[row] + drive.right[row]);
      EXPECT_NEAR(wrap_angle(pose.heading - drive.heading[row]), 0.0, 1e-9);
    }
    EXPECT_EQ(recording.sightings[k].landmark, landmark_name(f.mesh, f.walk[k]));
    EXPECT_LE((pose.position() - f.mesh.positions[idx(f.walk[k])]).norm(), 1e-6 * (1.0 + length));
  }
  EXPECT_EQ(row, drive.rows());
  EXPECT_GT(length, 600.0);
}

TEST(WheeledRobot, SightingsLieWithinTheDrive) {
  const Recording recording = simulate(field(1), 2).recording;
  EXPECT_EQ(recording.sightings.front().t, recording.drive.start());
  EXPECT_EQ(recording.sightings.back().t, recording.drive.t.back());
  EXPECT_TRUE(std::is_sorted(recording.sightings.begin(), recording.sightings.end(),
                             [](const Sighting& a, const Sighting& b) { return a.t < b.t; }));
  const std::vector<double>& t = recording.drive.t;
  EXPECT_EQ(std::adjacent_find(t.begin(), t.end(), std::greater_equal<>()), t.end());
  for (const double heading : recording.drive.heading) {
    EXPECT_GT(heading, -3.1415926535897936);
    EXPECT_LE(heading, 3.1415926535897936);
  }
}

TEST(WheeledRobot, WheelNoiseGrowsWithTheTravel) {
  // (d - d0)^2 / (k^2 |d0|) is chi-square with one degree of freedom: mean 1, variance 2. Both
  // halves, of the longer and of the shorter travels, must show it: 4 sqrt(2/n).
  Field f = field(1);
  f.robot.noise.left = 0.002;
  f.robot.noise.right = 0.006;
  const Drive noisy = simulate(f, 3).recording.drive;
  f.robot.noise = kNoiseFree;
  const Drive quiet = simulate(f, 3).recording.drive;
  ASSERT_EQ(noisy.rows(), quiet.rows());
  const auto expect_variance = [](const std::vector<double>& found,
                                  const std::vector<double>& truth, double k, bool longer) {
    double sum = 0.0;
    double n = 0.0;
    for (std::size_t row = 0; row < found.size(); ++row) {
      if (truth[row] == 0.0) {
        EXPECT_EQ(found[row], 0.0) << "at rest";
      }
      if (truth[row] == 0.0 || (std::abs(truth[row]) > 0.05) != longer) continue;
      sum += std::pow(found[row] - truth[row], 2) / (k * k * std::abs(truth[row]));
      ++n;
    }
    ASSERT_GT(n, 1000.0);
    EXPECT_NEAR(sum / n, 1.0, 4.0 * std::sqrt(2.0 / n));
  };
  for (const bool longer : {false, true}) {
    expect_variance(noisy.left, quiet.left, 0.002, longer);
    expect_variance(noisy.right, quiet.right, 0.006, longer);
  }
}

TEST(WheeledRobot, CompassNoiseIsAsStated) {
  Field f = field(1);
  f.robot.noise.compass = 0.05;
  const SimulatedDrive simulated = simulate(f, 4);
  double sum = 0.0;
  double squares = 0.0;
  const auto n = static_cast<double>(simulated.motion.rows.size());
  for (std::size_t k = 0; k < simulated.motion.rows.size(); ++k) {
    const double error =
        wrap_angle(simulated.recording.drive.heading[k] - simulated.motion.rows[k].pose.heading);
    sum += error / n;
    squares += error * error / n;
  }
  EXPECT_NEAR(sum, 0.0, 4.0 * 0.05 / std::sqrt(n));
  EXPECT_NEAR(squares, 0.05 * 0.05, 4.0 * 0.05 * 0.05 * std::sqrt(2.0 / n));
}

TEST(WheeledRobot, RangeSensorSeesSomeOfWhatIsInReach) {
  Field f = field(3);
  f.robot.range_sensor = true;
  f.robot.noise.range = 0.04;
  const SimulatedDrive simulated = simulate(f, 5);
  std::map<std::string, int> number;
  for (int k = 0; k < f.mesh.landmarks(); ++k) number[landmark_name(f.mesh, k)] = k;
  std::size_t stop = 0;
  double n = 0.0;
  double range_squares = 0.0;
  double bearing_squares = 0.0;
  double in_reach = 0.0;
  for (const TrueStop& s : simulated.motion.stops) {
    for (int k = 0; k < f.mesh.landmarks(); ++k) {
      const double away = (f.mesh.positions[idx(k)] - s.pose.position()).norm();
      in_reach += k != s.landmark && away <= f.robot.reach ? 1.0 : 0.0;
    }
  }
  for (const Sighting& sighting : simulated.recording.sightings) {
    while (simulated.motion.stops[stop].t < sighting.t) ++stop;
    const Pose& pose = simulated.motion.stops[stop].pose;
    ASSERT_EQ(simulated.motion.stops[stop].t, sighting.t);
    if (sighting.standing()) {
      EXPECT_EQ(number[sighting.landmark], simulated.motion.stops[stop].landmark);
      continue;
    }
    const Vector2 seen =
        pose.position() + sighting.range * Vector2(std::cos(pose.heading + sighting.bearing),
                                                   std::sin(pose.heading + sighting.bearing));
    const Vector2 truth = f.mesh.positions[idx(number[sighting.landmark])];
    const Vector2 view = (truth - pose.position()).normalized();
    range_squares += std::pow(view.dot(seen - truth) / 0.04, 2);
    bearing_squares += std::pow(view.dot(quarter_turn(seen - truth)) / sighting.range / 0.02, 2);
    ++n;
  }
  // In the eye's own axes the two errors are the sensor's to first order (second order: 2e-3).
  EXPECT_NEAR(range_squares / n, 1.0, 4.0 * std::sqrt(2.0 / n) + 0.01);
  EXPECT_NEAR(bearing_squares / n, 1.0, 4.0 * std::sqrt(2.0 / n) + 0.01);
  EXPECT_NEAR(n / in_reach, 0.5, 4.0 * 0.5 / std::sqrt(in_reach));
}

TEST(WheeledRobot, SurveyErrsAsStated) {
  const Mesh mesh = even_mesh({30, 30}, 1.0);
  const std::vector<SurveyPoint> points = simulation::survey(mesh, 0.01, 6);
  double squares = 0.0;
  for (std::size_t k = 0; k < points.size(); ++k) {
    EXPECT_EQ(points[k].landmark, landmark_name(mesh, static_cast<int>(k)));
    squares += (Vector2(points[k].x, points[k].y) - mesh.positions[k]).squaredNorm();
  }
  EXPECT_NEAR(squares / 1800.0, 1e-4, 4.0 * 1e-4 * std::sqrt(2.0 / 1800.0));
}

bool equal_drives(const Drive& a, const Drive& b) {
  for (std::size_t k = 0; k < a.covariates.size(); ++k) {
    if (a.covariates[k].values != b.covariates[k].values) return false;
  }
  return a.t == b.t && a.left == b.left && a.right == b.right && a.heading == b.heading;
}

TEST(WheeledRobot, RecordingIsDrawnFromItsSeed) {
  const Field f = field(1);
  EXPECT_TRUE(equal_drives(simulate(f, 7).recording.drive, simulate(f, 7).recording.drive));
  EXPECT_FALSE(equal_drives(simulate(f, 7).recording.drive, simulate(f, 8).recording.drive));
}

TEST(WheeledRobot, LeavingASensorOutChangesNothingElse) {
  Field f = field(1);
  f.robot.range_sensor = true;
  const Recording with = simulate(f, 9).recording;
  f.robot.range_sensor = false;
  f.robot.compass = false;
  const Recording without = simulate(f, 9).recording;
  EXPECT_FALSE(without.drive.has_compass());
  EXPECT_EQ(with.drive.left, without.drive.left);
  EXPECT_EQ(with.drive.right, without.drive.right);
  EXPECT_GT(with.sightings.size(), without.sightings.size());
  EXPECT_EQ(with.survey.back().x, without.survey.back().x);
}

TEST(WheeledRobot, RefusesSensorsThatMakeNoSense) {
  const Field f = field(1);
  for (const auto spoil : std::vector<void (*)(WheeledRobot&)>{
           [](WheeledRobot& r) { r.geometry.wheelbase = 0.0; },
           [](WheeledRobot& r) { r.noise.left = -0.1; },
           [](WheeledRobot& r) { r.noise.compass = std::nan(""); },
           [](WheeledRobot& r) { r.noise.survey = -1.0; }, [](WheeledRobot& r) { r.reach = 0.0; },
           [](WheeledRobot& r) { r.recognition = 2.0; }}) {
    Field bad = f;
    spoil(bad.robot);
    EXPECT_THROW((void)simulate(bad, 1), std::invalid_argument);
  }
}

}  // namespace
}  // namespace trussmap::wheeled_robot_test
