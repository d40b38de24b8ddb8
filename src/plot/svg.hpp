// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Pictures as SVG: panels with axes, in which points, lines and ellipses are drawn in the units of
// what they show. Same input, same bytes.
//
//   Figure   title, legend, and a row of panels
//   Panel    plot area, axes with round ticks, marks
//   Mark     one kind of thing at many places: dots, crosses, a line, many separate segments ...
//
// Text is escaped. White ground, so that a picture can be read on any page.
#pragma once

#include "trussmap/planar.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::plot {

enum class MarkKind {
  dots,      ///< filled circles
  circles,   ///< open circles
  crosses,   ///< x
  pluses,    ///< +
  polyline,  ///< through all points in turn
  segments,  ///< points 0-1, 2-3, 4-5 ...: a truss
  labels     ///< texts[k] beside point k
};

struct Mark {
  MarkKind kind = MarkKind::dots;
  std::vector<Vector2> at;         ///< in the axes' units
  std::string colour = "#222222";  ///< as SVG has it
  double size = 4.0;               ///< pixels: radius of a point, width of a line, height of text
  bool dashed = false;
  std::string legend;              ///< empty: not in the legend; the same text is listed once
  std::vector<std::string> texts;  ///< labels only
};

struct Range {
  double low = 0.0;
  double high = 1.0;
};

struct Panel {
  std::string title;
  std::string x_label;  ///< with its unit: "x error [mm]"
  std::string y_label;
  bool equal_aspect = false;  ///< a unit of x is as long as a unit of y
  bool zero_lines = false;    ///< thin lines through 0
  std::optional<Range> x;     ///< absent: fits the marks
  std::optional<Range> y;
  std::vector<Mark> marks;  ///< drawn in this order
};

struct Figure {
  std::string title;
  std::string subtitle;
  std::vector<Panel> panels;
  double panel_width = 380.0;   ///< pixels, axes included
  double panel_height = 380.0;  ///< pixels
};

/// Throws std::invalid_argument without a panel, or where a number is not finite.
[[nodiscard]] std::string draw_figure(const Figure& figure);

/// Outline of the ellipse (p - centre)' C^-1 (p - centre) = scale^2. C may be singular.
[[nodiscard]] std::vector<Vector2> ellipse_outline(const Vector2& centre, const Matrix2& covariance,
                                                   double scale);

/// About `count` round numbers (1, 2 or 5 times a power of ten apart) within the range.
[[nodiscard]] std::vector<double> round_ticks(const Range& range, int count);

/// Colours that stay apart for colour-blind eyes (Okabe & Ito).
namespace colour {
inline constexpr const char* kBlue = "#0072B2";
inline constexpr const char* kVermilion = "#D55E00";
inline constexpr const char* kGreen = "#009E73";
inline constexpr const char* kPurple = "#CC79A7";
inline constexpr const char* kSky = "#56B4E9";
inline constexpr const char* kGrey = "#9A9A9A";
inline constexpr const char* kBlack = "#222222";
}  // namespace colour

}  // namespace trussmap::plot
