// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Guesses by the names of columns and entries. Each writes its tables into a first map.toml, and
// takes the fields that it needs.
#pragma once

#include "io/logs/map_guess.hpp"
#include "io/logs/units.hpp"

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace trussmap {

/// A log's fields, and which of them are taken.
class FreeFields {
 public:
  using Words = std::vector<std::string>;

  explicit FreeFields(const std::vector<NamedFacts>& fields) : fields_(&fields) {}

  [[nodiscard]] const std::vector<NamedFacts>& all() const { return *fields_; }
  [[nodiscard]] bool is_taken(const NamedFacts& field) const { return taken_.contains(field.path); }
  /// The first field that is not taken yet and has a word of each list, and none of `without`.
  [[nodiscard]] const NamedFacts* find(const std::vector<Words>& words, const Words& without,
                                       bool text = false) const;
  const NamedFacts* take(const std::vector<Words>& words, const Words& without = {});
  void mark_taken(const NamedFacts& field) { taken_.insert(field.path); }

 private:
  const std::vector<NamedFacts>* fields_;
  std::set<std::string> taken_;
};

[[nodiscard]] bool is_of(const std::optional<Unit>& unit,
                         std::initializer_list<Quantity> quantities);
/// A sum so far has a range of many steps; what is added a row has not.
[[nodiscard]] bool is_cumulative(const LogFieldFacts& facts);
/// What ranges over more than a turn in radians.
[[nodiscard]] bool looks_like_degrees(const LogFieldFacts& facts);

/// How many figures are left to state; nothing where there are no wheels.
std::optional<int> guess_wheels(FreeFields& fields, MapText& text);
void guess_headings(FreeFields& fields, MapText& text);
/// Whether there are some.
bool guess_sightings(FreeFields& fields, MapText& text);
bool guess_fixes(FreeFields& fields, MapText& text);
bool guess_truth(FreeFields& fields, MapText& text);

}  // namespace trussmap
