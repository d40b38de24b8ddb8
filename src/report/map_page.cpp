// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "geometry/units.hpp"
#include "plot/layers.hpp"
#include "plot/map_picture.hpp"
#include "report/map_tours.hpp"
#include "report/page.hpp"
#include "report/page_words.hpp"
#include "report/path_page.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

constexpr std::size_t kMostBars = 2000;
constexpr std::size_t kMostNames = 60;
constexpr std::size_t kMostRows = 60;
constexpr double kLoud = 4.0;  // standard deviations at which a bar has the strongest colour

/// A map as it is drawn.
struct Drawn {
  const BuiltMap& built;
  plot::MapPicture picture;

  [[nodiscard]] bool surveyed() const { return built.on_survey.has_value(); }
};

/// What is wrong between a route's ends in the map and its measurements: along it, and in all.
struct Strain {
  double along = 0.0;  // m, + is longer in the map than measured
  double sds = 0.0;    // along, in standard deviations of the mean
};

Strain strain_of(const LandmarkGraph& map, const Route& route) {
  const Vector2 span = map.landmark(route.target).position - map.landmark(route.source).position;
  const Vector2 along = span.normalized();
  Strain strain;
  strain.along = (span - route.displacement).dot(along);
  const double variance = along.dot(route.covariance * along) / std::max(1, route.traversals);
  if (variance > 0.0) strain.sds = strain.along / std::sqrt(variance);
  return strain;
}

plot::ChartLayer before_layer(const Drawn& drawn) {
  const plot::MapPicture& picture = drawn.picture;
  plot::ChartLayer layer{plot::LayerKind::net, "dead reckoning", {{"x [m]"}, {"y [m]"}}, "faint"};
  for (int k = 0; k < picture.map.routes(); ++k) {
    const Route& route = picture.map.route(k);
    const auto from = picture.before.find(picture.map.landmark(route.source).name);
    const auto to = picture.before.find(picture.map.landmark(route.target).name);
    if (from == picture.before.end() || to == picture.before.end()) continue;
    for (const Vector2& p : {picture.map_onto_truth.apply(from->second),
                             picture.map_onto_truth.apply(to->second), Vector2(kAbsent, kAbsent)}) {
      layer.columns[0].numbers.push_back(p.x());
      layer.columns[1].numbers.push_back(p.y());
    }
  }
  return layer;
}

plot::ChartLayer bar_layer(const Drawn& drawn) {
  plot::ChartLayer layer{plot::LayerKind::segments,
                         "",
                         {{""},
                          {""},
                          {""},
                          {""},
                          {"from"},
                          {"to"},
                          {"driven"},
                          {"length in the map [m]"},
                          {"stretched by [mm]"},
                          {"in standard deviations"}}};
  layer.key = {"shorter than measured", "as measured", "longer than measured"};
  const plot::MapPicture& picture = drawn.picture;
  const auto count = static_cast<std::size_t>(picture.map.routes());
  for (const std::size_t k : plot::thinned(count, kMostBars)) {
    const Route& route = picture.map.route(static_cast<int>(k));
    const Landmark& source = picture.map.landmark(route.source);
    const Landmark& target = picture.map.landmark(route.target);
    const Vector2 a = picture.map_onto_truth.apply(source.position);
    const Vector2 b = picture.map_onto_truth.apply(target.position);
    const Strain strain = strain_of(picture.map, route);
    const double numbers[] = {a.x(), a.y(), b.x(), b.y()};
    for (std::size_t i = 0; i < 4; ++i) layer.columns[i].numbers.push_back(numbers[i]);
    layer.columns[4].texts.push_back(source.name);
    layer.columns[5].texts.push_back(target.name);
    layer.columns[6].numbers.push_back(route.traversals);
    layer.columns[7].numbers.push_back((target.position - source.position).norm());
    layer.columns[8].numbers.push_back(1000.0 * strain.along);
    layer.columns[9].numbers.push_back(strain.sds);
    layer.shade.push_back(strain.sds / kLoud);
  }
  return layer;
}

