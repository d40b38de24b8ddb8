// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Noise that is not what a robot states. Errors are counted in stated standard deviations:
//
//   wheel    (recorded - sensed without noise) / (k sqrt|sensed|)
//   compass  (recorded - true heading) / sd
//
// Statistics may be off by four of their standard deviations.
#include "simulation/rough_noise.hpp"

#include "criticism/noisy_recordings.hpp"
#include "geometry/index.hpp"
#include "simulation/wheeled_robot.hpp"
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::rough_noise_test {
namespace {

using std::numbers::pi;

/// Without rests: there a wheel has no travel, and no error.
struct World {
  Mesh mesh;
  std::vector<int> walk;
  DrivingStyle style;
  WheeledRobot robot;
  SimulatedEffects effects;
};

World world(int tours) {
  std::mt19937_64 random(17);
  World w;
  w.mesh = mesh_of_lines({0.0, 4.0, 9.0, 12.0}, {0.0, 3.0, 7.0, 12.0});
  w.walk = make_tours(w.mesh, WalkKind::euler, tours, random).walk;
  w.robot.noise.left = 0.002;
  w.robot.noise.right = 0.005;
  return w;
}

SimulatedDrive simulate(const World& w, std::uint64_t seed, const std::string& rough = "") {
  WheeledRobot robot = w.robot;
  if (!rough.empty()) robot.rough = parse_rough(rough);
  return simulate_drive(w.mesh, w.walk, w.style, robot, seed, w.effects);
}

/// What the sensors would say without noise, and without its roughness.
Drive sensed(World w, std::uint64_t seed) {
  w.robot.noise = kNoiseFree;
  return simulate(w, seed).recording.drive;
}

struct Errors {
  std::vector<double> left;
  std::vector<double> right;
  std::vector<double> compass;

  [[nodiscard]] std::vector<std::vector<double>> each() const { return {left, right, compass}; }
};

Errors errors_of(const World& w, std::uint64_t seed, const std::string& rough) {
  const Drive noisy = simulate(w, seed, rough).recording.drive;
  const Drive truth = sensed(w, seed);
  const SensorNoise& noise = w.robot.noise;
  Errors errors;
  for (std::size_t row = 0; row < truth.rows(); ++row) {
    errors.left.push_back((noisy.left[row] - truth.left[row]) /
                          (noise.left * std::sqrt(std::abs(truth.left[row]))));
    errors.right.push_back((noisy.right[row] - truth.right[row]) /
                           (noise.right * std::sqrt(std::abs(truth.right[row]))));
    errors.compass.push_back(wrap_angle(noisy.heading[row] - truth.heading[row]) / noise.compass);
  }
  return errors;
}

double mean_power(const std::vector<double>& errors, double power) {
  double sum = 0.0;
  for (const double e : errors) sum += std::pow(std::abs(e), power);
  return sum / static_cast<double>(errors.size());
}

/// Of errors whose mean is known to be 0.
double autocorrelation(const std::vector<double>& errors, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t k = lag; k < errors.size(); ++k) sum += errors[k] * errors[k - lag];
  return sum / static_cast<double>(errors.size()) / mean_power(errors, 2.0);
}

void expect_near_all(const std::vector<double>& found, const std::vector<double>& expected) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    ASSERT_NEAR(found[k], expected[k], 1e-6 * (1.0 + std::abs(expected[k]))) << "row " << k;
  }
}

/// Variance and autocorrelation of a stationary normal process that keeps a share of itself from
/// row to row. With n rows the mean square has relative variance 2/n (1 + a^2)/(1 - a^2); that of
/// the autocorrelation is Bartlett's (Brockwell & Davis, Time Series, 2nd ed., example 7.2.3).
void expect_autoregression(const std::vector<double>& errors, double variance, double kept) {
  const auto n = static_cast<double>(errors.size());
  const double square = kept * kept;
  const double spread = (1.0 + square) / (1.0 - square);
  EXPECT_NEAR(mean_power(errors, 2.0) / variance, 1.0, 4.0 * std::sqrt(2.0 / n * spread));
  for (const int lag : {1, 2, 5, 10, 20, 40}) {
    const double faded = std::pow(square, lag);
    const double sd = std::sqrt(((1.0 - faded) * spread - 2.0 * lag * faded) / n);
    EXPECT_NEAR(autocorrelation(errors, idx(lag)), std::pow(kept, lag), 4.0 * sd) << "lag " << lag;
  }
}

