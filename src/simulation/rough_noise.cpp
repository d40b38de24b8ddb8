// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/rough_noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr double kHalfFactor = 2.0;
constexpr double kWheelMemory = 1.0;       // s
constexpr double kCompassMemory = 2.0;     // s
constexpr double kTailFreedom = 3.0;       // degrees of freedom
constexpr double kLegTravelError = 0.004;  // standard deviation, share of the travel
constexpr double kLegTurnError = 0.01;     // of the turn

struct Kind {
  std::string_view name;
  bool RoughNoise::*chosen;
};

constexpr std::array<Kind, 5> kKinds = {{{"half", &RoughNoise::half},
                                         {"memory", &RoughNoise::memory},
                                         {"haze", &RoughNoise::haze},
                                         {"tails", &RoughNoise::tails},
                                         {"floor", &RoughNoise::floor}}};

void choose(std::string_view name, RoughNoise& rough) {
  bool found = false;
  for (const Kind& kind : kKinds) {
    if (name != kind.name && name != "all") continue;
    rough.*kind.chosen = true;
    found = true;
  }
  if (found) return;
  throw std::invalid_argument(fmt::format(
      "unknown rough noise '{}', expected one or more of {} with commas between, or all", name,
      fmt::join(rough_names({true, true, true, true, true}), ", ")));
}

}  // namespace

RoughNoise parse_rough(std::string_view text) {
  RoughNoise rough;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    choose(text.substr(begin, end - begin), rough);
    begin = end + 1;
  }
  return rough;
}

std::vector<std::string> rough_names(const RoughNoise& rough) {
  std::vector<std::string> names;
  for (const Kind& kind : kKinds) {
    if (rough.*kind.chosen) names.emplace_back(kind.name);
  }
  return names;
}

}  // namespace trussmap

namespace trussmap::simulation {

WhiteErrors::WhiteErrors(std::uint64_t seed, Stream normal, Stream tails, bool heavy)
    : random_(random_stream(seed, normal)),
      random_tails_(random_stream(seed, tails)),
      chi_square_(kTailFreedom),
      heavy_(heavy) {}

double WhiteErrors::next() {
  const double z = normal_(random_);
  if (!heavy_) return z;
  // Student's t is z / sqrt(q / f) and has variance f / (f - 2).
  return z * std::sqrt((kTailFreedom - 2.0) / chi_square_(random_tails_));
}

double DriftingNoise::next(double white, double elapsed) {
  if (memory_ == 0.0) return white;
  const double kept = std::exp(-elapsed / memory_);
  last_ = begun_ ? kept * last_ + std::sqrt(1.0 - kept * kept) * white : white;
  begun_ = true;
  return keeps_ == Keeps::sum ? last_ * std::sqrt((1.0 - kept) / (1.0 + kept)) : last_;
}

SensorErrors::SensorErrors(const WheeledRobot& robot, std::uint64_t seed)
    : noise_(robot.noise),
      size_(robot.rough.half ? kHalfFactor : 1.0),
      white_wheels_(seed, Stream::wheels, Stream::wheel_tails, robot.rough.tails),
      white_compass_(seed, Stream::compass, Stream::compass_tails, robot.rough.tails),
      wheel_noise_(std::max<std::size_t>(2, robot.geometry.columns.size()),
                   std::hypot(noise_.left, noise_.right) * std::sqrt(0.5)),
      wheels_(wheel_noise_.size(),
              {robot.rough.memory ? kWheelMemory : 0.0, DriftingNoise::Keeps::sum}),
      compass_(robot.rough.haze ? kCompassMemory : 0.0, DriftingNoise::Keeps::variance),
      random_steering_(random_stream(seed, Stream::steering)) {
  if (robot.geometry.drive == DriveKind::differential) wheel_noise_ = {noise_.left, noise_.right};
}

double SensorErrors::wheel(std::size_t column, double travel, double duration) {
  const double sd = wheel_noise_[column] * std::sqrt(std::abs(travel));
  return sd * (size_ * wheels_[column].next(white_wheels_.next(), duration));
}

double SensorErrors::steering(double travel) {
  const double z = normal_(random_steering_);
  constexpr double kMostSd = 0.2;  // rad: a row that hardly moves the robot turns no wheel round
  return travel == 0.0 ? 0.0 : std::min(kMostSd, noise_.steer / std::sqrt(std::abs(travel))) * z;
}

double SensorErrors::compass(double duration) {
  return noise_.compass * (size_ * compass_.next(white_compass_.next(), duration));
}

std::vector<LegMisreading> leg_misreadings(const TrueMotion& motion, const RoughNoise& rough,
                                           std::uint64_t seed) {
  if (!rough.floor) return {};
  std::mt19937_64 random = random_stream(seed, Stream::floor);
  std::normal_distribution<double> normal;
  std::vector<LegMisreading> misreadings;
  LegMisreading leg;
  auto stop = motion.stops.begin();
  for (std::size_t row = 0; row < motion.rows.size(); ++row) {
    for (; stop != motion.stops.end() && stop->rows == row; ++stop) {
      leg.travel = kLegTravelError * normal(random);
      leg.turn = kLegTurnError * normal(random);
    }
    misreadings.push_back(leg);
  }
  return misreadings;
}

}  // namespace trussmap::simulation
