// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/layers.hpp"
#include "report/page.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string quantity(double value, double sd) {
  const QuantityText text = quantity_text(value, sd);
  return text.error.empty() ? text.value : fmt::format("{} \u00b1 {}", text.value, text.error);
}

std::string heading_of(const FleetFinding& finding, const FleetCoefficient& one) {
  return finding.coefficients.size() == 1 ? finding.effect
                                          : fmt::format("{}: {}", finding.effect, one.shape);
}

/// Robots in the order of their names, shrunken estimates with 95 % intervals.
Chart robots_chart(const FleetFinding& finding, const FleetCoefficient& one, std::size_t number) {
  Chart chart;
  chart.id = fmt::format("effect-{}", number);
  chart.title = heading_of(finding, one);
  chart.caption = fmt::format(
      "Each robot's estimate, shrunken towards those like it, with its 95 % interval; robots that "
      "differ keep their own. The line is the mean of all.");
  chart.x.title = "robot, in the order of the table";
  chart.y.title = finding.effect;
  ChartLayer usual{
      LayerKind::intervals, "robots", {{"robot"}, {"estimate"}, {"from"}, {"to"}}, "7"};
  ChartLayer others{
      LayerKind::intervals, "differ or drift", {{"robot"}, {"estimate"}, {"from"}, {"to"}}, "bad"};
  for (std::size_t k = 0; k < one.members.size(); ++k) {
    const FleetRobot& robot = one.members[k];
    ChartLayer& layer = robot.differs || robot.drifts ? others : usual;
    layer.columns[0].numbers.push_back(static_cast<double>(k + 1));
    layer.columns[1].numbers.push_back(robot.shrunken);
    layer.columns[2].numbers.push_back(robot.shrunken - kNormal95 * robot.shrunken_sd);
    layer.columns[3].numbers.push_back(robot.shrunken + kNormal95 * robot.shrunken_sd);
  }
  chart.layers.push_back({LayerKind::level, "", {{"", {one.mean}}}, "faint"});
  for (ChartLayer* layer : {&usual, &others}) {
    if (!layer->columns[0].numbers.empty()) chart.layers.push_back(std::move(*layer));
  }
  return chart;
}

/// One row per robot.
PageTable robots_table(const FleetReport& report) {
  PageTable table;
  table.caption = "Robots";
  table.headings = {"robot", "held-out legs off (rms) [mm]"};
  std::map<std::string, std::vector<std::string>> rows;
  std::map<std::string, Tone> tones;
  constexpr double kThousand = 1000.0;
  for (const auto& [robot, rms] : report.held_out_rms) {
    rows[robot] = {robot, fmt::format("{:.1f}", kThousand * rms)};
    tones[robot] = Tone::neutral;
  }
  for (const FleetFinding& finding : report.findings) {
    for (const FleetCoefficient& one : finding.coefficients) {
      table.headings.push_back(heading_of(finding, one));
      for (const FleetRobot& robot : one.members) {
        std::string text = quantity(robot.shrunken, robot.shrunken_sd);
        if (robot.differs) text += ", differs";
        if (robot.drifts) text += ", drifts";
        rows[robot.robot].push_back(text);
        if (robot.differs || robot.drifts) tones[robot.robot] = Tone::bad;
      }
      for (auto& [name, row] : rows) row.resize(table.headings.size());
    }
  }
  for (const auto& [robot, row] : rows) {
    table.rows.push_back(row);
    table.tones.push_back(tones[robot]);
  }
  return table;
}

PageTable tests_table(const FleetReport& report) {
  PageTable table;
  table.caption = "Every candidate alone, all robots taken as alike";
  table.headings = {"effect", "chi\u00b2 less", "dof", "p"};
  std::vector<PooledTest> tests = report.tests;
  std::stable_sort(tests.begin(), tests.end(),
                   [](const PooledTest& a, const PooledTest& b) { return a.score > b.score; });
  for (const PooledTest& one : tests) {
    table.rows.push_back({one.effect, fmt::format("{:.1f}", one.score), std::to_string(one.dof),
                          probability_text(one.p_value)});
  }
  return table;
}

}  // namespace

Page fleet_page(const FleetReport& report, const std::string& subject) {
  PageContent page;
  page.command = "fleet report";
  page.subject = subject;
  const auto missing = std::count_if(report.findings.begin(), report.findings.end(),
                                     [](const FleetFinding& one) { return !one.of_model; });
  page.tone = missing > 0 ? Tone::bad : Tone::good;
  page.verdict =
      missing > 0 ? fmt::format("Of {} robots {} {} missing from the model.", report.robots,
                                missing, missing == 1 ? "effect is" : "effects are")
                  : fmt::format("Nothing is missing from the model of {} robots.", report.robots);
  page.facts = {{std::to_string(report.robots), "robots"}, {std::to_string(report.days), "days"}};
  page.notes = report.notes;
  PageSection said{"What the fleet shows", {}};
  for (const std::string& line : in_words(report)) said.blocks.emplace_back(line);
  page.sections.push_back(std::move(said));
  PageSection robots{"The robots", {}};
  std::size_t number = 0;
  for (const FleetFinding& finding : report.findings) {
    for (const FleetCoefficient& one : finding.coefficients) {
      if (!one.members.empty()) {
        robots.blocks.emplace_back(ChartRow{robots_chart(finding, one, ++number)});
      }
    }
  }
  robots.blocks.emplace_back(robots_table(report));
  page.sections.push_back(std::move(robots));
  page.sections.push_back({"Candidates", {tests_table(report)}});
  return page;
}

}  // namespace trussmap
