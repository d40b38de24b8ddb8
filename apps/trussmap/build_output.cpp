// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_output.hpp"

#include "json_values.hpp"
#include "path_output.hpp"
#include "trussmap/wording.hpp"

#include <filesystem>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using Json = nlohmann::ordered_json;

Json survey_json(const MapOnSurvey& on_survey) {
  const SurveyComparison& map = on_survey.comparison;
  Json exchanged = Json::array();
  for (const auto& [a, b] : map.exchanged) exchanged.push_back({a, b});
  return {{"landmarks", map.landmarks},
          {"rms_m", map.rigid.rms},
          {"rms_dead_reckoning_m", number_or_null(on_survey.rms_dead_reckoning)},
          {"rms_similarity_m", map.similarity.rms},
          {"scale", map.similarity.scale},
          {"rms_with_contradicting_m", map.rms_all},
          {"contradicting", map.contradicting},
          {"exchanged", exchanged}};
}

Json freed_json(const std::vector<FreedError>& freed) {
  Json result = nlohmann::ordered_json::array();
  for (const FreedError& one : freed) {
    Json effect = effect_json(one.effect);
    effect["coefficients"] = one.effect.coefficients;
    effect["sd"] = one.sd;
    result.push_back(std::move(effect));
  }
  return result;
}

Json quality_json(const MapQuality& quality) {
  return {{"median_sd_m", quality.median_sd},
          {"worst_sd_m", quality.worst_sd},
          {"worst_landmark", quality.worst_landmark},
          {"oriented", quality.oriented},
          {"median_sd_heading_rad", number_or_null(quality.median_sd_heading)},
          {"dispersion", quality.dispersion},
          {"loops", quality.loops},
          {"misclosure_share", number_or_null(quality.misclosure_share)},
          {"sightings", quality.sightings},
          {"left_out_share", quality.left_out_share},
          {"from_adjusted_rms_m", quality.from_adjusted}};
}

}  // namespace

nlohmann::ordered_json positions_json(const LandmarkGraph& map) {
  Json positions = Json::object();
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& one = map.landmark(k);
    Json at = {{"x", one.position.x()}, {"y", one.position.y()}};
    if (one.covariance) {
      at["c_xx"] = (*one.covariance)(0, 0);
      at["c_xy"] = (*one.covariance)(0, 1);
      at["c_yy"] = (*one.covariance)(1, 1);
    }
    if (one.heading) at["heading"] = *one.heading;
    if (one.sd_heading) at["sd_heading"] = *one.sd_heading;
    positions[one.name] = std::move(at);
  }
  return positions;
}

/// Errors after each tour, after the best rotation and translation of the map as it then was.
Json tours_json(const std::vector<TourErrors>& tours) {
  Json list = Json::array();
  for (const TourErrors& one : tours) {
    Json tour = {{"tour", list.size() + 1},
                 {"stretch_error", one.errors.stretch},
                 {"orientation_error_rad", one.errors.orientation},
                 {"routes", one.errors.routes},
                 {"complete", one.complete}};
    if (one.errors.position) tour["position_error_m"] = *one.errors.position;
    list.push_back(std::move(tour));
  }
  return list;
}

nlohmann::ordered_json build_json(const BuiltMap& built, const std::string& method) {
  Json rejected = Json::array();
  for (const RejectedSighting& one : built.rejected) {
    rejected.push_back({{"recording", one.recording},
                        {"t", one.t},
                        {"landmark", one.landmark},
                        {"misfit_m", one.misfit}});
  }
  Json result = {{"method", method},
                 {"verdict", verdict_of(built)},
                 {"legs", built.legs},
                 {"landmarks", built.map.landmarks()},
                 {"routes", built.map.routes()},
                 {"first_sight", built.first_sight},
                 {"refinements", built.refinements},
                 {"side_sightings", built.side_sightings},
                 {"rejected", rejected},
                 {"unconfirmed", built.unconfirmed},
                 {"freed", freed_json(built.freed)},
                 {"quality", quality_json(built.quality)},
                 {"positions", positions_json(built.map)},
                 {"warnings", built.warnings},
                 {"notes", built.notes},
                 {"chi2", built.fit.chi2},
                 {"dof", built.fit.dof},
                 {"p_value", built.fit.p_value},
                 {"iterations", built.fit.iterations},
                 {"converged", built.fit.converged}};
  if (built.method != Method::adjustment) result["relaxed"] = built.relaxed;
  if (!built.tours.empty()) result["tours"] = tours_json(built.tours);
  if (built.on_survey) result["survey"] = survey_json(*built.on_survey);
  if (!built.paths.empty()) result["paths"] = paths_json(built.paths);
  return result;
}

void print_written(const Files& files) {
  const std::vector<std::filesystem::path> paths = files.paths();
  if (paths.empty()) return;
  fmt::print("\n  written: ");
  for (std::size_t k = 0; k < paths.size(); ++k) {
    fmt::print("{}{}", k == 0 ? "" : ", ", paths[k].string());
  }
  fmt::print("\n");
}

}  // namespace trussmap::app
