// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "wording/everyday_factors.hpp"

#include "geometry/units.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace trussmap::wording {
namespace {

struct KnownFactor {
  double factor;  ///< what is true over what is stated
  const char* words;
};

const std::vector<KnownFactor>& factors_of_travel() {
  static const std::vector<KnownFactor> factors{
      {2.0, "twice: a radius taken for a diameter, or a gear?"},
      {0.5, "half: a diameter taken for a radius, or a gear?"},
      {4.0, "four times: edges of the encoder's signals counted as ticks?"},
      {0.25, "a quarter: ticks taken for edges of the encoder's signals?"},
      {std::numbers::pi, "pi times: a diameter taken for a circumference?"},
      {1.0 / std::numbers::pi, "a share of 1/pi: pi counted twice?"},
      {0.3048, "a foot for a metre?"},
      {1.0 / 0.3048, "metres for feet?"},
      {25.4, "millimetres for inches?"},
      {1.0 / 25.4, "inches for millimetres?"}};
  return factors;
}

const std::vector<KnownFactor>& factors_of_turn() {
  static const std::vector<KnownFactor> factors{
      {2.0, "half of what is stated: a distance between the wheels counted twice, or a gear?"},
      {0.5, "twice what is stated: the distance from the middle to a wheel?"},
      {geometry::kDegrees, "degrees for radians?"},
      {1.0 / geometry::kDegrees, "radians for degrees?"}};
  return factors;
}

}  // namespace

std::string everyday_factor_in_words(Channel channel, double g, double sd) {
  constexpr double kNear = 0.01;  // of the factor, where it is known better
  const bool travel = channel == Channel::travel || channel == Channel::wheels;
  if (!travel && channel != Channel::turn) return "";
  for (const KnownFactor& one : travel ? factors_of_travel() : factors_of_turn()) {
    const double off = std::abs((1.0 + g) / one.factor - 1.0);
    const double uncertain = std::isfinite(sd) ? 2.0 * sd / one.factor : 0.0;
    constexpr double kTold = 0.05;  // a worse known one is near any
    if (off < std::max(kNear, uncertain) && uncertain < kTold) {
      return std::string(" (") + one.words + ")";
    }
  }
  return "";
}

}  // namespace trussmap::wording
