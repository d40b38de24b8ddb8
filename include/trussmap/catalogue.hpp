// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// The catalogue of physical effects: names for channel x shape, with their usual sizes, what causes
// them and what helps. A catalogue effect is no different from a user's own with the same channel
// and shapes.
//
// Some entries stand for many effects. What is open goes in brackets behind the name:
//
//   a variable or covariate column ("{}" in the patterns)   "tyre drift (temperature_C)"
//   shape parameters ("{r}" and so on in the patterns)      "slippery patch (x=12, y=9, r=3)"
#pragma once

#include "trussmap/channel.hpp"
#include "trussmap/model.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

/// A shape parameter that is open: a place, a radius, a threshold.
struct OpenParameter {
  std::string_view name;  ///< "{name}" in the patterns
  std::string_view unit;
  double usual = 0.0;     ///< where a search may begin; a place has no usual value: 0
  double smallest = 0.0;  ///< bounds of a search; equal where the recording has to give them
  double largest = 0.0;
};

struct CatalogueEntry {
  std::string_view name;
  Channel channel = Channel::travel;
  std::vector<std::string> pattern;  ///< "{}" for a covariate's name, "{r}" for a parameter
  std::string_view cause;            ///< what makes it, in words
  std::string_view remedy;           ///< what an owner can do about it
  std::string_view unit;  ///< of a coefficient, "" = none; "column" = the covariate's unit
  /// Largest |g| of a recording that a tour of 60 legs of 5 m with survey and compass just shows;
  /// unit of the channel; 0: not known. Rough: a recording's own design decides.
  double detectable = 0.0;
  std::vector<OpenParameter> parameters;
  /// Variables of every recording to be tried in place of a covariate, besides its columns.
  std::vector<std::string_view> also_of;

  [[nodiscard]] bool of_covariate() const;
  [[nodiscard]] bool has_parameters() const { return !parameters.empty(); }
  /// Standard deviation of a weak prior on the largest |g| of a recording: the channel's.
  [[nodiscard]] double prior_sd() const { return facts_of(channel).prior_sd; }
};

[[nodiscard]] const std::vector<CatalogueEntry>& catalogue();

/// The entry of this name, nullptr where there is none. What stands in brackets is not looked at.
[[nodiscard]] const CatalogueEntry* find_entry(std::string_view name);

/// For messages on a name that is in no catalogue: what may have been meant, `; is "wheelbase"
/// meant?`. Empty: nothing is like it.
[[nodiscard]] std::string what_was_meant(std::string_view name);

/// "tyre drift (temperature_C)".
[[nodiscard]] std::string name_of(const CatalogueEntry& entry, std::string_view covariate);

/// "slippery patch (x=12, y=9, r=3)", in numbers that read back to the same bits.
[[nodiscard]] std::string name_of(const CatalogueEntry& entry,
                                  const std::vector<ShapeParameter>& parameters);

/// The effect of a name, with the catalogue's channel and shapes. Throws std::invalid_argument on a
/// name that is in no catalogue or lacks its covariate or its parameters, and on coefficients that
/// are not one per shape.
[[nodiscard]] Effect catalogue_effect(std::string_view name, std::vector<double> coefficients = {});

/// The effect of an entry with nothing open, or of a covariate, or with these parameters.
[[nodiscard]] Effect catalogue_effect(const CatalogueEntry& entry);
[[nodiscard]] Effect catalogue_effect(const CatalogueEntry& entry, std::string_view covariate);
[[nodiscard]] Effect catalogue_effect(const CatalogueEntry& entry,
                                      const std::vector<ShapeParameter>& parameters);

}  // namespace trussmap
