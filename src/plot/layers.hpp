// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the charts of several pages are put together from.
#pragma once

#include "plot/chart.hpp"
#include "trussmap/planar.hpp"

#include <string>
#include <vector>

namespace trussmap::plot {

inline constexpr double kNormal95 = 1.96;  ///< half a 95 % interval, in standard deviations

/// Height of a chart with so many bars on their sides, pixels.
[[nodiscard]] inline double bars_height(std::size_t count) {
  return 30.0 + 30.0 * static_cast<double>(count);
}

/// Which of `count` things are drawn where `most` can be: the first quarter of those, for lists
/// with the worst first, and of the others every so many.
[[nodiscard]] std::vector<std::size_t> thinned(std::size_t count, std::size_t most);

/// Gives equal texts numbers: categories must differ.
void make_unique(std::vector<std::string>& texts);

/// Share of distances (any unit) within a distance, in %: a line, with dots where they are few.
void add_shares(Chart& chart, const std::string& legend, std::vector<double> distances,
                const std::string& unit, const std::string& colour);

/// A figure with half of its 95 % interval.
struct NamedInterval {
  std::string name;
  double value = 0.0;
  double half = 0.0;
};
/// One below the other, each a category of its own, along `axis`; the chart is as high as they
/// need.
void add_intervals(Chart& chart, const std::string& axis, const std::vector<NamedInterval>& rows);

/// 95 % ellipses of landmarks. Those without a covariance (0) are left out.
struct PlacedEllipse {
  std::string name;
  Vector2 centre = Vector2::Zero();
  Matrix2 covariance = Matrix2::Zero();
};
[[nodiscard]] ChartLayer ellipse_layer(const std::string& legend,
                                       const std::vector<PlacedEllipse>& ellipses,
                                       const std::string& colour);

}  // namespace trussmap::plot
