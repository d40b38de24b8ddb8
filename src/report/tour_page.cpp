// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "plot/layers.hpp"
#include "plot/map_picture.hpp"
#include "report/page.hpp"
#include "report/page_words.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/tour_experiment.hpp"

#include <algorithm>
#include <map>
#include <optional>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

constexpr std::size_t kMostTours = 250;  // drawn

struct MethodLook {
  const char* words;
  const char* colour;
};

MethodLook look_of(const std::string& method) {
  static const std::map<std::string, MethodLook> kMethodLooks = {
      {"dead_reckoning", {"dead reckoning", "5"}},
      {"raw", {"single measurements", "8"}},
      {"weighted_average", {"weighted average", "3"}},
      {"elastic_printed", {"elastic, as printed", "4"}},
      {"elastic", {"elastic", "2"}},
      {"gauss_markov", {"Gauss-Markov", "6"}},
      {"adjustment", {"adjustment", "1"}},
      {"first_sight", {"first sight alone", "7"}}};
  const auto found = kMethodLooks.find(method);
  return found == kMethodLooks.end() ? MethodLook{method.c_str(), "ink"} : found->second;
}

using Pick = std::optional<SeedMean> (*)(const TourMetrics&);

std::optional<SeedMean> stretch(const TourMetrics& figures) {
  return figures.stretch_error;
}
std::optional<SeedMean> orientation(const TourMetrics& figures) {
  return figures.orientation_error;
}
std::optional<SeedMean> position(const TourMetrics& figures) {
  return figures.position_error;
}

struct Quantity {
  const char* id;
  const char* title;
  const char* axis;
  double factor;
  Pick pick;
};

/// The first tours all, later ones thinned out.
std::vector<std::size_t> drawn_tours(std::size_t count) {
  std::vector<std::size_t> tours;
  const std::size_t step = 1 + count / kMostTours;
  for (std::size_t k = 0; k < count; k += k < 20 ? 1 : step) tours.push_back(k);
  if (tours.back() != count - 1) tours.push_back(count - 1);
  return tours;
}

plot::Chart error_chart(const TourResult& result, const Quantity& quantity) {
  plot::Chart chart;
  chart.id = quantity.id;
  chart.title = quantity.title;
  chart.caption =
      "Mean error of each method's map after every tour; bands are 95 % intervals of the mean over "
      "the seeds. Lower is better.";
  chart.x.title = "tour";
  chart.y = {.title = quantity.axis, .log = true};
  chart.height = 380.0;
  const std::vector<std::size_t> tours = drawn_tours(result.tours.size());
  std::vector<plot::ChartLayer> lines;
  std::vector<plot::ChartLayer> points;
  for (const std::string& method : tour_methods()) {
    if (!quantity.pick(result.tours.front().at(method))) continue;
    const auto [words, colour] = look_of(method);
    plot::ChartColumn tour{"tour"};
    plot::ChartColumn mean{quantity.axis};
    plot::ChartColumn low{"95 % from"};
    plot::ChartColumn high{"to"};
    for (const std::size_t k : tours) {
      const SeedMean error = *quantity.pick(result.tours[k].at(method));
      const double value = quantity.factor * error.mean;
      const double reach = quantity.factor * plot::kNormal95 * error.standard_error;
      tour.numbers.push_back(static_cast<double>(k + 1));
      mean.numbers.push_back(value);
      low.numbers.push_back(std::max(value - reach, 0.1 * value));
      high.numbers.push_back(value + reach);
    }
    chart.layers.push_back({plot::LayerKind::band, "", {tour, low, high}, colour});
    lines.push_back({plot::LayerKind::line, words, {tour, mean}, colour});
    points.push_back({plot::LayerKind::dots, words, {tour, mean, low, high}, colour});
    points.back().size = tours.size() > 60 ? 2.0 : 3.0;
  }
  for (std::vector<plot::ChartLayer>* more : {&lines, &points}) {
    for (plot::ChartLayer& layer : *more) chart.layers.push_back(std::move(layer));
  }
  return chart;
}

PageTable last_table(const TourResult& result) {
  PageTable table;
  table.caption = fmt::format("After tour {}", result.tours.size());
  table.headings = {"method", "stretch error [%]", "orientation error [mrad]",
                    "position error [m]"};
  for (const std::string& method : tour_methods()) {
    const TourMetrics& figures = result.tours.back().at(method);
    const auto cell = [](const SeedMean& mean, double factor, int digits) {
      return fmt::format("{:.{}f} \u00b1 {:.{}f}", factor * mean.mean, digits,
                         factor * mean.standard_error, digits);
    };
    table.rows.push_back({look_of(method).words, cell(figures.stretch_error, 100.0, 2),
                          cell(figures.orientation_error, 1000.0, 1),
                          figures.position_error ? cell(*figures.position_error, 1.0, 3) : "-"});
  }
  return table;
}

