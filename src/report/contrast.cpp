// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Two runs of one robot, as text and as a page.
#include "plot/layers.hpp"
#include "report/page.hpp"
#include "report/quantity_cells.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"
#include "trussmap/texts.hpp"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trussmap {
using namespace report;

namespace {

/// Errors in m are small.
double scale_of(const RunFigure& one) {
  return one.dof > 0.0 && one.unit == "m" ? 1e3 : 1.0;
}

std::string unit_of(const FigureChange& one) {
  const RunFigure& figure = one.now ? *one.now : *one.before;
  if (figure.unit == "times") return "";
  return scale_of(figure) > 1.0 ? "mm" : figure.unit;
}

std::string value_text(const std::optional<RunFigure>& one) {
  if (!one) return "not told";
  if (one->dof > 0.0) return fmt::format("{:.3g}", scale_of(*one) * one->value);
  return with_error(one->value, one->sd);
}

/// Of errors how many times as large, else the difference.
std::string change_text(const FigureChange& one) {
  if (!one.before || !one.now) return "";
  if (one.now->dof > 0.0) {
    if (!(one.before->value > 0.0)) return "";
    return fmt::format("\u00d7 {:.3g}", one.now->value / one.before->value);
  }
  const QuantityText text = quantity_text(one.change(), one.change_sd());
  const std::string sign = one.change() > 0.0 ? "+" : "";
  return one.p_value ? fmt::format("{}{} \u00b1 {}", sign, text.value, text.error)
                     : sign + text.value;
}

std::vector<std::string> row_of(const FigureChange& one) {
  return {one.name,
          unit_of(one),
          value_text(one.before),
          value_text(one.now),
          change_text(one),
          one.p_value ? probability_text(*one.p_value) : ""};
}

const std::vector<std::string>& headings() {
  static const std::vector<std::string> kHeadings{"figure", "unit", "before", "now", "change", "p"};
  return kHeadings;
}

std::string sentence(const RunContrast& contrast) {
  const std::size_t told = contrast.told();
  if (told == 0) return "nothing to compare: no figure has an error in both runs";
  if (!contrast.any_changed()) {
    return fmt::format("nothing changed beyond chance, of {} figure{} that both runs tell", told,
                       told == 1 ? "" : "s");
  }
  std::vector<std::string> names;
  for (const FigureChange& one : contrast.figures) {
    if (!one.changed) continue;
    const std::string unit = unit_of(one);
    const bool factor = one.now->dof > 0.0;
    names.push_back(fmt::format("{} ({}{})", one.name, change_text(one),
                                factor || unit.empty() ? "" : " " + unit));
  }
  return fmt::format("changed: {}", fmt::join(names, ", "));
}

std::string verdicts(const RunContrast& contrast) {
  if (contrast.before.empty() && contrast.now.empty()) return "";
  const auto said = [](const std::string& verdict) { return verdict.empty() ? "-" : verdict; };
  return fmt::format("verdicts: {} before, {} now", said(contrast.before), said(contrast.now));
}

/// Changes in their own standard errors, so that all stand on one axis.
plot::Chart changes_chart(const RunContrast& contrast) {
  plot::Chart chart;
  chart.id = "changes";
  chart.title = "What changed";
  chart.caption =
      "Each change over its standard error, with its 95 % interval: one that holds 0 is no change. "
      "What is significant over all figures together is in the table.";
  const char* axis = "change [standard errors]";
  chart.x = {.title = axis, .zero = true};
  chart.layers.push_back({plot::LayerKind::upright, "", {{"as before", {0.0}}}, "faint"});
  std::vector<plot::NamedInterval> rows;
  for (const FigureChange& one : contrast.figures) {
    if (!one.p_value || one.now->dof > 0.0) continue;
    rows.push_back({one.name, one.change() / one.change_sd(), plot::kNormal95});
  }
  plot::add_intervals(chart, axis, rows);
  return chart;
}

}  // namespace

std::string contrast_text(const RunContrast& contrast, TextStyle style) {
  const Mood mood = contrast.told() == 0 || contrast.any_changed() ? Mood::doubt : Mood::good;
  std::string out = verdict_text(mood, sentence(contrast), style) + "\n";
  if (const std::string said = verdicts(contrast); !said.empty()) out += said + "\n";
  TextTable table{
      {Align::left, Align::left, Align::right, Align::right, Align::right, Align::right},
      {headings()},
      true,
      2};
  for (const FigureChange& one : contrast.figures) table.rows.push_back(row_of(one));
  if (contrast.any_changed()) {
    table.columns.push_back(Align::left);
    table.rows.front().emplace_back("");
    for (std::size_t k = 0; k < contrast.figures.size(); ++k) {
      table.rows[k + 1].emplace_back(contrast.figures[k].changed ? "changed" : "");
    }
  }
  return out + "\n" + table_text(table, style);
}

Page contrast_page(const RunContrast& contrast, const std::string& subject) {
  PageContent page;
  page.command = "contrast";
  page.subject = subject;
  page.verdict = sentence(contrast);
  page.tone = contrast.told() == 0 || contrast.any_changed() ? Tone::neutral : Tone::good;
  if (const std::string said = verdicts(contrast); !said.empty()) page.notes.push_back(said);
  PageTable table;
  table.caption = "Every figure";
  table.headings = headings();
  table.texts = 2;
  for (const FigureChange& one : contrast.figures) {
    table.rows.push_back(row_of(one));
    table.tones.push_back(one.changed ? Tone::bad : Tone::neutral);
  }
  PageSection section{"Before and now", {}};
  plot::Chart chart = changes_chart(contrast);
  if (!chart.y.categories.empty()) section.blocks.emplace_back(ChartRow{std::move(chart)});
  section.blocks.emplace_back(std::move(table));
  page.sections.push_back(std::move(section));
  return page;
}

}  // namespace trussmap