TEST(RoughNoise, IsNamedByItsKinds) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(rough_names({}), Names{});
  EXPECT_EQ(rough_names(parse_rough("haze")), Names{"haze"});
  EXPECT_EQ(rough_names(parse_rough("floor,half,half")), (Names{"half", "floor"}));
  const Names all = {"half", "memory", "haze", "tails", "floor"};
  EXPECT_EQ(rough_names(parse_rough("all")), all);
  EXPECT_EQ(rough_names(parse_rough("tails,memory,floor,haze,half")), all);
}

TEST(RoughNoise, AnotherNameIsRefusedWithAListOfAll) {
  for (const char* text : {"", ",", "half,", ",half", "half, haze", "Half", "fog", "half;haze"}) {
    try {
      (void)parse_rough(text);
      ADD_FAILURE() << "'" << text << "' passed";
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find("half, memory, haze, tails, floor"),
                std::string::npos)
          << error.what();
    }
  }
}

TEST(RoughNoise, WithoutItErrorsAreTheNormalsOfTheirStreamsToTheLastBit) {
  World w = world(2);
  w.style.rest_share = 0.2;
  const Drive noisy = simulate(w, 1).recording.drive;
  const Drive truth = sensed(w, 1);
  std::mt19937_64 random_wheels = random_stream(1, Stream::wheels);
  std::mt19937_64 random_compass = random_stream(1, Stream::compass);
  std::normal_distribution<double> wheels;
  std::normal_distribution<double> compass;
  const SensorNoise& noise = w.robot.noise;
  const std::vector<TrueRow> rows = simulate(w, 1).motion.rows;
  ASSERT_EQ(noisy.rows(), rows.size());
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const double left = noise.left * std::sqrt(std::abs(truth.left[row])) * wheels(random_wheels);
    const double right =
        noise.right * std::sqrt(std::abs(truth.right[row])) * wheels(random_wheels);
    EXPECT_EQ(noisy.left[row], truth.left[row] + left);
    EXPECT_EQ(noisy.right[row], truth.right[row] + right);
    EXPECT_EQ(noisy.heading[row],
              wrap_angle(rows[row].pose.heading + noise.compass * compass(random_compass)));
  }
}

TEST(RoughNoise, HalfIsWhiteAndTwiceAsLarge) {
  // The mean square of n normal errors has relative variance 2/n, their autocorrelation 1/n.
  const World w = world(6);
  for (const std::vector<double>& errors : errors_of(w, 2, "half").each()) {
    const auto n = static_cast<double>(errors.size());
    ASSERT_GT(n, 10000.0);
    EXPECT_NEAR(mean_power(errors, 2.0), 4.0, 4.0 * 4.0 * std::sqrt(2.0 / n));
    for (const std::size_t lag : {1U, 2U, 10U}) {
      EXPECT_NEAR(autocorrelation(errors, lag), 0.0, 4.0 / std::sqrt(n));
    }
  }
}

TEST(RoughNoise, MemoryMakesTheWheelsErrorsLastASecond) {
  for (const double duration : {0.1, 0.5}) {
    World w = world(duration < 0.2 ? 8 : 20);
    w.style.row_duration = duration;
    const double kept = std::exp(-duration / 1.0);
    const Errors errors = errors_of(w, 3, "memory");
    expect_autoregression(errors.left, (1.0 - kept) / (1.0 + kept), kept);
    expect_autoregression(errors.right, (1.0 - kept) / (1.0 + kept), kept);
    // Wheel by wheel: the covariance of two such processes has 1/n (1 + a^2)/(1 - a^2) as its
    // variance, too.
    double both = 0.0;
    for (std::size_t row = 0; row < errors.left.size(); ++row) {
      both += errors.left[row] * errors.right[row];
    }
    const auto n = static_cast<double>(errors.left.size());
    EXPECT_NEAR(both / n * (1.0 + kept) / (1.0 - kept), 0.0,
                4.0 * std::sqrt((1.0 + kept * kept) / (1.0 - kept * kept) / n));
  }
}