/// Ticks from landmarks along their own axes, as long as a share of the map.
plot::ChartLayer axis_layer(const Drawn& drawn) {
  constexpr double kShare = 0.025;
  const plot::MapPicture& picture = drawn.picture;
  plot::ChartLayer layer{plot::LayerKind::net, "axis of the landmark", {{"x [m]"}, {"y [m]"}}, "2"};
  Vector2 low = Vector2::Constant(std::numeric_limits<double>::infinity());
  Vector2 high = -low;
  for (int k = 0; k < picture.map.landmarks(); ++k) {
    const Vector2 at = picture.map_onto_truth.apply(picture.map.landmark(k).position);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  const double length = kShare * (high - low).maxCoeff();
  for (int k = 0; k < picture.map.landmarks(); ++k) {
    const Landmark& one = picture.map.landmark(k);
    if (!one.heading) continue;
    const Vector2 at = picture.map_onto_truth.apply(one.position);
    const Vector2 axis = rotation(*one.heading + picture.map_onto_truth.angle).col(0);
    for (const Vector2& p : {at, Vector2(at + length * axis), Vector2(kAbsent, kAbsent)}) {
      layer.columns[0].numbers.push_back(p.x());
      layer.columns[1].numbers.push_back(p.y());
    }
  }
  return layer;
}

void add_landmarks(plot::Chart& chart, const Drawn& drawn) {
  const plot::MapPicture& picture = drawn.picture;
  plot::ChartLayer dots{plot::LayerKind::dots,
                        "landmark",
                        {{"x [m]"}, {"y [m]"}, {"landmark"}, {"off the survey by [m]"}},
                        "ink"};
  plot::ChartLayer truth{
      plot::LayerKind::dots, "as surveyed", {{"x [m]"}, {"y [m]"}, {"surveyed landmark"}}, "3"};
  plot::ChartLayer names{
      plot::LayerKind::labels, "", {{"x [m]"}, {"y [m]"}, {"landmark"}}, "muted"};
  std::vector<plot::PlacedEllipse> ellipses;
  const bool few = static_cast<std::size_t>(picture.map.landmarks()) <= kMostNames;
  const Matrix2 turn = rotation(picture.map_onto_truth.angle);
  for (int k = 0; k < picture.map.landmarks(); ++k) {
    const Landmark& one = picture.map.landmark(k);
    const Vector2 at = picture.map_onto_truth.apply(one.position);
    const auto known = picture.truth.find(one.name);
    double off = kAbsent;
    if (known != picture.truth.end()) {
      off = (at - known->second).norm();
      truth.columns[0].numbers.push_back(known->second.x());
      truth.columns[1].numbers.push_back(known->second.y());
      truth.columns[2].texts.push_back(one.name);
    }
    dots.columns[0].numbers.push_back(at.x());
    dots.columns[1].numbers.push_back(at.y());
    dots.columns[2].texts.push_back(one.name);
    dots.columns[3].numbers.push_back(off);
    if (one.covariance) {
      ellipses.push_back({one.name, at, turn * *one.covariance * turn.transpose()});
    }
  }
  if (few) {
    names.columns = {dots.columns[0], dots.columns[1], dots.columns[2]};
  }
  dots.size = few ? 3.5 : 2.0;
  truth.size = few ? 5.5 : 3.0;
  if (!truth.columns[2].texts.empty()) chart.layers.push_back(std::move(truth));
  plot::ChartLayer ellipse = plot::ellipse_layer("95 % ellipse", ellipses, "1");
  if (!ellipse.columns[0].numbers.empty()) chart.layers.push_back(std::move(ellipse));
  plot::ChartLayer axes = axis_layer(drawn);
  if (!axes.columns[0].numbers.empty()) chart.layers.push_back(std::move(axes));
  chart.layers.push_back(std::move(dots));
  if (few) chart.layers.push_back(std::move(names));
}

plot::Chart map_chart(const Drawn& drawn) {
  plot::Chart chart;
  chart.id = "map";
  chart.title = "The map, before and after";
  chart.caption =
      "Faint: the routes between landmarks as dead reckoning has them. Coloured: the map. A bar "
      "that is longer or shorter than its measurements gives way to the other routes; one of four "
      "standard deviations has the strongest colour." +
      std::string(drawn.surveyed() ? " Green: where the survey has the landmarks; the map is laid "
                                     "over it by rotation and translation."
                                   : "");
  chart.x.title = "x [m]";
  chart.y.title = "y [m]";
  chart.equal_aspect = true;
  chart.height = 520.0;
  plot::ChartLayer before = before_layer(drawn);
  if (!before.columns[0].numbers.empty()) chart.layers.push_back(std::move(before));
  plot::ChartLayer bars = bar_layer(drawn);
  if (!bars.shade.empty()) chart.layers.push_back(std::move(bars));
  add_landmarks(chart, drawn);
  return chart;
}

/// Distances from the survey: of the map, and of dead reckoning laid over it on its own.
struct SurveyErrors {
  std::vector<std::string> names;
  std::vector<double> map;     // m
  std::vector<double> before;  // m
};

SurveyErrors survey_errors(const Drawn& drawn) {
  const plot::MapPicture& picture = drawn.picture;
  SurveyErrors errors;
  if (!drawn.surveyed()) return errors;
  const std::vector<std::string>& odd = drawn.built.on_survey->comparison.contradicting;
  std::vector<Vector2> reckoned;
  std::vector<Vector2> truth;
  for (const auto& [name, at] : picture.truth) {
    const std::optional<int> landmark = picture.map.find(name);
    const auto before = picture.before.find(name);
    if (!landmark || before == picture.before.end()) continue;
    if (std::find(odd.begin(), odd.end(), name) != odd.end()) continue;
    errors.names.push_back(name);
    errors.map.push_back(
        (picture.map_onto_truth.apply(picture.map.landmark(*landmark).position) - at).norm());
    reckoned.push_back(before->second);
    truth.push_back(at);
  }
  if (reckoned.size() < 2) return errors;
  const Alignment over = align_rigidly(reckoned, truth);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    errors.before.push_back((over.apply(reckoned[k]) - truth[k]).norm());
  }
  return errors;
}

