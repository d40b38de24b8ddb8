// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// From the values of a chart to pixels.
#pragma once

#include "plot/chart.hpp"

#include <string>
#include <utility>
#include <vector>

namespace trussmap::plot {

/// One axis: values or categories onto pixels.
struct ChartScale {
  std::vector<std::string> categories;  ///< empty: numbers
  bool log = false;
  Range range;         ///< of numbers
  double first = 0.0;  ///< pixel of the range's low end, or before the first category
  double last = 1.0;   ///< pixel of its high end, or behind the last category

  [[nodiscard]] double pixel(double value) const;  ///< NaN for what the axis does not have
  [[nodiscard]] double pixel(const ChartColumn& column, std::size_t row) const;
  /// Where the axis has numbers written, and what.
  [[nodiscard]] std::vector<std::pair<double, std::string>> ticks() const;
};

/// Columns of a layer that lie on an axis: 0 is x, 1 is y.
[[nodiscard]] std::vector<std::size_t> columns_on(int axis, const ChartLayer& layer,
                                                  const Chart& chart);

/// Both scales of a chart for a plot with this left, top, right and bottom edge.
[[nodiscard]] std::pair<ChartScale, ChartScale> chart_scales(const Chart& chart, double left,
                                                             double top, double right,
                                                             double bottom);

}  // namespace trussmap::plot
