// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/layers.hpp"
#include "report/page.hpp"
#include "report/quantity_cells.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

std::string heading_of(const FleetFinding& finding, const FleetCoefficient& one) {
  return finding.coefficients.size() == 1 ? finding.effect
                                          : fmt::format("{}: {}", finding.effect, one.shape);
}

/// One row per thing said.
PageTable findings_table(const FleetReport& report) {
  PageTable table;
  table.caption = "Per effect";
  table.headings = {"effect", "what", "size", "p"};
  table.texts = 2;
  const auto row = [&table](const std::string& effect, const std::string& what,
                            const std::string& size, double p, Tone tone = Tone::neutral) {
    table.rows.push_back({effect, what, size, probability_text(p)});
    table.tones.push_back(tone);
  };
  for (const FleetFinding& finding : report.findings) {
    if (!finding.of_model) row(finding.effect, "missing from the model", "", finding.p_adjusted);
    for (const FleetCoefficient& one : finding.coefficients) {
      const std::string effect = heading_of(finding, one);
      if (one.common && one.goes_with.empty()) {
        row(effect, fmt::format("common to all {} robots", one.robots),
            with_error(one.mean, one.sd), one.p_common);
      }
      for (const FleetKey& key : one.goes_with) {
        std::string keys = key.key;
        for (const std::string& other : key.same_as) keys += fmt::format(", or {}", other);
        row(effect, fmt::format("goes with {}", keys), "", key.p_adjusted);
        for (const FleetGroup& group : key.groups) {
          row(effect, fmt::format("{} {} ({} robots)", key.key, group.value, group.robots),
              with_error(group.mean, group.sd), group.p_value);
        }
      }
      if (one.p_tau < report.level) {
        row(effect, "robots scatter beyond their errors", fmt::format("{:.2g}", one.tau),
            one.p_tau);
      }
      if (one.all_drift) {
        row(effect, "drift in all robots, per day", with_error(one.slope, one.slope_sd),
            one.p_slope);
      }
      for (const FleetRobot& robot : one.members) {
        if (robot.differs) {
          row(effect, fmt::format("robot {} differs", robot.robot),
              with_error(robot.value, robot.sd), robot.p_differs, Tone::bad);
        }
        if (robot.drifts) {
          row(effect, fmt::format("robot {} drifts, per day", robot.robot),
              with_error(robot.slope, robot.slope_sd), robot.p_drifts, Tone::bad);
        }
      }
    }
    for (const FleetLookAlike& rival : finding.look_alikes) {
      table.rows.push_back({finding.effect, fmt::format("looks the same here: {}", rival.effect),
                            fmt::format("cosine {:.3f}", rival.cosine), ""});
      table.tones.push_back(Tone::neutral);
    }
  }
  return table;
}

/// A mark and a 95 % interval per robot, those that `stand_out` apart; lines across.
template <typename Marks>
plot::Chart robots_chart(const std::string& id, const std::string& title, const std::string& y,
                         const FleetCoefficient& one, const std::vector<double>& levels,
                         const std::string& stand_out, const Marks& marks) {
  plot::Chart chart;
  chart.id = id;
  chart.title = title;
  chart.x.title = "robot, in the order of the table";
  chart.y.title = y;
  const std::vector<plot::ChartColumn> columns{
      {"number"}, {"estimate"}, {"from"}, {"to"}, {"robot"}};
  plot::ChartLayer usual{plot::LayerKind::intervals, "robots", columns, "7"};
  plot::ChartLayer others{plot::LayerKind::intervals, stand_out, columns, "bad"};
  for (std::size_t k = 0; k < one.members.size(); ++k) {
    const auto [there, value, sd, bad] = marks(one.members[k]);
    if (!there) continue;
    plot::ChartLayer& layer = bad ? others : usual;
    layer.columns[0].numbers.push_back(static_cast<double>(k + 1));
    layer.columns[1].numbers.push_back(value);
    layer.columns[2].numbers.push_back(value - plot::kNormal95 * sd);
    layer.columns[3].numbers.push_back(value + plot::kNormal95 * sd);
    layer.columns[4].texts.push_back(one.members[k].robot);
  }
  chart.layers.push_back({plot::LayerKind::level, "", {{"", levels}}, "faint"});
  for (plot::ChartLayer* layer : {&usual, &others}) {
    if (!layer->columns[0].numbers.empty()) chart.layers.push_back(std::move(*layer));
  }
  return chart;
}

