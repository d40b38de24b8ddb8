// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/effect_parts.hpp"

#include "effects/channel_physics.hpp"

#include <algorithm>
#include <initializer_list>

namespace trussmap::report {
namespace {

bool speaks_of(const Effect& effect, std::initializer_list<const char*> names) {
  return std::any_of(effect.shape.begin(), effect.shape.end(), [&](const Shape& shape) {
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return shape.speaks_of(name); });
  });
}

}  // namespace

const char* part_name(EffectPart part) {
  constexpr std::array kNames{"wheels", "turning", "floor", "compass", "gyro", "sighting"};
  return kNames.at(static_cast<std::size_t>(part));
}

EffectPart part_of(const Effect& effect) {
  switch (effects::acts_on(effect.channel)) {
    case effects::ActsOn::readings:
      return EffectPart::compass;
    case effects::ActsOn::views:
      return EffectPart::sighting;
    case effects::ActsOn::drives:
      break;
  }
  if (effect.channel == Channel::gyro || effect.channel == Channel::gyro_scale) {
    return EffectPart::gyro;
  }
  if (effect.channel == Channel::creep || speaks_of(effect, {"x", "y", "heading"})) {
    return EffectPart::floor;
  }
  const bool turns = effect.channel == Channel::turn || effect.channel == Channel::drift ||
                     effect.channel == Channel::rotate;
  return turns ? EffectPart::turning : EffectPart::wheels;
}

}  // namespace trussmap::report