TEST(RoughNoise, MemoryAddsUpToWhatIsStatedOverALongLeg) {
  // Legs of 60 m and at least 67 s. A sum's square over its variance has mean 1 and variance 2.
  // Where a leg, or its spin, begins and ends, some 2 rows' share of the variance is lost: rows of
  // up to 0.45 m each time, below 2 % of 60 m.
  World w;
  w.mesh = mesh_of_lines({0.0, 60.0}, {0.0});
  for (int k = 0; k <= 1000; ++k) w.walk.push_back(k % 2);
  w.style.row_duration = 0.5;
  w.style.corner_share = 0.0;
  const SimulatedDrive noisy = simulate(w, 4, "memory");
  const Drive truth = sensed(w, 4);
  const auto expect_sums = [&](const std::vector<double>& found, const std::vector<double>& exact,
                               double k) {
    double mean = 0.0;
    for (std::size_t leg = 1; leg < noisy.motion.stops.size(); ++leg) {
      double error = 0.0;
      double travel = 0.0;
      for (std::size_t row = noisy.motion.stops[leg - 1].rows; row < noisy.motion.stops[leg].rows;
           ++row) {
        error += found[row] - exact[row];
        travel += std::abs(exact[row]);
      }
      mean += error * error / (k * k * travel) / 1000.0;
    }
    EXPECT_NEAR(mean, 1.0, 4.0 * std::sqrt(2.0 / 1000.0) + 0.02);
  };
  expect_sums(noisy.recording.drive.left, truth.left, w.robot.noise.left);
  expect_sums(noisy.recording.drive.right, truth.right, w.robot.noise.right);
}

TEST(RoughNoise, HazeMakesTheCompassErrorsLastTwoSeconds) {
  for (const double duration : {0.1, 0.5}) {
    World w = world(duration < 0.2 ? 12 : 24);
    w.style.row_duration = duration;
    expect_autoregression(errors_of(w, 5, "haze").compass, 1.0, std::exp(-duration / 2.0));
  }
}

/// Distribution of Student's t with 3 degrees of freedom, scaled to variance 1.
double distribution_of_tails(double e) {
  return 0.5 + (e / (1.0 + e * e) + std::atan(e)) / pi;
}

TEST(RoughNoise, TailsAreStudents) {
  const World w = world(6);
  const std::vector<std::vector<double>> tails = errors_of(w, 6, "tails").each();
  const std::vector<std::vector<double>> normal = errors_of(w, 6, "").each();
  for (std::size_t sensor = 0; sensor < 3; ++sensor) {
    std::vector<double> errors = tails[sensor];
    const auto n = static_cast<double>(errors.size());
    ASSERT_GT(n, 10000.0);
    std::sort(errors.begin(), errors.end());
    // Kolmogorov & Smirnov: sqrt(n) times the largest distance exceeds 2.23 once in 10 000.
    double distance = 0.0;
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const double at = distribution_of_tails(errors[k]);
      distance = std::max({distance, std::abs(at - static_cast<double>(k) / n),
                           std::abs(at - static_cast<double>(k + 1) / n)});
    }
    EXPECT_LT(distance * std::sqrt(n), 2.23);
    // |e| has mean 2/pi and, as the variance is 1, mean square 1. The fourth moment is infinite:
    // a mean square, or a kurtosis, could be anything.
    EXPECT_NEAR(mean_power(errors, 1.0), 2.0 / pi, 4.0 * std::sqrt((1.0 - 4.0 / pi / pi) / n));
    const double share = 2.0 * distribution_of_tails(-4.0);  // 0.006; of normal ones 0.00006
    const auto far =
        std::count_if(errors.begin(), errors.end(), [](double e) { return std::abs(e) > 4.0; });
    EXPECT_NEAR(static_cast<double>(far) / n, share, 4.0 * std::sqrt(share / n));
    // That of normal errors is 3 with variance 24/n.
    const auto kurtosis = [](const std::vector<double>& of) {
      return mean_power(of, 4.0) / std::pow(mean_power(of, 2.0), 2);
    };
    EXPECT_NEAR(kurtosis(normal[sensor]), 3.0, 4.0 * std::sqrt(24.0 / n));
    EXPECT_GT(kurtosis(errors), 3.0 + 20.0 * std::sqrt(24.0 / n));
    // White: signs of neighbours agree as often as not.
    double agree = 0.0;
    for (std::size_t k = 1; k < errors.size(); ++k) {
      agree += tails[sensor][k] * tails[sensor][k - 1] > 0.0 ? 1.0 / n : -1.0 / n;
    }
    EXPECT_NEAR(agree, 0.0, 4.0 / std::sqrt(n));
  }
}

