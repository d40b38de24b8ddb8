// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/places_found.hpp"

#include "plot/layers.hpp"
#include "report/page_words.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"
#include "wording/channel_words.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

constexpr double kFieldHeight = 480.0;  // pixels
constexpr double kFieldWidth = 560.0;   // that the marks have, about

/// Cells as dots: large where the field is known, small where hardly anything is.
plot::ChartLayer cells_layer(const FieldOfPlaces& field, const wording::ShownUnit& unit,
                             double most, bool known) {
  constexpr double kKnown = 0.6;  // of the field's size
  const double scale = std::min(kFieldWidth / field.columns, (kFieldHeight - 80.0) / field.rows);
  plot::ChartLayer layer{plot::LayerKind::dots,
                         known ? "known well" : "uncertain",
                         {{"x [m]"},
                          {"y [m]"},
                          {fmt::format("value [{}]", unit.name)},
                          {fmt::format("standard error [{}]", unit.name)}}};
  layer.size = (known ? 0.45 : 0.2) * scale;
  for (const FieldCell& one : field.cells_driven()) {
    if ((one.sd < kKnown * field.size) != known) continue;
    layer.columns[0].numbers.push_back(one.centre.x());
    layer.columns[1].numbers.push_back(one.centre.y());
    layer.columns[2].numbers.push_back(unit.factor * one.mean);
    layer.columns[3].numbers.push_back(unit.factor * one.sd);
    layer.shade.push_back(one.mean / most);
  }
  return layer;
}

plot::Chart field_chart(const FieldOfPlaces& field) {
  const wording::ShownUnit unit = wording::shown_unit(std::string(facts_of(field.channel).unit));
  const double most = std::max(field.most(), 1e-300);
  plot::Chart chart;
  chart.id = fmt::format("places-{}", name_of(field.channel));
  chart.title = capitalised(field_in_words(field.channel));
  chart.caption =
      "What it is near each place that the robot drove over, less its mean over the way: the mean "
      "of all smooth fields, each by how well it explains the measurements. Small dots: its "
      "standard error there is more than 0.6 of what the field varies by as a whole.";
  chart.x.title = "x [m]";
  chart.y.title = "y [m]";
  chart.equal_aspect = true;
  chart.height = kFieldHeight;
  for (const bool known : {true, false}) {
    plot::ChartLayer layer = cells_layer(field, unit, most, known);
    if (layer.shade.empty()) continue;
    if (chart.layers.empty()) {
      layer.key = {fmt::format("{:.2g} {}", -unit.factor * most, unit.name), "as on average",
                   fmt::format("{:.2g} {}", unit.factor * most, unit.name)};
    }
    chart.layers.push_back(std::move(layer));
  }
  return chart;
}

}  // namespace

std::string places_text(const Diagnosis& diagnosis) {
  std::string text;
  for (const FieldOfPlaces& one : diagnosis.places) {
    if (text.empty()) text = "\nWhat differs from place to place\n";
    text += fmt::format("  {} (p {})\n", in_words(one), probability_text(one.p_value));
  }
  return text;
}

void add_places(const Diagnosis& diagnosis, PageContent& page) {
  if (diagnosis.places.empty()) return;
  ChartRow charts;
  for (const FieldOfPlaces& one : diagnosis.places) charts.push_back(field_chart(one));
  page.sections.push_back(told_section("What differs from place to place",
                                       sentences_of(diagnosis.places), std::move(charts)));
}

}  // namespace trussmap::report
