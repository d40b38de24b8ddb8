// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What noise does under factors of wheels that are far from one, beside rows that were drawn.
#include "effects/wheel_factors.hpp"

#include "drive/as_read.hpp"
#include "drive/row_motion.hpp"
#include "driven.hpp"
#include "odometry/wheels_and_gyro.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"

#include <cmath>
#include <cstdint>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::wheel_factors_test {
using namespace effects;
namespace {

constexpr double kWheelbase = 0.4;

/// By which a channel is wrong all the time.
Effect constant(Channel channel, std::vector<double> g) {
  Effect effect;
  effect.name = name_of(channel);
  effect.channel = channel;
  effect.shape = {Shape("1")};
  effect.coefficients = std::move(g);
  return effect;
}

struct FarFactor {
  Channel channel;
  double g;
  double left, right;  ///< true over shown
};

std::vector<FarFactor> far_factors() {
  return {{Channel::left, 4.0, 5.0, 1.0},
          {Channel::right, -0.8, 1.0, 0.2},
          {Channel::wheels, -0.5, 0.5, 0.5},
          {Channel::wheels, 2.0, 3.0, 3.0},
          {Channel::left, -2.0, -1.0, 1.0}};
}

WheelFactors factors_of(const std::vector<Effect>& effects, int session = 0) {
  return wheel_factors(effects, Robot{kWheelbase}, session).value();
}

TEST(WheelFactors, MoveTheBodyAsTheirWheelsDo) {
  for (const FarFactor& one : far_factors()) {
    const WheelFactors factors = factors_of({constant(one.channel, {one.g})});
    Matrix2 expected;
    expected << 0.5 * one.left, 0.5 * one.right, -one.left / kWheelbase, one.right / kWheelbase;
    EXPECT_LT((factors.by_travel - expected).norm(), 1e-12) << name_of(one.channel);
    EXPECT_NEAR(difference(factors, Robot{kWheelbase}), std::abs(one.g), 1e-12)
        << name_of(one.channel);
  }
  const WheelFactors track = factors_of({constant(Channel::turn, {1.0})});
  EXPECT_DOUBLE_EQ(track.by_travel(0, 0), 0.5);
  EXPECT_DOUBLE_EQ(track.by_travel(1, 1), 2.0 / kWheelbase);
  EXPECT_NEAR(difference(track, factors_of({}), Robot{kWheelbase}), 0.5, 1e-12);
}

TEST(WheelFactors, AreOfTheSession) {
  Effect of_sessions = constant(Channel::turn, {0.0, 1.0});
  of_sessions.per_session = true;
  EXPECT_NEAR(difference(factors_of({of_sessions}, 0), Robot{kWheelbase}), 0.0, 1e-12);
  EXPECT_NEAR(difference(factors_of({of_sessions}, 1), Robot{kWheelbase}), 0.5, 1e-12);
}

TEST(WheelFactors, AreNoneOfOtherWheelsOrWhereMotionsShowTheSame) {
  Robot omni{kWheelbase};
  omni.drive = DriveKind::omni3;
  EXPECT_FALSE(wheel_factors({constant(Channel::turn, {1.0})}, omni, 0));
  EXPECT_FALSE(wheel_factors({constant(Channel::left, {-1.0})}, Robot{kWheelbase}, 0));
}

/// Rows as a robot with these wheels shows them, and its gyro beside them.
class DrawnRows {
 public:
  DrawnRows(const FarFactor& wheels, bool gyro, std::uint64_t seed) {
    noise_.left = 0.004;
    noise_.right = 0.003;
    noise_.gyro = 0.01;
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    constexpr double kDuration = 0.1;
    for (int row = 0; row < kRows; ++row) {
      const WheelTravel motion = row % 2 == 0 ? WheelTravel{0.06, 0.06} : WheelTravel{0.03, 0.08};
      const double left = motion.left / wheels.left;
      const double right = motion.right / wheels.right;
      drive_.t.push_back(kDuration * (row + 1));
      testing::add_travels(drive_, left + noise_.left * std::sqrt(std::abs(left)) * normal(random),
                           right + noise_.right * std::sqrt(std::abs(right)) * normal(random),
                           kWheelbase);
      const double turn = (motion.right - motion.left) / kWheelbase;
      if (gyro) {
        drive_.yaw_rate.push_back((turn + noise_.gyro * std::sqrt(kDuration) * normal(random)) /
                                  kDuration);
      }
      truth_.emplace_back(0.5 * (motion.left + motion.right), turn);
    }
    const Effect effect = constant(wheels.channel, {wheels.g});
    read_ = drive_;
    drive_ = with_factors(drive_, factors_of({effect}), Robot{kWheelbase});
    drive_ = odometry::with_gyro(drive_, Robot{kWheelbase}, noise_);
    for (int row = 0; row < kRows; ++row) {
      const auto at = static_cast<std::size_t>(row);
      const BodyMotion body = drive_.motion(at);
      errors_.push_back(Vector2(body.forward, body.turn) - truth_[at]);
      excesses_.push_back(gyro ? drive_.gyro[at].excess : 0.0);
    }
  }

