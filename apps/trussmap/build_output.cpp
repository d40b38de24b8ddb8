// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "build_output.hpp"

#include "json_values.hpp"
#include "path_output.hpp"
#include "terminal.hpp"
#include "trussmap/table.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using json = nlohmann::ordered_json;

constexpr std::size_t kRejectedShown = 10;

json survey_json(const MapOnSurvey& on_survey) {
  const SurveyComparison& map = on_survey.comparison;
  json exchanged = json::array();
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

json freed_json(const std::vector<FreedError>& freed) {
  json result = nlohmann::ordered_json::array();
  for (const FreedError& one : freed) {
    json effect = effect_json(one.effect);
    effect["coefficients"] = one.effect.coefficients;
    effect["sd"] = one.sd;
    result.push_back(std::move(effect));
  }
  return result;
}

json quality_json(const MapQuality& quality) {
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

void print_survey(const MapOnSurvey& on_survey) {
  const SurveyComparison& map = on_survey.comparison;
  fmt::print("\n  against the survey of {} landmarks, after rotation and translation:\n",
             map.landmarks);
  fmt::print("  {:<28} {:>8.3f} m\n", "rms error of the map", map.rigid.rms);
  if (!std::isnan(on_survey.rms_dead_reckoning)) {
    fmt::print("  {:<28} {:>8.3f} m\n", "rms of dead reckoning", on_survey.rms_dead_reckoning);
  }
  fmt::print("  {:<28} {:>8.3f} m  ({})\n", "rms with a scale as well", map.similarity.rms,
             map_scale_in_words(map.similarity.scale));
  if (map.contradicting.empty()) return;
  fmt::print(
      "\n  These landmarks contradict the survey and do not count above (with them the rms "
      "is {:.3f} m):\n",
      map.rms_all);
  for (const std::string& name : map.contradicting)
    fmt::print("    landmark {}\n", shortened_words(name));
  for (const auto& [a, b] : map.exchanged) {
    fmt::print(
        "    landmarks {} and {} each lie where the survey has the other: are their labels "
        "exchanged?\n",
        shortened_words(a), shortened_words(b));
  }
}

void print_left_out(const BuiltMap& built, bool several) {
  fmt::print("  {:<28} {:>8}  of {}\n", "sightings left out", built.rejected.size(),
             built.quality.sightings);
  for (std::size_t k = 0; k < std::min(built.rejected.size(), kRejectedShown); ++k) {
    const RejectedSighting& one = built.rejected[k];
    const std::string where = several ? one.recording + ", " : "";
    fmt::print("    {}t = {:.3f} s: landmark {} seen {:.2f} m from where the map has it\n", where,
               one.t, shortened_words(one.landmark), one.misfit);
  }
  if (built.rejected.size() > kRejectedShown) {
    fmt::print("    and {} more (--json lists all)\n", built.rejected.size() - kRejectedShown);
  }
}

void print_quality(const BuiltMap& built) {
  const MapQuality& quality = built.quality;
  fmt::print("  {:<28} {:>8.3f} m  (median; worst {:.3f} m, landmark {})\n",
             "standard error of landmarks", quality.median_sd, quality.worst_sd,
             shortened_words(quality.worst_landmark));
  if (quality.oriented > 0) {
    fmt::print("  {:<28} {:>8}  of {}, their axes good to {:.2f} deg (median)\n",
               "landmarks with orientation", quality.oriented, built.map.landmarks(),
               quality.median_sd_heading * 180.0 / std::numbers::pi);
  }
  if (built.method != Method::adjustment) {
    fmt::print("  {:<28} {:>8.3f} m  (rms; the standard errors above are that map's)\n",
               "off the adjusted map by", quality.from_adjusted);
  }
  fmt::print("  {:<28} {:>8.2f}  (chi^2/dof of {} degrees of freedom{}; 1: as the model says)\n",
             "dispersion of the errors", quality.dispersion, built.fit.dof,
             built.on_survey ? " without the survey" : "");
  if (quality.loops > 0) {
    fmt::print("  {:<28} {:>7.2f} %  of the way, by dead reckoning (median of {})\n",
               "loops miss their start by", 100.0 * quality.misclosure_share, quality.loops);
  }
}

void print_map(const BuiltMap& built, bool several) {
  print_quality(built);
  const auto line = [](const char* what, int number) {
    fmt::print("  {:<28} {:>8}\n", what, number);
  };
  line("legs", built.legs);
  line("loops closed at first sight", built.first_sight);
  line("known routes driven again", built.refinements);
  line("sightings beside a leg's end", built.side_sightings);
  print_left_out(built, several);
  if (built.on_survey) print_survey(*built.on_survey);
}

}  // namespace

nlohmann::ordered_json positions_json(const LandmarkGraph& map) {
  json positions = json::object();
  for (int k = 0; k < map.landmarks(); ++k) {
    const Landmark& one = map.landmark(k);
    json at = {{"x", one.position.x()}, {"y", one.position.y()}};
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

nlohmann::ordered_json build_json(const BuiltMap& built, const std::string& method) {
  json rejected = json::array();
  for (const RejectedSighting& one : built.rejected) {
    rejected.push_back({{"recording", one.recording},
                        {"t", one.t},
                        {"landmark", one.landmark},
                        {"misfit_m", one.misfit}});
  }
  json result = {{"method", method},
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
  if (built.on_survey) result["survey"] = survey_json(*built.on_survey);
  if (!built.paths.empty()) result["paths"] = paths_json(built.paths);
  return result;
}

void print_built(const BuiltMap& built, const std::string& method, bool several) {
  const bool paths = !built.paths.empty();
  if (paths) {
    print_paths_built(built.paths);
  } else {
    fmt::print("map of {} landmarks and {} routes, method {}\n", built.map.landmarks(),
               built.map.routes(), method);
  }
  fmt::print("{}\n\n",
             verdict_text(built.good() ? Mood::good : Mood::doubt, verdict_in_words(built)));
  if (paths) {
    print_paths(built);
  } else {
    print_map(built, several);
  }
  for (std::size_t k = 1; k < built.warnings.size(); ++k) {  // the verdict has the first
    fmt::print("\n{}", warning_text(built.warnings[k]));
  }
  for (const std::string& note : built.notes) fmt::print("\nnote: {}\n", shortened_words(note));
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