/// The share by which `found` is larger than `exact` in these rows, the same in each.
double share_of(const std::vector<double>& found, const std::vector<double>& exact,
                std::size_t from, std::size_t to) {
  double product = 0.0;
  double square = 0.0;
  for (std::size_t row = from; row < to; ++row) {
    product += (found[row] - exact[row]) * exact[row];
    square += exact[row] * exact[row];
  }
  for (std::size_t row = from; row < to; ++row) {
    EXPECT_NEAR(found[row] - exact[row], product / square * exact[row], 1e-14) << "row " << row;
  }
  return product / square;
}

struct MeanAndDifference {
  std::vector<double> travel;
  std::vector<double> apart;
};

MeanAndDifference of_wheels(const Drive& drive) {
  MeanAndDifference result;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    result.travel.push_back(0.5 * (drive.left[row] + drive.right[row]));
    result.apart.push_back(drive.right[row] - drive.left[row]);
  }
  return result;
}

TEST(RoughNoise, FloorMisreadsEachLegByFactorsOfItsOwn) {
  for (const double overrun : {0.0, 0.4}) {
    World w = world(100);
    w.style.overrun = overrun;  // a leg begins where the landmark is seen, not where it is left
    w.robot.noise = kNoiseFree;
    const SimulatedDrive rough = simulate(w, 7, "floor");
    const MeanAndDifference found = of_wheels(rough.recording.drive);
    const MeanAndDifference exact = of_wheels(sensed(w, 7));
    std::vector<double> travel;
    std::vector<double> turn;
    for (std::size_t leg = 1; leg < rough.motion.stops.size(); ++leg) {
      const std::size_t from = rough.motion.stops[leg - 1].rows;
      const std::size_t to = rough.motion.stops[leg].rows;
      travel.push_back(share_of(found.travel, exact.travel, from, to) / 0.004);
      turn.push_back(share_of(found.apart, exact.apart, from, to) / 0.01);
    }
    // Normal, of variance 1, independent of each other and from leg to leg.
    const auto n = static_cast<double>(travel.size());
    ASSERT_GT(n, 2500.0);
    double both = 0.0;
    for (std::size_t leg = 0; leg < travel.size(); ++leg) both += travel[leg] * turn[leg] / n;
    EXPECT_NEAR(both, 0.0, 4.0 / std::sqrt(n));
    for (const std::vector<double>& shares : {travel, turn}) {
      double mean = 0.0;
      for (const double share : shares) mean += share / n;
      EXPECT_NEAR(mean, 0.0, 4.0 / std::sqrt(n));
      EXPECT_NEAR(mean_power(shares, 2.0), 1.0, 4.0 * std::sqrt(2.0 / n));
      EXPECT_NEAR(autocorrelation(shares, 1), 0.0, 4.0 / std::sqrt(n));
    }
  }
}

TEST(RoughNoise, FloorComesBesideAllOtherNoise) {
  const World w = world(1);
  World quiet = w;
  quiet.robot.noise = kNoiseFree;
  const Drive truth = sensed(w, 8);
  const Drive misread = simulate(quiet, 8, "floor").recording.drive;
  const auto expect_beside = [&](const std::string& without, const std::string& with) {
    const Drive a = simulate(w, 8, without).recording.drive;
    const Drive b = simulate(w, 8, with).recording.drive;
    EXPECT_EQ(a.heading, b.heading);
    for (std::size_t row = 0; row < truth.rows(); ++row) {
      EXPECT_NEAR(b.left[row] - a.left[row], misread.left[row] - truth.left[row], 1e-14);
      EXPECT_NEAR(b.right[row] - a.right[row], misread.right[row] - truth.right[row], 1e-14);
    }
  };
  expect_beside("", "floor");
  expect_beside("half,memory,haze,tails", "all");
}