plot::Chart first_sight_chart(const TourResult& result) {
  plot::Chart chart;
  chart.id = "first-sight";
  chart.title = "First sight, tour 1";
  chart.caption =
      "Errors of the routes before and after first-sight correction alone: it makes the map "
      "consistent, not the single route better.";
  chart.x = {.title = "error [%; orientation: hundredths of a radian]", .zero = true};
  chart.y.categories = {"stretch, before", "stretch, after", "orientation, before",
                        "orientation, after"};
  chart.height = plot::bars_height(4);
  plot::ChartColumn value{"error"};
  plot::ChartColumn low{"95 % from"};
  plot::ChartColumn high{"to"};
  const TourMetrics& before = result.first_sight_before;
  const TourMetrics& after = result.first_sight_after;
  for (const SeedMean& mean : {before.stretch_error, after.stretch_error, before.orientation_error,
                               after.orientation_error}) {
    value.numbers.push_back(100.0 * mean.mean);
    low.numbers.push_back(100.0 * (mean.mean - plot::kNormal95 * mean.standard_error));
    high.numbers.push_back(100.0 * (mean.mean + plot::kNormal95 * mean.standard_error));
  }
  chart.layers.push_back(
      {plot::LayerKind::intervals, "", {{"", {}, chart.y.categories}, value, low, high}, "1"});
  return chart;
}

}  // namespace

Page tour_page(const TourResult& result, int seeds, const std::string& subject) {
  const MethodMetrics& last = result.tours.back();
  const TourMetrics& elastic = last.at("elastic");
  const TourMetrics& raw = last.at("raw");
  const TourMetrics& best = last.at("adjustment");
  PageContent page;
  page.command = "tour";
  page.subject = subject;
  page.verdict = fmt::format(
      "After {} {} routes of the elastic map are {:.2f} % too long or short and {:.2f}\u00b0 "
      "askew, {:.1f} times better than single measurements ({:.2f} %).",
      result.tours.size(), result.tours.size() == 1 ? "tour" : "tours",
      100.0 * elastic.stretch_error.mean, geometry::kDegrees * elastic.orientation_error.mean,
      raw.stretch_error.mean / std::max(elastic.stretch_error.mean, 1e-12),
      100.0 * raw.stretch_error.mean);
  page.facts = {
      {fmt::format("{:.2f} %", 100.0 * raw.stretch_error.mean),
       "stretch error, single measurements"},
      {fmt::format("{:.2f} %", 100.0 * elastic.stretch_error.mean), "stretch error, elastic"},
      {fmt::format("{:.2f} %", 100.0 * best.stretch_error.mean),
       "stretch error, adjustment: the best possible"},
      {std::to_string(seeds), "seeds averaged over"}};
  if (elastic.position_error) {
    page.facts.push_back(
        {fmt::format("{:.2f} m", elastic.position_error->mean), "position error, elastic"});
  }
  const Quantity quantities[] = {
      {"stretch", "Routes too long or too short", "mean stretch error [%]", 100.0, stretch},
      {"orientation", "Routes askew", "mean orientation error [\u00b0]", geometry::kDegrees,
       orientation},
      {"position", "Landmarks off", "mean position error [m]", 1.0, position}};
  PageSection section{"Errors, tour by tour", {}};
  for (const Quantity& one : quantities) {
    section.blocks.emplace_back(ChartRow{error_chart(result, one)});
  }
  section.blocks.emplace_back(last_table(result));
  page.sections.push_back(std::move(section));
  page.sections.push_back(
      {"First sight",
       {std::string("The paper's Table I, one map: 4.9 % and 0.033 rad before, 4.6 % and 0.032 rad "
                    "after."),
        ChartRow{first_sight_chart(result)}}});
  return page;
}

std::string tour_picture(const TourMap& shown) {
  plot::MapPicture picture;
  picture.title = fmt::format(
      "{}, after {} {}: routes {:.1f} % too long or short, {:.2f}\u00b0 askew",
      capitalised(look_of(shown.method).words), shown.tour, shown.tour == 1 ? "tour" : "tours",
      100.0 * shown.errors.stretch, geometry::kDegrees * shown.errors.orientation);
  picture.map = shown.map;
  picture.truth = shown.truth;
  picture.true_routes = true;
  picture.crosses = shown.method == "first_sight";
  if (picture.crosses) picture.measured = shown.measured;
  if (shown.laid == Laid::aligned) picture.map_onto_truth = onto_truth(shown.map, shown.truth);
  picture.names = false;
  return plot::draw_map(picture);
}

}  // namespace trussmap
