// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "json_values.hpp"

#include "wording/effect_words.hpp"

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

ordered_json estimate_json(const EffectEstimate& estimate) {
  ordered_json one = effect_json(estimate.effect);
  one["coefficients"] = estimate.effect.coefficients;
  one["sd"] = numbers_or_null(estimate.sd);
  one["in_words"] = in_words(estimate.effect, estimate.sd);
  return one;
}

}  // namespace trussmap::app