TEST(RoughNoise, AKindChangesNothingInTheOthers) {
  const World w = world(1);
  const SimulatedDrive plain = simulate(w, 9);
  const SimulatedDrive haze = simulate(w, 9, "haze");
  EXPECT_EQ(haze.recording.drive.left, plain.recording.drive.left);
  EXPECT_EQ(haze.recording.drive.right, plain.recording.drive.right);
  EXPECT_EQ(simulate(w, 9, "memory").recording.drive.heading, plain.recording.drive.heading);

  // Half doubles what is there, tails stretch each error by a positive factor.
  const std::vector<std::vector<double>> most = errors_of(w, 9, "memory,haze,tails").each();
  const std::vector<std::vector<double>> doubled = errors_of(w, 9, "half,memory,haze,tails").each();
  const std::vector<std::vector<double>> tails = errors_of(w, 9, "tails").each();
  const std::vector<std::vector<double>> normal = errors_of(w, 9, "").each();
  for (std::size_t sensor = 0; sensor < 3; ++sensor) {
    std::vector<double> twice = most[sensor];
    for (double& error : twice) error *= 2.0;
    expect_near_all(doubled[sensor], twice);
    for (std::size_t row = 0; row < twice.size(); ++row) {
      EXPECT_GT(tails[sensor][row] * normal[sensor][row], 0.0);
    }
  }
}

/// What is new in each of the errors that keep a share of themselves.
std::vector<double> news(const std::vector<double>& errors, double kept, double variance) {
  std::vector<double> result;
  for (std::size_t k = 0; k < errors.size(); ++k) {
    const double before = k == 0 ? 0.0 : kept * errors[k - 1];
    const double share = k == 0 ? 1.0 : 1.0 - kept * kept;
    result.push_back((errors[k] - before) / std::sqrt(share * variance));
  }
  return result;
}

TEST(RoughNoise, WhatIsNewInALastingErrorIsTheWhiteOne) {
  const World w = world(1);
  for (const char* heavy : {"", "tails"}) {
    const Errors white = errors_of(w, 10, heavy);
    const Errors lasting = errors_of(w, 10, *heavy == '\0' ? "memory,haze" : "memory,haze,tails");
    const double kept = std::exp(-0.1);
    const double smaller = (1.0 - kept) / (1.0 + kept);
    expect_near_all(news(lasting.left, kept, smaller), white.left);
    expect_near_all(news(lasting.right, kept, smaller), white.right);
    expect_near_all(news(lasting.compass, std::exp(-0.05), 1.0), white.compass);
  }
}

TEST(RoughNoise, FadesWhileTheRobotRests) {
  // A wheel at rest shows no error, and of one before a rest of 20 s exp(-20) is left: n pairs of
  // errors have a correlation of variance 1/n.
  World w = world(6);
  w.style.rest_share = 1.0;
  w.style.shortest_rest = w.style.longest_rest = 20.0;
  const SimulatedDrive rough = simulate(w, 11, "memory");
  const Drive truth = sensed(w, 11);
  std::vector<double> before;
  std::vector<double> after;
  double last = 0.0;
  for (std::size_t row = 0; row < truth.rows(); ++row) {
    const double error = rough.recording.drive.left[row] - truth.left[row];
    const bool rests = rough.motion.rows[row].activity == Activity::rest;
    if (rests) {
      EXPECT_EQ(error, 0.0);
    } else if (row > 0 && rough.motion.rows[row - 1].activity == Activity::rest && last != 0.0) {
      before.push_back(last);
      after.push_back(error / std::sqrt(std::abs(truth.left[row])));
    }
    if (!rests) last = error / std::sqrt(std::abs(truth.left[row]));
  }
  const auto n = static_cast<double>(after.size());
  ASSERT_GT(n, 100.0);
  double product = 0.0;
  for (std::size_t k = 0; k < after.size(); ++k) product += before[k] * after[k] / n;
  EXPECT_NEAR(product / std::sqrt(mean_power(before, 2.0) * mean_power(after, 2.0)), 0.0,
              4.0 / std::sqrt(n));
}

