// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Charts: what is drawn, not how. One description becomes an interactive picture on a page
// (page.hpp), a data table and a CSV file beside it, and a still picture (chart_svg.hpp).
//
//   Chart   axes and layers, drawn in order
//   Layer   one kind of mark; a mark per row of its columns. The first columns say where it is:
//
//     dots, labels   x, y                     ellipses   x, y, semi-axes a, b, angle [rad]
//     line, net      x, y (NaN: a gap)        intervals  at, value, low, high
//     band           x, low, high             bars       at, value
//     segments       x1, y1, x2, y2           level      y: across;   upright   x: from top to
//     bottom
//
//   Any further columns are read where the pointer is (labels: the first further one is the text).
//   `at` is a place on the axis of categories, where there is one (then the bars of a chart whose y
//   axis has categories lie on their sides), else an x. `net` is a line that nobody can point at.
//
// Colours are roles, which the page fills in for light, dark and paper: "ink", "faint", "good",
// "bad" and "1" to "8", that stay apart for colour-blind eyes. A shade, from -1 to 1, goes from
// blue through grey to red instead.
#pragma once

#include "plot/svg.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::plot {

enum class LayerKind {
  dots,
  line,
  net,
  band,
  segments,
  ellipses,
  intervals,
  bars,
  labels,
  level,
  upright
};

/// Numbers (NaN: none) or, where there are none, texts.
struct ChartColumn {
  std::string name;  ///< with its unit: "stretch error [%]"
  std::vector<double> numbers = {};
  std::vector<std::string> texts = {};

  [[nodiscard]] std::size_t size() const { return numbers.empty() ? texts.size() : numbers.size(); }
};

struct ChartLayer {
  LayerKind kind = LayerKind::dots;
  std::string name;  ///< in the legend; empty: not there
  std::vector<ChartColumn> columns;
  std::string colour = "1";
  double size = 0.0;  ///< pixels: radius of a dot, width of a line (shaded: a factor); 0: own
  bool dashed = false;
  double offset = 0.0;                ///< pixels along an axis of categories, to lie side by side
  std::vector<double> shade = {};     ///< one per mark, -1 to 1; empty: all in `colour`
  std::vector<std::string> key = {};  ///< of the shades -1, 0 and 1, in the legend
};

struct ChartAxis {
  std::string title = {};  ///< with its unit: "distance [m]"
  bool log = false;
  bool zero = false;                         ///< 0 is within
  std::optional<Range> range = {};           ///< absent: fits the marks
  std::vector<std::string> categories = {};  ///< not empty: an axis of names, top or left first
};

struct Chart {
  std::string id;  ///< small letters, digits, -: of its files, and unique on a page
  std::string title;
  std::string caption;  ///< what it shows and how to read it; also what a screen reader says
  ChartAxis x;
  ChartAxis y;
  bool equal_aspect = false;  ///< a unit of x is as long as a unit of y
  double height = 320.0;      ///< pixels
  std::vector<ChartLayer> layers;
};

/// No chart has more: what has more is thinned out or gathered before.
inline constexpr std::size_t kMostMarks = 20000;

/// Marks that become elements of the picture: one for each line, net and band, else one per row.
[[nodiscard]] std::size_t mark_count(const Chart& chart);

/// How many columns of a layer say where its marks are.
[[nodiscard]] std::size_t place_columns(LayerKind kind);

/// The chart as JSON that may stand within a <script> element: no "<" is in it. Numbers have six
/// digits. Throws std::invalid_argument where columns of a layer differ in length, are too few, or
/// there are more than kMostMarks marks.
[[nodiscard]] std::string chart_json(const Chart& chart);

/// Its data as CSV (RFC 4180): a column for the layer's name, then those of the layers.
[[nodiscard]] std::string chart_csv(const Chart& chart);

}  // namespace trussmap::plot
