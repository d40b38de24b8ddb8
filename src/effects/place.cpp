// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/place.hpp"

#include <string>
#include <vector>

namespace trussmap::effects {

std::optional<Vector2> place_of(const Effect& effect) {
  if (effect.shape.size() != 1 || effect.per_session) return std::nullopt;
  const Shape& shape = effect.shape.front();
  if (shape.variables() != std::vector<std::string>{"x", "y"}) return std::nullopt;
  const std::optional<double> x = shape.parameter("x");
  const std::optional<double> y = shape.parameter("y");
  return x && y ? std::optional(Vector2(*x, *y)) : std::nullopt;
}

}  // namespace trussmap::effects
