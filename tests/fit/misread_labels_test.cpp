// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Labels taken for others beside a survey: the rest's fit stays as it is.
#include "trussmap/catalogue.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/noise_fit.hpp"

#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::misread_labels_test {
namespace {

constexpr double kRow = 0.25;     // s
constexpr double kBase = 0.5;     // m, nominal
constexpr double kTravel = 0.03;  // further than the wheels say
constexpr double kTurn = 0.07;    // likewise
constexpr double kAhead = 0.3;    // m, of the scanner
constexpr int kLandmarks = 16;    // in a ring of 8 m about the drive; of these
constexpr int kHidden = 4;        // are never seen

Vector2 landmark(int k) {
  const double angle = 2.0 * std::numbers::pi * k / kLandmarks;
  return (k < kHidden ? 30.0 : 8.0) * Vector2(std::cos(angle), std::sin(angle));
}

struct Spoilt {
  Recording recording;
  std::size_t wrong = 0;
};

/// Ten minutes of bends among reflectors that are seen every second, such a share by another's
/// label, of the hidden ones as well. What is not spoilt is the same for every share.
Spoilt car_park(double share, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::mt19937_64 labels(seed + 1000);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  Spoilt result;
  Recording& recording = result.recording;
  Pose pose{0.0, -3.0, 0.0};
  for (int row = 1; row <= 2400; ++row) {
    const double t = kRow * row;
    const double way = kRow * (0.6 + 0.2 * std::sin(0.05 * t));
    const double turn = kRow * (0.2 + 0.25 * std::sin(0.11 * t));
    pose = compose(pose, Pose{way * std::cos(0.5 * turn), way * std::sin(0.5 * turn), turn});
    const auto wheel = [&](double side) {
      const double travel = way / (1.0 + kTravel) + side * 0.5 * kBase * turn / (1.0 + kTurn);
      return travel + 0.002 * std::sqrt(std::abs(travel)) * normal(random);
    };
    recording.drive.t.push_back(t);
    recording.drive.left.push_back(wheel(-1.0));
    recording.drive.right.push_back(wheel(1.0));
    if (row % 4 != 0) continue;
    const Vector2 eye = compose(pose, Pose{kAhead, 0.0, 0.0}).position();
    for (int k = kHidden; k < kLandmarks; ++k) {
      const Vector2 offset = landmark(k) - eye;
      Sighting seen;
      seen.t = t;
      seen.range = offset.norm() + 0.05 * normal(random);
      seen.bearing = wrap_angle(direction(offset) - pose.heading + 0.0175 * normal(random));
      int label = k;
      if (uniform(labels) < share) label = static_cast<int>(uniform(labels) * kLandmarks);
      seen.landmark = std::to_string(label);
      if (offset.norm() >= 9.0) continue;
      recording.sightings.push_back(seen);
      if (label != k) ++result.wrong;
    }
  }
  for (int k = 0; k < kLandmarks; ++k) {
    SurveyPoint point;
    point.landmark = std::to_string(k);
    point.x = landmark(k).x();
    point.y = landmark(k).y();
    point.sd = 0.005;
    recording.survey.push_back(point);
  }
  return result;
}

Model model_of_car_park() {
  Model model;
  model.robot.wheelbase = kBase;
  model.noise.left = model.noise.right = 0.002;
  model.noise.range = 0.05;
  model.noise.bearing = 0.0175;
  model.effects = {catalogue_effect("travel scale"), catalogue_effect("wheelbase"),
                   catalogue_effect("lever arm")};
  return model;
}

/// Seed 3; in the first share every landmark's label is right.
TEST(MisreadLabels, LeaveFitAndNoiseOfTheRestAsTheyAre) {
  const Model model = model_of_car_park();
  const auto fitted = [&model](const Spoilt& spoilt) {
    return fit_model_and_noise(std::vector<Recording>{spoilt.recording}, model, gated_fit(), {});
  };
  const FitWithNoise clean = fitted(car_park(0.0, 3));
  ASSERT_LE(clean.fit.left_out.size(), 3U);
  const double truth[] = {kTravel, kTurn, kAhead};
  for (const double share : {0.01, 0.05}) {
    const Spoilt spoilt = car_park(share, 3);
    ASSERT_GT(spoilt.wrong, 5U);
    const FitWithNoise found = fitted(spoilt);
    EXPECT_NEAR(static_cast<double>(found.fit.left_out.size()), static_cast<double>(spoilt.wrong),
                3.0)
        << share;
    for (std::size_t k = 0; k < 3; ++k) {
      const EffectEstimate& one = found.fit.effects[k];
      const EffectEstimate& other = clean.fit.effects[k];
      EXPECT_NEAR(one.effect.coefficients[0], truth[k], 4.0 * one.sd[0]) << share << k;
      EXPECT_NEAR(one.effect.coefficients[0], other.effect.coefficients[0], 2.0 * other.sd[0])
          << share << k;
      EXPECT_NEAR(one.sd[0], other.sd[0], 0.2 * other.sd[0]) << share << k;
    }
    const Noise& noise = found.fit.model.noise;
    EXPECT_NEAR(noise.range, clean.fit.model.noise.range, 0.2 * clean.fit.model.noise.range);
    EXPECT_NEAR(noise.bearing, clean.fit.model.noise.bearing, 0.2 * clean.fit.model.noise.bearing);
    EXPECT_TRUE(noise.processes.empty()) << share;
  }
}

}  // namespace
}  // namespace trussmap::misread_labels_test
