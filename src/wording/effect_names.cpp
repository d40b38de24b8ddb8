// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/catalogue_record.hpp"
#include "effects/channel_record.hpp"
#include "effects/place.hpp"
#include "trussmap/wording.hpp"
#include "wording/channel_words.hpp"

#include <optional>
#include <string_view>

#include <fmt/format.h>

namespace trussmap {
using namespace wording;

namespace {

/// The speed above which an effect acts, m/s.
std::optional<double> threshold_of(const Effect& effect) {
  return effect.shape.size() == 1 ? effect.shape.front().parameter("speed") : std::nullopt;
}

}  // namespace

std::string formula_of(const Effect& effect) {
  return fmt::format("{} x {}", name_of(effect.channel), fmt::join(texts_of(effect.shape), ", "));
}

std::string short_name(const Effect& effect) {
  const effects::CatalogueRecord* record = effects::find_record(effect.name);
  return record == nullptr ? name_in_words(effect) : std::string(record->known_as);
}

std::string name_in_words(const Effect& effect) {
  const std::string& name = effect.name;
  if (const effects::CatalogueRecord* record = effects::find_record(name)) {
    const CatalogueEntry& entry = record->entry;
    const std::size_t open = name.rfind(" (");
    const std::string rest =
        open == std::string::npos ? "" : name.substr(open + 2, name.size() - open - 3);
    if (entry.of_covariate() && !rest.empty()) {
      return fmt::format("{} with {}", entry.name, variables_in_words(rest));
    }
    if (const std::optional<double> v0 = threshold_of(effect); v0 && entry.has_parameters()) {
      return fmt::format("{} above {} m/s", record->known_as, two_digits(*v0));
    }
    const std::optional<Vector2> place = effects::place_of(effect);
    const std::optional<double> r = place ? effect.shape.front().parameter("r") : std::nullopt;
    if (r && entry.has_parameters()) {
      return fmt::format("{} at {}, radius {} m", entry.name, place_text(*place), two_digits(*r));
    }
    return name;
  }
  const std::string_view channel = name_of(effect.channel);
  if (!name.starts_with(std::string(channel) + " ")) return name;
  const std::string rest = name.substr(channel.size());
  const std::optional<Vector2> place = effects::place_of(effect);
  if ((rest == " at a place" || rest == " within a circle") && place) {
    return fmt::format("{} at {}", effects::record_of(effect.channel).noun, place_text(*place));
  }
  if (!rest.starts_with(" with ") && !rest.starts_with(" of its own")) return name;
  return std::string(effects::record_of(effect.channel).noun) + variables_in_words(rest);
}

}  // namespace trussmap
