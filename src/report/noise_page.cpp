// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/layers.hpp"
#include "report/page.hpp"
#include "report/quantity_cells.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

constexpr double kThousand = 1000.0;
constexpr std::size_t kMostErrors = 3000;

std::string constant_text(const WheelConstant& wheel) {
  if (!(wheel.k > 0.0)) {
    return fmt::format("below {:.2g} (95 %)", kThousand * wheel.upper_limit);
  }
  const QuantityText text = quantity_text(kThousand * wheel.k, kThousand * wheel.standard_error);
  return text.value + (text.error.empty() ? "" : " \u00b1 " + text.error);
}

plot::ChartLayer outline_layer(const std::string& name, const Vector2& centre,
                               const Matrix2& covariance, const std::string& colour,
                               double reach = ellipse95_scale(2)) {
  plot::ChartLayer layer{plot::LayerKind::line, name, {{"across"}, {"up"}}, colour};
  for (const Vector2& p :
       plot::ellipse_outline(kThousand * centre, covariance, kThousand * reach)) {
    layer.columns[0].numbers.push_back(p.x());
    layer.columns[1].numbers.push_back(p.y());
  }
  return layer;
}

/// One plane of Chong & Kleeman's Figure 4.
plot::Chart plane_chart(const NoiseCalibration& found, int across, int up) {
  constexpr const char* kLabels[] = {"x error [mm]", "y error [mm]", "heading error [mrad]"};
  constexpr const char* kTitles[] = {"Along and across", "Along and heading", "Across and heading"};
  constexpr const char* kIds[] = {"x-y", "x-heading", "y-heading"};
  const std::vector<int> pick = {across, up};
  const NoiseEstimate& estimate = found.estimate;
  plot::Chart chart;
  const auto which = static_cast<std::size_t>(across + up - 1);
  chart.id = kIds[which];
  chart.title = kTitles[which];
  chart.caption =
      which < found.fit.ellipses.size()
          ? fmt::format("{} of {} runs end within the model's 95 % ellipse (p {}).",
                        found.fit.ellipses[which].inside, found.fit.ellipses[which].runs,
                        probability_text(found.fit.ellipses[which].p_value))
          : "End errors of the runs.";
  chart.x = {.title = kLabels[across], .zero = true};
  chart.y = {.title = kLabels[up], .zero = true};
  chart.height = 340.0;
  plot::ChartLayer runs{
      plot::LayerKind::dots, "end errors", {{kLabels[across]}, {kLabels[up]}, {"run"}}, "7"};
  runs.size = found.errors.size() > 300 ? 2.0 : 3.5;
  for (const std::size_t k : plot::thinned(found.errors.size(), kMostErrors)) {
    runs.columns[0].numbers.push_back(kThousand * found.errors[k][across]);
    runs.columns[1].numbers.push_back(kThousand * found.errors[k][up]);
    runs.columns[2].numbers.push_back(static_cast<double>(k + 1));
  }
  const Vector2 centre = estimate.centre(pick);
  chart.layers.push_back({plot::LayerKind::level, "", {{"", {0.0}}}, "faint"});
  chart.layers.push_back({plot::LayerKind::upright, "", {{"", {0.0}}}, "faint"});
  chart.layers.push_back(std::move(runs));
  chart.layers.push_back(
      outline_layer("95 % ellipse of the runs", centre, estimate.observed(pick, pick), "ink"));
  chart.layers.push_back(
      outline_layer("95 % ellipse of the model", centre, estimate.modelled(pick, pick), "2"));
  chart.layers.back().dashed = true;
  for (int sigma = 1; found.stated && sigma <= 3; ++sigma) {
    chart.layers.push_back(outline_layer(fmt::format("{} sigma by the k stated", sigma),
                                         Vector2(found.stated->centre(pick)),
                                         found.stated->modelled(pick, pick), "3", sigma));
  }
  return chart;
}

PageTable stated_table(const StatedNoise& stated) {
  PageTable table;
  table.caption = fmt::format("By the k stated, {:.2g} and {:.2g} m^1/2 (p {})", stated.left,
                              stated.right, probability_text(stated.p_value));
  table.headings = sigma_heading();
  table.rows = sigma_rows(stated);
  return table;
}

plot::Chart constant_chart(const NoiseEstimate& estimate) {
  plot::Chart chart;
  chart.id = "wheels";
  chart.title = "Noise of each wheel";
  chart.caption =
      "k with its 95 % interval: after d metres the wheel's travel is uncertain by k times the "
      "root of d.";
  chart.x = {.title = "k [10\u207b\u00b3 m^1/2]", .zero = true};
  chart.y.categories = {"left wheel", "right wheel"};
  chart.height = plot::bars_height(2);
  plot::ChartColumn value{"k [10^-3 m^1/2]"};
  plot::ChartColumn low{"95 % from"};
  plot::ChartColumn high{"to"};
  for (const WheelConstant& wheel : {estimate.left, estimate.right}) {
    const double reach =
        std::isfinite(wheel.standard_error) ? plot::kNormal95 * wheel.standard_error : 0.0;
    value.numbers.push_back(kThousand * wheel.k);
    low.numbers.push_back(kThousand * std::max(0.0, wheel.k - reach));
    high.numbers.push_back(kThousand * (wheel.k > 0.0 ? wheel.k + reach : wheel.upper_limit));
  }
  chart.layers.push_back(
      {plot::LayerKind::intervals, "", {{"", {}, chart.y.categories}, value, low, high}, "1"});
  return chart;
}

PageTable fit_table(const NoiseCalibration& found) {
  PageTable table;
  table.caption = "Does the model fit?";
  table.headings = {"", "p", "runs inside"};
  for (const EllipseCount& one : found.fit.ellipses) {
    table.rows.push_back({"runs in the 95 % ellipse, " + one.coordinates,
                          probability_text(one.p_value),
                          fmt::format("{} of {}", one.inside, one.runs)});
  }
  table.rows.push_back(
      {"distances as chi-square has them", probability_text(found.fit.distance_p_value), ""});
  table.rows.push_back(
      {"covariance as two wheels give it", probability_text(found.fit.shape_p_value), ""});
  return table;
}

}  // namespace

Page noise_page(const NoiseCalibration& found, const std::string& subject) {
  const NoiseEstimate& estimate = found.estimate;
  PageContent page;
  page.command = "noise";
  page.subject = subject;
  page.tone = found.fit.good ? Tone::good : Tone::bad;
  const double worse = std::max(estimate.left.k, estimate.right.k);
  page.verdict = fmt::format(
      "The wheels' noise {} the end errors of {} runs: the noisier wheel is uncertain by {:.2g} mm "
      "after 1 m, and by {:.2g} mm after the path's {:g} m.",
      found.fit.good ? "explains" : "does not explain", estimate.runs, kThousand * worse,
      kThousand * worse * std::sqrt(found.path), found.path);
  page.facts = {{constant_text(estimate.left), "left wheel, k [10\u207b\u00b3 m^1/2]"},
                {constant_text(estimate.right), "right wheel, k [10\u207b\u00b3 m^1/2]"},
                {std::to_string(estimate.runs), "runs"}};
  page.notes = found.doubts;
  page.sections.push_back(
      {"Where the runs ended",
       {ChartRow{plane_chart(found, 0, 1), plane_chart(found, 0, 2), plane_chart(found, 1, 2)}}});
  page.sections.push_back({"The wheels", {ChartRow{constant_chart(estimate)}, fit_table(found)}});
  if (found.stated) page.sections.push_back({"As stated", {stated_table(*found.stated)}});
  return page;
}

}  // namespace trussmap
