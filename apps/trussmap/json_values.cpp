// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "json_values.hpp"

#include "trussmap/wording.hpp"

#include <cmath>

namespace trussmap::app {

using nlohmann::ordered_json;

ordered_json number_or_null(double value) {
  return std::isfinite(value) ? ordered_json(value) : ordered_json();
}

ordered_json numbers_or_null(const std::vector<double>& values) {
  ordered_json list = ordered_json::array();
  for (const double value : values) list.push_back(number_or_null(value));
  return list;
}

ordered_json effect_json(const Effect& effect) {
  return {{"effect", effect.name},
          {"channel", name_of(effect.channel)},
          {"shape", texts_of(effect.shape)}};
}

ordered_json constant_json(const Effect& effect, double sd) {
  ordered_json one = effect_json(effect);
  one["coefficients"] = effect.coefficients;
  one["sd"] = std::vector<double>{sd};
  return one;
}

ordered_json look_alikes_json(const std::vector<LookAlike>& look_alikes) {
  ordered_json list = ordered_json::array();
  for (const LookAlike& one : look_alikes) {
    list.push_back(effect_json(one.effect));
    list.back()["cosine"] = one.cosine;
    list.back()["chi2_behind"] = one.behind;
  }
  return list;
}

ordered_json sightings_json(const UsedSightings& sightings) {
  return {{"used", sightings.used}, {"all", sightings.all}, {"every_s", sightings.every}};
}

ordered_json metrics_json(const HeldOutMetrics& metrics) {
  return {{"arrival_rms_m", metrics.arrival_rms},
          {"stretch_error", metrics.stretch_error},
          {"orientation_error_rad", metrics.orientation_error}};
}

ordered_json held_out_json(const HeldOut& held_out) {
  ordered_json one = {{"legs", held_out.legs.size()}};
  one.update(metrics_json(held_out));
  return one;
}

ordered_json estimate_json(const EffectEstimate& estimate) {
  ordered_json one = effect_json(estimate.effect);
  one["coefficients"] = estimate.effect.coefficients;
  one["sd"] = numbers_or_null(estimate.sd);
  one["in_words"] = in_words(estimate.effect, estimate.sd);
  return one;
}

void add_constants(const RobotConstants& constants, ordered_json& report) {
  report["constants"] = ordered_json::array();
  for (const RobotConstant& one : constants.list) {
    report["constants"].push_back(
        {{"name", one.name},
         {"old", one.before},
         {"new", one.determined ? ordered_json(one.after) : ordered_json()},
         {"sd", one.determined && one.sd > 0.0 ? ordered_json(one.sd) : ordered_json()},
         {"unit", one.unit},
         {"note", one.note}});
  }
  report["stacks"] = ordered_json::array();
  for (const StackValue& one : constants.stacks) {
    report["stacks"].push_back({{"stack", one.stack},
                                {"key", one.key},
                                {"value", one.value},
                                {"multiplies", one.multiplies},
                                {"note", one.note}});
  }
}

}  // namespace trussmap::app
