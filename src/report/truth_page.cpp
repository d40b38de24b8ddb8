// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/layers.hpp"
#include "report/page.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

struct Row {
  const char* name;
  const std::optional<Calibrated>& found;
};

plot::Chart interval_chart(const char* id, const char* title, const char* caption, const char* axis,
                           const std::vector<Row>& rows, double nominal, double factor) {
  plot::Chart chart;
  chart.id = id;
  chart.title = title;
  chart.caption = caption;
  chart.x = {.title = axis, .zero = true};
  if (nominal != 0.0) {
    chart.layers.push_back({plot::LayerKind::upright, "", {{"nominal", {0.0}}}, "faint"});
  }
  std::vector<plot::NamedInterval> intervals;
  for (const Row& row : rows) {
    if (!row.found) continue;
    intervals.push_back({row.name, factor * (row.found->value - nominal),
                         factor * plot::kNormal95 * row.found->sd});
  }
  plot::add_intervals(chart, axis, intervals);
  return chart;
}

std::vector<double> in_millimetres(const std::vector<double>& metres) {
  std::vector<double> result;
  result.reserve(metres.size());
  for (const double value : metres) result.push_back(1000.0 * value);
  return result;
}

plot::Chart arrival_chart(const TruthCalibration& found) {
  plot::Chart chart;
  chart.id = "held-out";
  chart.title = "How far off held-out legs end";
  chart.caption =
      "Share of the legs, none of them used for the calibration that is judged, that end within a "
      "distance of the truth. Further to the left is better.";
  chart.x = {.title = "distance [mm]", .zero = true};
  chart.y = {.title = "legs within it [%]", .range = plot::Range{0.0, 100.0}};
  chart.height = 300.0;
  plot::add_shares(chart, "nominal", in_millimetres(found.nominal.distances), "mm", "2");
  plot::add_shares(chart, "calibrated", in_millimetres(found.calibrated.distances), "mm", "1");
  return chart;
}

PageTable table_of(const WheelCalibration& wheels) {
  PageTable table;
  table.caption = "What was found";
  table.headings = {"", "value", "standard error", "unit"};
  const auto row = [&table](const std::string& name, const std::optional<Calibrated>& one,
                            const std::string& unit) {
    if (!one) {
      table.rows.push_back({name, "not determined", "", unit});
      return;
    }
    const QuantityText text = quantity_text(one->value, one->sd);
    table.rows.push_back({name, text.value, text.error, unit});
  };
  if (!wheels.constants.empty()) {
    for (const DriveConstant& one : wheels.constants) {
      const ChannelFacts& facts = facts_of(one.channel);
      const double size = facts.unit.empty() ? 100.0 : 1.0;
      row(std::string(facts.does_what), Calibrated{size * one.g.value, size * one.g.sd},
          facts.unit.empty() ? "%" : std::string(facts.unit));
    }
    return table;
  }
  row("E_d, right wheel over left", wheels.diameter_ratio, "");
  row("E_b, wheelbase over nominal", wheels.wheelbase_ratio, "");
  row("E_s, true over measured travel", wheels.scale, "");
  row("k, left wheel's noise", wheels.noise_left, "m^1/2");
  row("k, right wheel's noise", wheels.noise_right, "m^1/2");
  return table;
}

}  // namespace

Page truth_page(const TruthCalibration& found, const std::string& subject) {
  const WheelCalibration& wheels = found.wheels;
  PageContent page;
  page.command = "calibrate";
  page.subject = subject;
  page.verdict = found.verdict;
  const bool judged = found.calibrated.legs() > 0;
  const bool better = judged && found.calibrated.rms() <= found.nominal.rms();
  page.tone = !judged ? Tone::neutral : better ? Tone::good : Tone::bad;
  if (judged) {
    page.facts.push_back({fmt::format("{:.1f} mm", 1000.0 * found.nominal.rms()),
                          "held-out legs end so far off, nominal"});
    page.facts.push_back({fmt::format("{:.1f} mm", 1000.0 * found.calibrated.rms()),
                          "the same, calibrated", page.tone});
  }
  page.facts.push_back({fmt::format("{:.2f}", wheels.dof > 0 ? wheels.chi2 / wheels.dof : 0.0),
                        "chi\u00b2 per degree of freedom (1 is right)"});
  for (const std::string& one : wheels.undetermined) page.notes.push_back("Not determined: " + one);
  if (judged) {
    page.sections.push_back({"What the calibration gains", {ChartRow{arrival_chart(found)}}});
  }
  if (!wheels.constants.empty()) {
    page.sections.push_back({"What was found", {table_of(wheels)}});
    return page;
  }
  ChartRow charts{interval_chart("ratios", "Wheels and wheelbase, in percent of nominal",
                                 "With 95 % intervals; 0 is a robot that is as its model has it.",
                                 "off by [%]",
                                 {{"E_d: right wheel over left", wheels.diameter_ratio},
                                  {"E_b: wheelbase", wheels.wheelbase_ratio},
                                  {"E_s: travel", wheels.scale}},
                                 1.0, 100.0)};
  if (wheels.noise_left && wheels.noise_right) {
    charts.push_back(interval_chart(
        "noise", "Noise of each wheel",
        "k with its 95 % interval: after d metres the wheel's travel is uncertain by k times the "
        "root "
        "of d.",
        "k [10\u207b\u00b3 m^1/2]",
        {{"left wheel", wheels.noise_left}, {"right wheel", wheels.noise_right}}, 0.0, 1000.0));
  }
  page.sections.push_back({"What was found", {std::move(charts), table_of(wheels)}});
  return page;
}

}  // namespace trussmap
