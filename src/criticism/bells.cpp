// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/bells.hpp"

#include "effects/place_patterns.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::criticism {

std::vector<Shape> bells_over(const Spread& u) {
  std::vector<Shape> bells;
  const double low = u.quantile(0.03);
  const double width = (u.quantile(0.97) - low) / 3.0;
  if (!(width > 0.0)) return bells;
  bells.reserve(4);
  for (int k = 0; k < 4; ++k) {
    bells.emplace_back(
        "exp(-((" + u.name + "-{centre})/{width})^2)",
        std::vector<ShapeParameter>{{"centre", text::rounded_within(low + k * width, width)},
                                    {"width", text::rounded_within(width, width)}});
  }
  return bells;
}

std::vector<Shape> bells_over(const Area& area) {
  constexpr int kAcross = 5;
  constexpr double kNear = 0.75;   // of the distance between bells
  constexpr double kSpread = 0.7;  // likewise
  std::vector<Shape> bells;
  if (!(area.step > 0.0)) return bells;
  const Vector2 extent = area.high - area.low;
  const double apart = extent.maxCoeff() / (kAcross - 1);
  const int columns = std::max(1, static_cast<int>(std::lround(extent.x() / apart)));
  const int rows = std::max(1, static_cast<int>(std::lround(extent.y() / apart)));
  for (int i = 0; i <= columns; ++i) {
    for (int j = 0; j <= rows; ++j) {
      const Vector2 centre = area.low + Vector2(extent.x() * i / columns, extent.y() * j / rows);
      const bool driven =
          std::any_of(area.centres.begin(), area.centres.end(),
                      [&](const Vector2& one) { return (one - centre).norm() < kNear * apart; });
      if (!driven) continue;
      bells.emplace_back(
          effects::kBellPattern,
          std::vector<ShapeParameter>{{"x", text::rounded_within(centre.x(), apart)},
                                      {"y", text::rounded_within(centre.y(), apart)},
                                      {"r", text::rounded_within(kSpread * apart, apart)}});
    }
  }
  return bells;
}

}  // namespace trussmap::criticism