plot::Chart survey_chart(const SurveyErrors& errors) {
  plot::Chart chart;
  chart.id = "survey";
  chart.title = "How far landmarks are from where the survey has them";
  chart.caption =
      "Share of the landmarks within a distance, after the best rotation and translation. Further "
      "to the left is better.";
  chart.x = {.title = "distance [m]", .zero = true};
  chart.y = {.title = "landmarks within it [%]", .range = plot::Range{0.0, 100.0}};
  chart.height = 420.0;
  plot::add_shares(chart, "dead reckoning", errors.before, "m", "2");
  plot::add_shares(chart, "the map", errors.map, "m", "1");
  return chart;
}

PageTable survey_table(const SurveyErrors& errors) {
  PageTable table;
  table.caption = "Landmarks furthest from the survey";
  table.headings = {"landmark", "map off by [m]", "dead reckoning off by [m]"};
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < errors.names.size(); ++k) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&errors](std::size_t a, std::size_t b) {
    return errors.map[a] > errors.map[b];
  });
  for (const std::size_t k : order) {
    if (table.rows.size() == kMostRows) break;
    table.rows.push_back({errors.names[k], fmt::format("{:.3f}", errors.map[k]),
                          errors.before.empty() ? "-" : fmt::format("{:.3f}", errors.before[k])});
  }
  return table;
}

}  // namespace

Page map_page(const BuiltMap& built, const std::string& subject) {
  if (!built.paths.empty()) return path_page(built, subject);
  const Drawn drawn{built, plot::picture_of(built, "")};
  PageContent page;
  page.command = "build";
  page.subject = subject;
  page.verdict = capitalised(verdict_in_words(built)) + ".";
  page.tone = built.good() ? Tone::good : Tone::bad;
  page.facts.push_back({fmt::format("{:.3f} m", built.quality.median_sd),
                        "standard error of landmarks (median)", page.tone});
  if (built.quality.oriented > 0) {
    page.facts.push_back(
        {fmt::format("{:.2f}\u00b0", built.quality.median_sd_heading * geometry::kDegrees),
         fmt::format("standard error of the axes of {} landmarks (median)",
                     built.quality.oriented)});
  }
  if (built.on_survey) {
    const SurveyComparison& survey = built.on_survey->comparison;
    page.facts.push_back({fmt::format("{:.3f} m", survey.rigid.rms), "map off the survey (rms)"});
    if (!std::isnan(built.on_survey->rms_dead_reckoning)) {
      page.facts.push_back({fmt::format("{:.3f} m", built.on_survey->rms_dead_reckoning),
                            "dead reckoning off the survey (rms)"});
    }
    if (survey.has_scale()) {
      page.facts.push_back(
          {fmt::format("{:.3f} m", survey.similarity.rms),
           "with a scale as well: " + map_scale_in_words(survey.similarity.scale)});
    }
  }
  page.facts.push_back(
      {fmt::format("{:.2f}", built.quality.dispersion), "dispersion (1: as the model says)"});
  if (built.quality.loops > 0) {
    page.facts.push_back({fmt::format("{:.2f} %", 100.0 * built.quality.misclosure_share),
                          "of the way: what loops of dead reckoning miss their start by"});
  }
  page.facts.push_back({std::to_string(built.legs), "legs"});
  page.facts.push_back({std::to_string(built.first_sight), "loops closed at first sight"});
  page.facts.push_back({std::to_string(built.refinements), "known routes driven again"});
  page.facts.push_back({std::to_string(built.rejected.size()), "sightings left out"});
  if (!built.good()) page.notes.assign(built.warnings.begin() + 1, built.warnings.end());
  std::transform(page.notes.begin(), page.notes.end(), page.notes.begin(), typeset);
  page.notes.insert(page.notes.end(), built.notes.begin(), built.notes.end());
  if (built.on_survey) {
    for (const std::string& name : built.on_survey->comparison.contradicting) {
      page.notes.push_back("Landmark " + name + " contradicts the survey and does not count.");
    }
  }
  ChartRow charts{map_chart(drawn)};
  const SurveyErrors errors = survey_errors(drawn);
  if (drawn.surveyed()) charts.push_back(survey_chart(errors));
  page.sections.push_back({"The map", {std::move(charts)}});
  if (!built.tours.empty()) page.sections.push_back(tours_section(built));
  if (drawn.surveyed()) page.sections.push_back({"Against the survey", {survey_table(errors)}});
  return page;
}

}  // namespace trussmap
