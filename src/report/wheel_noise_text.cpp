// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/quantity_cells.hpp"
#include "trussmap/test_path.hpp"
#include "trussmap/texts.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string constants_text(const NoiseAnalysis& result, TextStyle style) {
  TextTable table{{Align::left, Align::right, Align::left, Align::left, Align::left}, {}, false, 2};
  const double length = path_length(result.experiment.path);
  const auto row = [&](const char* name, const WheelConstant& wheel) {
    const auto cells =
        report::quantity_cells({1000.0 * wheel.k, 1000.0 * wheel.standard_error, 0.0});
    const std::string meaning =
        wheel.k > 0.0
            ? fmt::format("{:.2f} mm after 1 m, {:.2f} mm after {:g} m", 1000.0 * wheel.k,
                          1000.0 * wheel.k * std::sqrt(length), length)
            : fmt::format("below {:.2g} with 95 % confidence", 1000.0 * wheel.upper_limit);
    table.rows.push_back({name, cells[0], cells[1], "10^-3 m^1/2", meaning});
  };
  row("left wheel, k", result.estimate.left);
  row("right wheel, k", result.estimate.right);
  if (result.fit.nonlinear) {
    row("  left, first order", result.first_order.left);
    row("  right, first order", result.first_order.right);
  }
  return "\n" + table_text(table, style);
}

std::string scatter_text(const NoiseAnalysis& result, TextStyle style) {
  TextTable table;
  table.columns = {Align::left, Align::right, Align::right, Align::right};
  table.has_heading = true;
  table.rows.push_back({"standard deviation", "x [mm]", "y [mm]", "heading [mrad]"});
  const auto row = [&](const char* name, const Eigen::Vector3d& sd) {
    table.rows.push_back({name, fmt::format("{:.2f}", 1000.0 * sd[0]),
                          fmt::format("{:.2f}", 1000.0 * sd[1]),
                          fmt::format("{:.2f}", 1000.0 * sd[2])});
  };
  row("of the runs", result.estimate.observed.diagonal().cwiseSqrt());
  row("of the model", result.estimate.modelled.diagonal().cwiseSqrt());
  row("mean of the runs", result.estimate.mean);
  return "\n" + table_text(table, style);
}

std::string distribution_text(const NoiseAnalysis& result, TextStyle style) {
  TextTable table;
  table.columns = {Align::left, Align::right, Align::right};
  table.has_heading = true;
  table.rows.push_back({"does the model fit", "", "p"});
  for (const EllipseCount& ellipse : result.fit.ellipses) {
    table.rows.push_back({"runs in the 95 % ellipse, " + ellipse.coordinates,
                          fmt::format("{} of {}", ellipse.inside, ellipse.runs),
                          probability_text(ellipse.p_value)});
  }
  table.rows.push_back(
      {"distances as chi-square has them", "", probability_text(result.fit.distance_p_value)});
  table.rows.push_back(
      {"covariance as two wheels give it", "", probability_text(result.fit.shape_p_value)});
  return "\n" + table_text(table, style);
}

std::string stated_text(const StatedNoise& stated, TextStyle style) {
  TextTable table;
  table.columns = {Align::left, Align::right, Align::right, Align::right};
  table.has_heading = true;
  table.rows = report::sigma_rows(stated);
  table.rows.insert(table.rows.begin(), report::sigma_heading());
  return fmt::format(
             "\n  By the k stated, left {:.3g} and right {:.3g} x 10^-3 m^1/2: {} (p {}).\n",
             1000.0 * stated.left, 1000.0 * stated.right,
             stated.p_value < 0.01 ? "the runs contradict it" : "the runs allow it",
             probability_text(stated.p_value)) +
         "\n" + table_text(table, style);
}

}  // namespace

std::string wheel_noise_text(const NoiseAnalysis& result, TextStyle style) {
  const std::string verdict =
      fmt::format("the wheels' noise {} the end errors of {} runs",
                  result.fit.good ? "explains" : "does not explain", result.estimate.runs);
  return verdict_text(result.fit.good ? Mood::good : Mood::bad, verdict, style) + "\n" +
         constants_text(result, style) + scatter_text(result, style) +
         distribution_text(result, style) +
         (result.stated ? stated_text(*result.stated, style) : "") +
         warnings_text(result.doubts, style);
}

}  // namespace trussmap
