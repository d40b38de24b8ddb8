// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Pages of recordings of any size, made up: for their size and speed.
#pragma once

#include "report/page.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/pages.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace trussmap::testing {

/// So many legs, a fifth as many routes, a tenth as many landmarks.
inline ModelEvidence large_model(int legs) {
  const int across = static_cast<int>(std::ceil(std::sqrt(legs / 10.0)));
  Comparison result;
  result.objection = Objection::chi2;
  result.chi2 = 9.0 * legs;
  result.dof = legs;
  result.legs = static_cast<std::size_t>(legs);
  FittedMap map;
  const auto name = [](int k) { return "landmark " + std::to_string(k); };
  for (int k = 0; k < across * across; ++k) {
    FittedLandmark one;
    one.name = name(k);
    one.position = {5.0 * (k % across) + 0.1 * std::sin(k), 5.0 * (k / across) + 0.1 * std::cos(k)};
    one.covariance = 0.01 * Matrix2::Identity();
    map.landmarks.push_back(one);
    for (const int step : {1, across}) {
      if (k + step >= across * across || (step == 1 && k % across == across - 1)) continue;
      result.routes.push_back({name(k), name(k + step), 5, 20.0, 30.0 * std::sin(1.7 * k),
                               0.01 * std::sin(k), 0.02 * std::cos(k)});
    }
  }
  map.paths.push_back({});
  for (int k = 0; k < 2000; ++k) {
    map.paths.front().emplace_back(0.02 * k, 50.0 + 40.0 * std::sin(0.02 * k));
  }
  for (int k = 0; k < legs; ++k) {
    result.worst.push_back({static_cast<std::size_t>(k), name(k % 97), name(k % 89), 10.0 * k,
                            100.0 * (legs - k) / legs, 4, 0.02 * std::sin(k), 0.03 * std::cos(k)});
    LegPrediction leg;
    leg.arrival_error = {0.02 * std::sin(k), 0.02 * std::cos(0.7 * k)};
    if (k % 3 == 0) result.held_out.legs.push_back(leg);
  }
  result.held_out.arrival_rms = 0.02;
  result.sources = {{"wheels", 3.0, 0.1, 100.0}, {"compass", 1.0, 0.1, 100.0}};
  result.residuals = {{"wheels", {}}, {"compass", {}}};
  for (int k = 0; k < 4 * legs; ++k) {
    result.residuals[k % 4 == 3 ? 1 : 0].standardised.push_back(8.0 * k / (4.0 * legs) - 4.0);
  }
  return {result, map};
}

inline std::vector<TrendEvidence> large_trends() {
  std::vector<TrendEvidence> trends;
  for (const char* variable : {"heading", "speed", "turn_rate", "t", "distance", "payload_kg"}) {
    TrendEvidence picture;
    picture.trend.kind = "stretch";
    picture.trend.against = variable;
    picture.response.channel = Channel::travel;
    picture.response.variable = variable;
    for (int bin = 0; bin < 9; ++bin) {
      picture.response.bins.push_back({0.1 * bin, 0.1 * bin, 0.1 * bin + 0.1, 0.01 * bin, 0.003});
      picture.response.curve.emplace_back(0.1 * bin, 0.01 * bin);
    }
    trends.push_back(picture);
  }
  return trends;
}

inline Page large_comparison_page(int legs) {
  ModelEvidence model = large_model(legs);
  for (const TrendEvidence& one : large_trends()) model.comparison.trends.push_back(one.trend);
  return comparison_page({model, large_trends()}, "a large recording");
}

inline EffectEvidence large_effect() {
  EffectEvidence one;
  one.estimate = {{"hard iron", Channel::compass, {"sin(heading)", "cos(heading)"}, {0.04, -0.03}},
                  {0.001, 0.001},
                  {}};
  one.response = large_trends().front().response;
  one.range = {-0.05, 0.05};
  return one;
}

/// Two effects missing, one of them with a rival.
inline Diagnosis large_diagnosis(int legs) {
  Diagnosis diagnosis;
  diagnosis.verdict = Diagnosis::Verdict::missing;
  diagnosis.missing = "hard iron";
  diagnosis.p_value = 1e-30;
  diagnosis.tried = 900;
  diagnosis.held_out = large_model(legs).comparison.held_out;
  Finding finding;
  finding.effect = large_effect().estimate.effect;
  finding.status = Status::missing;
  finding.look_alikes = {
      {{"body tilt", Channel::compass, {"sin(heading)", "cos(heading)"}, {}}, 0.99}};
  diagnosis.findings = {finding, finding};
  return diagnosis;
}

inline Page large_diagnosis_page(int legs) {
  const DiagnosisEvidence evidence{large_model(legs),
                                   large_model(legs),
                                   {large_effect(), large_effect()},
                                   large_trends(),
                                   std::vector<FindingSize>(2)};
  return diagnosis_page(large_diagnosis(legs), evidence, "a large recording");
}

/// Five models, one after the other.
inline Page large_discovery_page(int legs) {
  Discovery discovery;
  for (int k = 0; k < 5; ++k) {
    DiscoveryStep step;
    if (k > 0) step.added = large_effect().estimate.effect;
    step.chi2 = 1e5 / (k + 1);
    step.dof = legs;
    step.held_out = large_model(legs).comparison.held_out;
    discovery.steps.push_back(step);
  }
  discovery.last = large_diagnosis(legs);
  discovery.found.effects = {large_effect().estimate};
  DiscoveryEvidence evidence;
  evidence.given = evidence.found = large_model(legs);
  evidence.between.assign(3, large_model(legs));
  evidence.effects = {large_effect()};
  evidence.look_alikes.resize(1);
  evidence.next_drives.resize(1);
  evidence.trends = large_trends();
  evidence.sizes.resize(2);
  return discovery_page(discovery, evidence, "a large recording");
}

inline Page large_map_page(int legs) {
  BuiltMap built;
  const ModelEvidence model = large_model(legs);
  built.on_survey.emplace();
  for (const FittedLandmark& one : model.map.landmarks) {
    built.map.add_landmark(one.name, one.position);
    built.dead_reckoned[one.name] = one.position + Vector2(1.0, 0.1 * one.position.x());
    built.on_survey->points.push_back({one.name, one.position.x(), one.position.y(), kAbsent});
  }
  for (const RouteMisfit& one : model.comparison.routes) {
    built.map.add_route(*built.map.find(one.from), *built.map.find(one.to));
  }
  built.legs = legs;
  built.on_survey->comparison =
      compare_with_survey(positions_of(built.map), built.on_survey->points);
  return map_page(built, "a large recording");
}

}  // namespace trussmap::testing
