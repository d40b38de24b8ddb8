// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/fit_charts.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::plot {
namespace {

constexpr std::size_t kMostQuantiles = 120;  // of a source
constexpr std::size_t kFewest = 5;           // values that make a line

double normal_order_statistic(std::size_t k, std::size_t count) {
  return statistics::normal_quantile((static_cast<double>(k) + 0.5) / static_cast<double>(count));
}

/// Places in a sorted sample: all, or some evenly spread over the axis of quantiles, both ends
/// among them.
std::vector<std::size_t> drawn_places(std::size_t count) {
  std::vector<std::size_t> places;
  if (count <= kMostQuantiles) {
    for (std::size_t k = 0; k < count; ++k) places.push_back(k);
    return places;
  }
  const double end = normal_order_statistic(count - 1, count);
  for (std::size_t k = 0; k < kMostQuantiles; ++k) {
    const double z =
        end * (2.0 * static_cast<double>(k) / static_cast<double>(kMostQuantiles - 1) - 1.0);
    const double share = statistics::normal_p_value(-z);
    const auto place = static_cast<std::size_t>(std::clamp(
        std::floor(share * static_cast<double>(count)), 0.0, static_cast<double>(count - 1)));
    if (places.empty() || places.back() != place) places.push_back(place);
  }
  return places;
}

}  // namespace

Chart quantile_chart(const std::string& id, const std::string& title,
                     const std::vector<SourceResiduals>& sources) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.caption =
      "Every error over its standard deviation, as the model states it, against where a normal "
      "distribution would have it. On the line: as stated. Steeper: more noise than stated, or an "
      "effect is missing. Straight, but for a few at the ends: those are outliers.";
  chart.x.title = "expected [standard deviations]";
  chart.y.title = "seen [standard deviations]";
  chart.height = 300.0;
  double reach = 1.0;
  for (const SourceResiduals& one : sources) {
    if (one.standardised.size() < kFewest) continue;
    reach = std::max(reach,
                     normal_order_statistic(one.standardised.size() - 1, one.standardised.size()));
  }
  ChartLayer line{LayerKind::line, "as stated", {{""}, {""}}, "faint"};
  for (ChartColumn& column : line.columns) column.numbers = {-reach, reach};
  chart.layers.push_back(std::move(line));
  int colour = 0;
  for (const SourceResiduals& one : sources) {
    const std::size_t count = one.standardised.size();
    if (count < kFewest) continue;
    ChartLayer dots{LayerKind::dots,
                    one.source,
                    {{chart.x.title}, {chart.y.title}},
                    std::to_string(1 + colour++ % 8)};
    dots.size = 3.0;
    for (const std::size_t k : drawn_places(count)) {
      dots.columns[0].numbers.push_back(normal_order_statistic(k, count));
      dots.columns[1].numbers.push_back(one.standardised[k]);
    }
    chart.layers.push_back(std::move(dots));
  }
  return chart;
}

Chart histogram_chart(const std::string& id, const std::string& title,
                      const std::vector<SourceResiduals>& sources) {
  constexpr int kSteps = 20;  // half of them either way; the last ones take what is beyond
  constexpr int kReach = kSteps / 2;
  constexpr double kStep = 0.5;  // standard deviations
  std::vector<double> counts(kSteps, 0.0);
  double all = 0.0;
  for (const SourceResiduals& one : sources) {
    for (const double z : one.standardised) {
      if (!std::isfinite(z)) continue;
      const double bin = std::clamp(std::floor(z / kStep), -1.0 * kReach, kReach - 1.0);
      counts[static_cast<std::size_t>(bin + kReach)] += 1.0;
      all += 1.0;
    }
  }
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.caption =
      "Every error over its standard deviation, as the model states it, in steps of half a "
      "standard deviation; those beyond 5 are in the outermost. The faint line is what a normal "
      "distribution would show. Wider: more noise than stated, or an effect is missing.";
  chart.x.title = "error [standard deviations]";
  chart.y.title = "share [%]";
  chart.y.zero = true;
  chart.height = 300.0;
  if (all < static_cast<double>(kFewest)) return chart;
  ChartLayer normal{LayerKind::line, "as stated", {{""}, {""}}, "faint"};
  ChartLayer outline{LayerKind::line, "", {{""}, {""}}, "1"};
  ChartLayer seen{LayerKind::dots, "seen", {{chart.x.title}, {chart.y.title}}, "1"};
  seen.size = 3.0;
  for (int k = 0; k < kSteps; ++k) {
    const double from = kStep * (k - kReach);
    // normal_p_value(x): the share beyond x.
    const double within =
        statistics::normal_p_value(from) - statistics::normal_p_value(from + kStep);
    const double share = 100.0 * counts[static_cast<std::size_t>(k)] / all;
    for (const double x : {from, from + kStep}) {
      normal.columns[0].numbers.push_back(x);
      normal.columns[1].numbers.push_back(100.0 * within);
      outline.columns[0].numbers.push_back(x);
      outline.columns[1].numbers.push_back(share);
    }
    seen.columns[0].numbers.push_back(from + 0.5 * kStep);
    seen.columns[1].numbers.push_back(share);
  }
  chart.layers.push_back(std::move(normal));
  chart.layers.push_back(std::move(outline));
  chart.layers.push_back(std::move(seen));
  return chart;
}

}  // namespace trussmap::plot
