// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What effects writes: the catalogue.
#pragma once

#include "results/common.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/workbench.hpp"

#include <string>
#include <vector>

namespace trussmap::results {

template <>
inline constexpr auto kDescribed<OpenParameter> = described(
    field("name", &OpenParameter::name, "in the shape"), field("unit", &OpenParameter::unit, "its"),
    field("usual", &OpenParameter::usual, "value"));

/// Of an entry, to be explained; what is of a column is of COLUMN.
[[nodiscard]] inline Effect effect_of(const CatalogueEntry& entry) {
  Effect effect;
  effect.name = entry.name;
  effect.channel = entry.channel;
  if (entry.of_covariate()) effect.shape = catalogue_effect(entry, "COLUMN").shape;
  return effect;
}
template <auto kMember>
inline constexpr auto kChannelFact =
    [](const CatalogueEntry& entry) { return facts_of(entry.channel).*kMember; };
template <auto kMember>
inline constexpr auto kExplained =
    [](const CatalogueEntry& entry) { return explanation_of(effect_of(entry)).*kMember; };

template <>
inline constexpr auto kDescribed<CatalogueEntry> = described(
    field("name", &CatalogueEntry::name, "in the catalogue"),
    field("channel", kChannelFact<&ChannelFacts::name>, kWhatChannel),
    field("acts_on", kChannelFact<&ChannelFacts::does_what>, "the channel in words"),
    field("channel_unit", kChannelFact<&ChannelFacts::unit>, "of what the channel changes"),
    field("shape", &CatalogueEntry::pattern, "patterns: {} a column's name, {r} a parameter"),
    field("unit", &CatalogueEntry::unit, "of a coefficient"),
    field("does", kExplained<&Explanation::does>, "to a robot"),
    field("look", kExplained<&Explanation::look>, "at what on the robot"),
    field("drive", kExplained<&Explanation::drive>, "what, to be sure"),
    field("cause", &CatalogueEntry::cause, "the usual one"),
    field("remedy", &CatalogueEntry::remedy, "the usual one"),
    field("detectable", &CatalogueEntry::detectable,
          "coefficient from which on it is seen, roughly; 0: not known"),
    field("column", &CatalogueEntry::of_covariate, "goes with a column of the recording"),
    field("also_of", &CatalogueEntry::also_of, "channels that it is tried on, too"),
    field("parameters", &CatalogueEntry::parameters, "of the shape that are open"));

/// An entry as the list has it.
struct ListedEffect {
  const CatalogueEntry* entry = nullptr;
  std::string in_full;
};
template <>
inline constexpr auto kDescribed<ListedEffect> = described(keys_of("entry", &ListedEffect::entry),
                                                           field("in_full", &ListedEffect::in_full,
                                                                 "what is open in brackets"));

/// What effects says.
struct CatalogueReport {
  std::vector<ListedEffect> effects;
};
template <>
inline constexpr auto kDescribed<CatalogueReport> =
    described(field("effects", &CatalogueReport::effects, "of the catalogue"));

}  // namespace trussmap::results