  static constexpr int kRows = 40000;

  Noise noise_;
  MotionRows read_;   ///< as the wheels show it
  MotionRows drive_;  ///< with the factors
  std::vector<Vector2> truth_;
  std::vector<Vector2> errors_;
  std::vector<double> excesses_;
};

TEST(WheelFactors, NoiseIsWhatDrawnRowsShow) {
  constexpr double kOfVariance = 0.05;  // 1/sqrt(2e4) of it is chance
  for (const FarFactor& wheels : far_factors()) {
    for (const bool gyro : {false, true}) {
      const DrawnRows drawn(wheels, gyro, 11);
      for (const std::size_t kind : {0U, 1U}) {
        Matrix2 seen = Matrix2::Zero();
        Matrix2 stated = Matrix2::Zero();
        double excess = 0.0;
        double excess_stated = 0.0;
        Vector2 both = Vector2::Zero();
        for (std::size_t row = kind; row < drawn.errors_.size(); row += 2) {
          seen += drawn.errors_[row] * drawn.errors_[row].transpose();
          const ArcNoise noise =
              odometry::row_noise(drawn.drive_, row, 1.0, 0.1, Robot{kWheelbase}, drawn.noise_);
          stated +=
              (Matrix2() << noise.along, noise.shared, noise.shared, noise.heading).finished();
          if (!gyro) continue;
          excess += std::pow(drawn.excesses_[row], 2);
          both += drawn.excesses_[row] * drawn.errors_[row];
          excess_stated += odometry::excess_variance(drawn.drive_, row, 1.0, 0.1, Robot{kWheelbase},
                                                     drawn.noise_);
        }
        const std::string what =
            std::string(name_of(wheels.channel)) + (gyro ? " beside a gyro" : "");
        EXPECT_NEAR(seen(0, 0) / stated(0, 0), 1.0, kOfVariance) << what << kind;
        EXPECT_NEAR(seen(1, 1) / stated(1, 1), 1.0, kOfVariance) << what << kind;
        const double scale = std::sqrt(stated(0, 0) * stated(1, 1));
        EXPECT_NEAR(seen(0, 1) / scale, stated(0, 1) / scale, kOfVariance) << what << kind;
        if (!gyro) continue;
        EXPECT_NEAR(excess / excess_stated, 1.0, kOfVariance) << what << kind;
        EXPECT_NEAR(both[0] / std::sqrt(excess * seen(0, 0)), 0.0, kOfVariance) << what << kind;
        EXPECT_NEAR(both[1] / std::sqrt(excess * seen(1, 1)), 0.0, kOfVariance) << what << kind;
      }
    }
  }
}

/// Shapes and effects see what was read, whatever was taken in.
TEST(WheelFactors, AreTakenOutAgain) {
  const Robot robot{kWheelbase};
  for (const FarFactor& wheels : far_factors()) {
    const DrawnRows drawn(wheels, false, 7);
    const MotionRows back = drive::as_read(drawn.drive_, robot);
    for (std::size_t row = 0; row < 100; ++row) {
      EXPECT_NEAR(back.forward[row], drawn.read_.forward[row], 1e-12);
      EXPECT_NEAR(back.turn[row], drawn.read_.turn[row], 1e-12);
      EXPECT_NEAR(back.pair.left[row], drawn.read_.pair.left[row], 1e-12);
      const drive::RowMotion seen = drive::row_motion(drawn.drive_, row, robot);
      EXPECT_NEAR(seen.body.turn, drawn.read_.turn[row], 1e-12);
      EXPECT_NEAR(drive::own_travel(drawn.drive_, row, robot).right, drawn.read_.pair.right[row],
                  1e-12);
    }
    const DrawnRows beside(wheels, true, 7);
    const MotionRows both = drive::as_read(beside.drive_, robot);
    for (std::size_t row = 0; row < 100; ++row) {
      EXPECT_NEAR(both.gyro[row].wheels.turn, beside.read_.turn[row], 1e-12);
      EXPECT_NEAR(both.gyro[row].wheels.turn + both.gyro[row].excess,
                  0.1 * beside.read_.yaw_rate[row], 1e-12);
    }
  }
}

TEST(WheelFactors, AreTakenInOnceAndBeforeTheGyro) {
  const DrawnRows drawn({Channel::left, 1.0, 2.0, 1.0}, true, 7);
  EXPECT_THROW(static_cast<void>(with_factors(drawn.drive_, factors_of({}), Robot{kWheelbase})),
               std::logic_error);
}

}  // namespace
}  // namespace trussmap::wheel_factors_test
