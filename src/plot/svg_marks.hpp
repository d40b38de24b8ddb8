// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How the marks of a figure become SVG.
#pragma once

#include "plot/svg.hpp"

#include <string>

namespace trussmap::plot {

/// Pixels with two decimals, without a negative zero.
[[nodiscard]] std::string px(double value);

/// Units to pixels within one panel.
struct View {
  Range x;
  Range y;
  double left = 0.0;
  double top = 0.0;
  double width = 1.0;
  double height = 1.0;

  [[nodiscard]] double to_x(double value) const {
    return left + width * (value - x.low) / (x.high - x.low);
  }
  [[nodiscard]] double to_y(double value) const {
    return top + height * (y.high - value) / (y.high - y.low);
  }
  [[nodiscard]] std::string point(const Vector2& p, const char* between) const {
    return px(to_x(p.x())) + between + px(to_y(p.y()));
  }
};

/// The attributes of a line.
[[nodiscard]] std::string stroke(const Mark& mark);

/// One point of a mark of dots, circles, crosses or pluses, at pixels.
[[nodiscard]] std::string point_mark(const Mark& mark, double x, double y);

[[nodiscard]] std::string draw_mark(const Mark& mark, const View& view);

}  // namespace trussmap::plot
