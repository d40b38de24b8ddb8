// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Models of few effects, for the tests of a robot's odometry.
#pragma once

#include "trussmap/model.hpp"

#include <utility>
#include <vector>

namespace trussmap::testing {

inline Effect own_effect(Channel channel, const char* shape, double coefficient) {
  Effect effect;
  effect.name = "own";
  effect.channel = channel;
  effect.shape = {shape};
  effect.coefficients = {coefficient};
  return effect;
}

inline Model with(std::vector<Effect> effects) {
  Model model;
  model.effects = std::move(effects);
  return model;
}

}  // namespace trussmap::testing
