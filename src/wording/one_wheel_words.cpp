// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One wheel larger than the other, said as that.
#include "trussmap/calibrate.hpp"
#include "trussmap/wording.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// What one wheel that is larger leaves of effects, all with the shape 1.
bool is_of_two_wheels(const Effect& effect) {
  if (!effect.is_constant() || effect.per_session) return false;
  const Channel channel = effect.channel;
  return channel == Channel::difference || channel == Channel::turn || channel == Channel::travel ||
         channel == Channel::wheels || channel == Channel::left || channel == Channel::right;
}

}  // namespace

std::string in_words(const OneWheel& wheel) {
  const double sd = 100.0 * wheel.sd;
  const int decimals = sd > 0.0 ? std::max(0, 1 - static_cast<int>(std::floor(std::log10(sd)))) : 2;
  return fmt::format(
      "the {} wheel is {:.{}f} +- {:.{}f} % {} than nominal; the {} one and the wheelbase are as "
      "the model has them",
      wheel.left ? "left" : "right", 100.0 * std::abs(wheel.larger), decimals, sd, decimals,
      wheel.larger < 0.0 ? "smaller" : "larger", wheel.left ? "right" : "left");
}

std::vector<std::string> effects_in_words(const ModelFit& fit) {
  std::vector<std::string> lines;
  const auto wheel = robot_constants(fit.model, fit).one_wheel;
  bool said = false;
  for (const EffectEstimate& one : fit.effects) {
    if (wheel && is_of_two_wheels(one.effect)) {
      if (!said) lines.push_back(fmt::format("one wheel: {}", in_words(*wheel)));
      said = true;
      continue;
    }
    lines.push_back(fmt::format("{}: {}", one.effect.name, in_words(one.effect, one.sd)));
  }
  return lines;
}

}  // namespace trussmap