bool equal_drives(const Drive& a, const Drive& b) {
  return a.t == b.t && a.left == b.left && a.right == b.right && a.heading == b.heading;
}

TEST(RoughNoise, IsDrawnFromItsSeed) {
  const World w = world(1);
  for (const char* kinds : {"half", "memory", "haze", "tails", "floor", "all"}) {
    const Drive one = simulate(w, 12, kinds).recording.drive;
    EXPECT_TRUE(equal_drives(one, simulate(w, 12, kinds).recording.drive)) << kinds;
    EXPECT_FALSE(equal_drives(one, simulate(w, 13, kinds).recording.drive)) << kinds;
    EXPECT_FALSE(equal_drives(one, simulate(w, 12).recording.drive)) << kinds;
  }
}

TEST(RoughNoise, LeavesPathSightingsAndSurveyAlone) {
  World w = world(1);
  w.robot.range_sensor = true;
  const SimulatedDrive rough = simulate(w, 14, "all");
  const SimulatedDrive plain = simulate(w, 14);
  EXPECT_EQ(rough.motion.rows.back().pose.x, plain.motion.rows.back().pose.x);
  ASSERT_EQ(rough.recording.sightings.size(), plain.recording.sightings.size());
  for (std::size_t k = 0; k < plain.recording.sightings.size(); ++k) {
    EXPECT_EQ(rough.recording.sightings[k].landmark, plain.recording.sightings[k].landmark);
    EXPECT_EQ(rough.recording.sightings[k].t, plain.recording.sightings[k].t);
    if (plain.recording.sightings[k].standing()) continue;
    EXPECT_EQ(rough.recording.sightings[k].range, plain.recording.sightings[k].range);
    EXPECT_EQ(rough.recording.sightings[k].bearing, plain.recording.sightings[k].bearing);
  }
  ASSERT_EQ(rough.recording.survey.size(), plain.recording.survey.size());
  for (std::size_t k = 0; k < plain.recording.survey.size(); ++k) {
    EXPECT_EQ(rough.recording.survey[k].x, plain.recording.survey[k].x);
    EXPECT_EQ(rough.recording.survey[k].y, plain.recording.survey[k].y);
  }

  const Drive with_compass = rough.recording.drive;
  w.robot.compass = false;
  const Drive without = simulate(w, 14, "all").recording.drive;
  EXPECT_FALSE(without.has_compass());
  EXPECT_EQ(without.left, with_compass.left);
  EXPECT_EQ(without.right, with_compass.right);
}

TEST(RoughNoise, ComesBesidePhysicalEffects) {
  // In stated standard deviations the errors are those of the robot without the effect.
  World w = world(1);
  const Errors without = errors_of(w, 15, "half,memory,haze,tails");
  Effect ratio = catalogue_effect("wheel diameter ratio");
  ratio.coefficients = {0.02};
  Effect iron = catalogue_effect("hard iron");
  iron.coefficients = {0.1, -0.2};
  w.effects.effects = {ratio, iron};
  const Errors with = errors_of(w, 15, "half,memory,haze,tails");
  for (std::size_t sensor = 0; sensor < 3; ++sensor) {
    expect_near_all(with.each()[sensor], without.each()[sensor]);
  }
}

TEST(RoughNoise, EveryRowIsMisreadAsItsLegIs) {
  const testing::NoisyDrive world = testing::simulate_world({true, true, false, 1}, 1);
  const TrueMotion& motion = world.motions.front();
  RoughNoise rough;
  rough.floor = true;
  const std::vector<simulation::LegMisreading> misreadings =
      simulation::leg_misreadings(motion, rough, 1);
  ASSERT_EQ(misreadings.size(), motion.rows.size());
  std::size_t changes = 0;
  for (std::size_t row = 1; row < misreadings.size(); ++row) {
    if (misreadings[row].travel == misreadings[row - 1].travel) continue;
    ++changes;
    EXPECT_TRUE(std::any_of(motion.stops.begin(), motion.stops.end(), [row](const auto& stop) {
      return stop.rows == row;
    })) << row;
  }
  EXPECT_GT(changes, 10U);
}

}  // namespace
}  // namespace trussmap::rough_noise_test
