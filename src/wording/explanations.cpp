// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "wording/explanations.hpp"

#include "effects/catalogue_record.hpp"
#include "effects/channel_physics.hpp"
#include "trussmap/workbench.hpp"
#include "wording/channel_words.hpp"

#include <algorithm>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string with(std::string_view text, const std::string& covariate) {
  std::string result(text);
  constexpr std::string_view kOpen = "{}";
  for (std::size_t at = result.find(kOpen); at != std::string::npos; at = result.find(kOpen)) {
    result.replace(at, kOpen.size(), covariate);
  }
  return result;
}

/// What an effect goes with, in words: "speed and turn rate"; empty where it goes with nothing.
std::string goes_with(const Effect& effect) {
  std::vector<std::string> names;
  for (const Shape& shape : effect.shape) {
    for (const std::string& name : shape.variables()) {
      const std::string words = wording::variable_in_words(name);
      if (std::find(names.begin(), names.end(), words) == names.end()) names.push_back(words);
    }
  }
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    text += (k == 0 ? "" : k + 1 == names.size() ? " and " : ", ") + names[k];
  }
  return text;
}

const char* where_to_look(Channel channel) {
  switch (effects::acts_on(channel)) {
    case effects::ActsOn::readings:
      return "Look at the compass, at what is magnetic or switched near it, and at its time "
             "stamps.";
    case effects::ActsOn::views:
      return "Look at how the sensor is mounted, at its scale, and at its clock.";
    case effects::ActsOn::drives:
      break;
  }
  return channel == Channel::gyro || channel == Channel::gyro_scale
             ? "Look at the gyro: its zero at rest, its scale, its temperature."
             : "Look at wheels, tyres, gears and castors, and at the floor.";
}

Explanation of_own(const Effect& effect) {
  const std::string cause = goes_with(effect);
  const std::string place = std::string(facts_of(effect.channel).does_what);
  if (cause.empty()) {
    return {fmt::format("It changes the {} alike everywhere.", place),
            where_to_look(effect.channel),
            "The same tour in both directions, and at two clearly different speeds."};
  }
  return {fmt::format("It changes the {} with {}, by the formula above.", place, cause),
          where_to_look(effect.channel),
          fmt::format("Drive so that {} takes a few clearly different values, each several times, "
                      "with all else the same.",
                      cause)};
}

}  // namespace

Explanation explanation_of(const Effect& effect) {
  const effects::CatalogueRecord* record = effects::find_record(effect.name);
  if (record == nullptr) return of_own(effect);
  const effects::ExplanationText& known = record->explanation;
  const std::string covariate = goes_with(effect);
  const auto against = [&known](double value) { return value * known.sign < 0.0; };
  if (!effect.coefficients.empty() && std::ranges::all_of(effect.coefficients, against)) {
    return {with(known.otherwise, covariate), "", with(known.drive, covariate), true};
  }
  return {with(known.does, covariate), with(known.look, covariate), with(known.drive, covariate)};
}

}  // namespace trussmap

namespace trussmap::wording {

const CatalogueEntry* usual_entry(const Effect& effect) {
  return explanation_of(effect).unusual ? nullptr : find_entry(effect.name);
}

}  // namespace trussmap::wording
