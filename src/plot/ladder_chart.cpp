// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "plot/fit_charts.hpp"
#include "plot/layers.hpp"

#include <algorithm>

namespace trussmap::plot {

Chart ladder_chart(const std::string& id, const std::vector<LadderStep>& steps, double floor) {
  Chart chart;
  chart.id = id;
  chart.title = "The error, step by step";
  chart.caption =
      "How far off held-out legs end (root mean square), each model on legs that its fit has not "
      "seen. Shorter is better.";
  chart.x = {.title = "held-out legs end off by [mm]", .zero = true};
  ChartColumn name{"model"};
  ChartColumn error{"held-out error [mm]"};
  ChartColumn misfit{"chi\u00b2 per degree of freedom"};
  for (const LadderStep& step : steps) {
    name.texts.push_back(step.name);
    error.numbers.push_back(geometry::kMillimetres * step.arrival_rms);
    misfit.numbers.push_back(step.chi2 / std::max(1, step.dof));
  }
  make_unique(name.texts);  // an effect that was added twice has two places on the axis
  ChartColumn of{"step"};
  ChartColumn predicted{"predicted [mm]"};
  for (std::size_t k = 0; k < steps.size(); ++k) {
    if (!steps[k].predicted_rms) continue;
    of.texts.push_back(name.texts[k]);
    predicted.numbers.push_back(geometry::kMillimetres * *steps[k].predicted_rms);
  }
  chart.y.categories = name.texts;
  chart.height = bars_height(steps.size());
  chart.layers.push_back({LayerKind::bars, "", {name, error, misfit}, "1"});
  if (floor > 0.0) {
    chart.layers.push_back({LayerKind::upright,
                            "noise alone",
                            {{"noise alone [mm]", {geometry::kMillimetres * floor}}},
                            "ink",
                            0.0,
                            true});
    chart.caption +=
        " The dashed line is what this robot's noise alone would leave; no effect goes below it by "
        "more than chance.";
  }
  if (!predicted.numbers.empty()) {
    chart.layers.push_back({LayerKind::intervals,
                            "as predicted",
                            {of, predicted, {"", predicted.numbers}, {"", predicted.numbers}},
                            "2"});
  }
  return chart;
}

}  // namespace trussmap::plot