struct RobotMark {
  bool there = false;
  double value = 0.0;
  double sd = 0.0;
  bool stands_out = false;
};

plot::Chart values_chart(const FleetFinding& finding, const FleetCoefficient& one,
                         std::size_t number) {
  std::vector<double> levels;
  for (const FleetKey& key : one.goes_with) {
    for (const FleetGroup& group : key.groups) levels.push_back(group.mean);
  }
  const bool groups = !levels.empty();
  if (!groups) levels.push_back(one.mean);
  plot::Chart chart =
      robots_chart(fmt::format("effect-{}", number), heading_of(finding, one), finding.effect, one,
                   levels, "differ or drift", [](const FleetRobot& robot) {
                     return RobotMark{true, robot.value, robot.sd, robot.differs || robot.drifts};
                   });
  chart.caption = fmt::format(
      "Each robot's own estimate with its 95 % interval (of one that drifts, on its first day). {}",
      groups ? "The lines are the means of the groups." : "The line is the mean of all.");
  return chart;
}

plot::Chart slopes_chart(const FleetFinding& finding, const FleetCoefficient& one,
                         std::size_t number) {
  const std::string title = heading_of(finding, one);
  plot::Chart chart =
      robots_chart(fmt::format("drift-{}", number), fmt::format("{}: drift", title),
                   fmt::format("{}, per day", finding.effect), one, {one.slope}, "drift",
                   [](const FleetRobot& robot) {
                     return RobotMark{robot.has_slope, robot.slope, robot.slope_sd, robot.drifts};
                   });
  chart.caption =
      "Each robot's change per day over its days, with its 95 % interval. The line is the mean.";
  return chart;
}

/// Drifts beside the values where there are any.
ChartRow charts_of(const FleetFinding& finding, const FleetCoefficient& one, std::size_t number) {
  ChartRow row{values_chart(finding, one, number)};
  const bool drifts = std::any_of(one.members.begin(), one.members.end(),
                                  [](const FleetRobot& robot) { return robot.drifts; });
  if (drifts || one.all_drift) row.push_back(slopes_chart(finding, one, number));
  return row;
}

/// One row per robot.
PageTable robots_table(const FleetReport& report) {
  PageTable table;
  table.caption = "Robots: estimates shrunken towards those like them, and standard errors";
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
        std::string text = with_error(robot.shrunken, robot.shrunken_sd);
        if (robot.differs) text += ", differs";
        if (robot.drifts) {
          text += fmt::format(", drifts by {} a day", with_error(robot.slope, robot.slope_sd));
        }
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
      missing > 0 ? fmt::format("{} {} missing from the model of {} robots.", missing,
                                missing == 1 ? "effect is" : "effects are", report.robots)
                  : fmt::format("Nothing is missing from the model of {} robots.", report.robots);
  page.facts = {{std::to_string(report.robots), "robots"},
                {std::to_string(report.days), "days of robots"}};
  page.notes = report.notes;
  if (!report.findings.empty()) {
    page.sections.push_back({"What the fleet shows", {findings_table(report)}});
  }
  PageSection robots{"The robots", {}};
  std::size_t number = 0;
  for (const FleetFinding& finding : report.findings) {
    for (const FleetCoefficient& one : finding.coefficients) {
      if (!one.members.empty()) {
        robots.blocks.emplace_back(charts_of(finding, one, ++number));
      }
    }
  }
  robots.blocks.emplace_back(robots_table(report));
  page.sections.push_back(std::move(robots));
  page.sections.push_back({"Candidates", {tests_table(report)}});
  return page;
}

}  // namespace trussmap
