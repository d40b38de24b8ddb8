// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "plot/layers.hpp"
#include "report/page.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

constexpr std::size_t kMostRuns = 2000;

std::string with_error(const Estimate& estimate, const char* unit) {
  const QuantityText text = quantity_text(estimate.value, estimate.standard_error);
  return text.value + (text.error.empty() ? "" : " \u00b1 " + text.error) +
         (unit[0] == '\0' ? "" : std::string(" ") + unit);
}

void add_cluster(plot::Chart& chart, const std::vector<Eigen::Vector2d>& runs,
                 const SampleMean& mean, const std::string& name, const std::string& colour) {
  plot::ChartLayer dots{
      plot::LayerKind::dots, name + " runs", {{"x error [mm]"}, {"y error [mm]"}, {"run"}}, colour};
  for (const std::size_t k : plot::thinned(runs.size(), kMostRuns)) {
    dots.columns[0].numbers.push_back(geometry::kMillimetres * runs[k].x());
    dots.columns[1].numbers.push_back(geometry::kMillimetres * runs[k].y());
    dots.columns[2].numbers.push_back(static_cast<double>(k + 1));
  }
  chart.layers.push_back(std::move(dots));
  plot::ChartLayer centre =
      plot::ellipse_layer("",
                          {{name + " centre", geometry::kMillimetres * mean.mean,
                            geometry::kMillimetres * geometry::kMillimetres * mean.covariance}},
                          colour);
  if (centre.columns[0].numbers.empty()) return;
  centre.columns[0].name = "x [mm]";
  centre.columns[1].name = "y [mm]";
  centre.columns[2].name = "larger semi-axis [mm]";
  centre.columns[3].name = "smaller [mm]";
  centre.columns[5].name = "";
  chart.layers.push_back(std::move(centre));
}

plot::ChartLayer circle_layer(double radius) {
  plot::ChartLayer layer{
      plot::LayerKind::line, "distance of the farther centre", {{"x [mm]"}, {"y [mm]"}}, "faint"};
  layer.dashed = true;
  layer.size = 1.5;
  for (const Vector2& p : plot::ellipse_outline(Vector2::Zero(), Matrix2::Identity(), radius)) {
    layer.columns[0].numbers.push_back(p.x());
    layer.columns[1].numbers.push_back(p.y());
  }
  return layer;
}

plot::Chart round_chart(const SquareRound& round, std::size_t number, std::size_t rounds,
                        double reach) {
  plot::Chart chart;
  chart.id = fmt::format("round-{}", number);
  chart.title = rounds > 1 ? fmt::format("Round {}: where the robot stopped", number)
                           : "Where the robot stopped after the square";
  chart.caption = fmt::format(
      "Stopping positions, measured less calculated; ellipses hold the centres with 95 % "
      "confidence. The farther centre is {:.0f} mm from where the odometry had it.",
      geometry::kMillimetres * round.clusters.largest_offset.value);
  chart.x = {.title = "x error [mm]", .range = plot::Range{-reach, reach}};
  chart.y = {.title = "y error [mm]", .range = plot::Range{-reach, reach}};
  chart.equal_aspect = true;
  chart.height = rounds > 1 ? 360.0 : 460.0;
  chart.layers.push_back({plot::LayerKind::level, "", {{"", {0.0}}}, "faint"});
  chart.layers.push_back({plot::LayerKind::upright, "", {{"", {0.0}}}, "faint"});
  chart.layers.push_back(
      circle_layer(geometry::kMillimetres * round.clusters.largest_offset.value));
  add_cluster(chart, round.runs.cw, round.clusters.cw, "cw", "2");
  add_cluster(chart, round.runs.ccw, round.clusters.ccw, "ccw", "1");
  return chart;
}

/// Half the side of a square about 0 that holds all runs of the first round, mm.
double reach_of(const SquareRound& round) {
  double reach = round.clusters.largest_offset.value;
  for (const auto* runs : {&round.runs.cw, &round.runs.ccw}) {
    for (const Eigen::Vector2d& run : *runs) reach = std::max(reach, run.cwiseAbs().maxCoeff());
  }
  return 1.1 * geometry::kMillimetres * std::max(reach, 1e-6);
}

PageTable metrics_table(const SquareRound& last) {
  PageTable table;
  table.caption = "What the squares say";
  table.headings = {"", "exact", "by the papers' formulas"};
  if (last.headings) table.headings.emplace_back("by the headings alone");
  const auto row = [&](const char* name, Estimate SquareSolution::*member,
                       Estimate SquareHeadings::*by_heading, const char* unit) {
    table.rows.push_back(
        {name, with_error(last.exact.*member, unit), with_error(last.formulas.*member, unit)});
    if (last.headings) {
      table.rows.back().push_back(with_error((*last.headings).*by_heading, unit));
    }
  };
  row("E_d, right wheel over left", &SquareSolution::diameter_ratio,
      &SquareHeadings::diameter_ratio, "");
  row("E_b, wheelbase over nominal", &SquareSolution::wheelbase_ratio,
      &SquareHeadings::wheelbase_ratio, "");
  row("alpha, missing per quarter turn", &SquareSolution::alpha, &SquareHeadings::alpha, "rad");
  row("beta, turned per leg", &SquareSolution::beta, &SquareHeadings::beta, "rad");
  return table;
}

plot::Chart ratio_chart(const SquareRound& last) {
  plot::Chart chart;
  chart.id = "ratios";
  chart.title = "Wheels and wheelbase, in percent of nominal";
  chart.caption = "With 95 % intervals; 0 is a robot as nominal.";
  chart.x = {.title = "error [%]", .zero = true};
  chart.y.categories = {"right wheel over left", "wheelbase over nominal"};
  chart.height = plot::bars_height(2) + 20.0;
  chart.layers.push_back({plot::LayerKind::upright, "", {{"nominal", {0.0}}}, "faint"});
  int number = 0;
  for (const auto& [name, solution] :
       {std::pair("exact", &last.exact), std::pair("papers' formulas", &last.formulas)}) {
    plot::ChartColumn value{"error [%]"};
    plot::ChartColumn low{"95 % from"};
    plot::ChartColumn high{"to"};
    for (const Estimate& estimate : {solution->diameter_ratio, solution->wheelbase_ratio}) {
      const Interval at = confidence_interval(estimate);
      value.numbers.push_back(100.0 * (estimate.value - 1.0));
      low.numbers.push_back(100.0 * (at.low - 1.0));
      high.numbers.push_back(100.0 * (at.high - 1.0));
    }
    plot::ChartLayer layer{plot::LayerKind::intervals,
                           name,
                           {{"", {}, chart.y.categories}, value, low, high},
                           number == 0 ? "1" : "2"};
    layer.offset = number == 0 ? -6.0 : 6.0;
    ++number;
    chart.layers.push_back(std::move(layer));
  }
  return chart;
}

std::string verdict(const SquareCalibration& found) {
  const SquareClusters& clusters = found.rounds.back().clusters;
  const double size = geometry::kMillimetres * clusters.largest_offset.value;
  if (!found.rounds.back().doubts.empty()) {
    return fmt::format(
        "Doubtful: the square ends {:.0f} mm off, but the runs contradict themselves "
        "or look mistaken, as the notes say; settle these first.",
        size);
  }
  if (!clusters.second_round_worthwhile && clusters.sem > 0.0) {
    return fmt::format(
        "Nothing left to correct: the systematic error of {:.0f} mm is within the runs' scatter.",
        size);
  }
  const std::string before =
      found.rounds.size() == 1
          ? ""
          : fmt::format(
                " ({:.0f} mm at first)",
                geometry::kMillimetres * found.rounds.front().clusters.largest_offset.value);
  return fmt::format(
      "The square ends {:.0f} mm off{}; use a wheelbase of {} m, the left wheel's travel times "
      "{:.5f} "
      "and the right one's times {:.5f}.",
      size, before, quantity_text(found.wheelbase.value, found.wheelbase.standard_error).value,
      found.left_factor.value, found.right_factor.value);
}

}  // namespace

Page square_page(const SquareCalibration& found, const std::string& subject) {
  const SquareRound& last = found.rounds.back();
  PageContent page;
  page.command = "umbmark";
  page.subject = subject;
  const bool good = last.doubts.empty() && !last.clusters.second_round_worthwhile;
  page.tone = good ? Tone::good : Tone::bad;
  page.verdict = verdict(found);
  page.facts = {
      {with_error(found.wheelbase, "m"), "wheelbase to use from now on"},
      {with_error(found.left_factor, ""), "left wheel's travel times"},
      {with_error(found.right_factor, ""), "right wheel's travel times"},
      {fmt::format("{:.2f}\u00b0", geometry::kDegrees * last.exact.alpha.value),
       "missing per quarter turn"},
      {fmt::format("{:.0f} mm", geometry::kMillimetres * last.clusters.largest_offset.value),
       found.rounds.size() > 1 ? "systematic error, last round" : "systematic error", page.tone}};
  page.notes = found.doubts;
  const double reach = reach_of(found.rounds.front());
  ChartRow rounds;
  for (std::size_t k = 0; k < found.rounds.size(); ++k) {
    rounds.push_back(round_chart(found.rounds[k], k + 1, found.rounds.size(), reach));
  }
  page.sections.push_back(
      {fmt::format("Squares of {:g} m, driven both ways", found.side), {std::move(rounds)}});
  page.sections.push_back(
      {"Wheels and wheelbase", {ChartRow{ratio_chart(last)}, metrics_table(last)}});
  return page;
}

}  // namespace trussmap
