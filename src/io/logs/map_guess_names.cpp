// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/logs/named_fields.hpp"

#include <algorithm>

namespace trussmap {
namespace {

std::string unit_of_times(const NamedFacts& column) {
  const std::optional<Unit> named = unit_in(column.path);
  if (is_of(named, {Quantity::time})) return std::string(named->name);
  const LogFieldFacts& facts = *column.facts;
  // Since 1970, or by the step: no robot writes a row an hour or 100 000 a second.
  if (facts.least > 1e17) return "ns";
  if (facts.least > 1e14) return "us";
  if (facts.least > 1e11) return "ms";
  if (facts.least > 1e8) return "s";
  const double step = facts.total_step / std::max(1.0, static_cast<double>(facts.values - 1));
  if (step >= 1e6) return "ns";
  if (step >= 2e3) return "us";
  return step >= 2.0 ? "ms" : "s";
}

void guess_log_time(const FreeFields& fields, MapText& text) {
  // A Road Runner's messages have no times of their own.
  const NamedFacts* stamp = nullptr;
  for (const NamedFacts& one : fields.all()) {
    if (has_word(one.path, {"/timestamp"}) && one.facts->decreases == 0) stamp = &one;
  }
  const bool untimed = std::all_of(fields.all().begin(), fields.all().end(),
                                   [](const NamedFacts& one) { return one.step != one.step; });
  if (untimed && stamp != nullptr) {
    text.text("field", stamp->path.substr(stamp->path.rfind('/') + 1));
    text.text("unit", unit_of_times(*stamp));
  } else {
    text.text("from", "log", "when it was written");
  }
}

/// What never goes back; called so, if some is.
const NamedFacts* time_column(const std::vector<NamedFacts>& fields) {
  const auto grows = [](const NamedFacts& one) {
    return !one.facts->is_text && one.facts->decreases == 0 && one.facts->different > 0;
  };
  auto found = std::find_if(fields.begin(), fields.end(), [&grows](const NamedFacts& one) {
    return grows(one) && has_word(one.path, {"time", "stamp", "millis", "micros", "clock"});
  });
  if (found == fields.end()) found = std::find_if(fields.begin(), fields.end(), grows);
  return found == fields.end() ? nullptr : &*found;
}

/// How many figures are left to state.
int guess_column_time(FreeFields& fields, MapText& text) {
  if (const NamedFacts* column = time_column(fields.all())) {
    fields.mark_taken(*column);
    text.text("field", column->path);
    text.text("unit", unit_of_times(*column));
    return 0;
  }
  for (const NamedFacts& one : fields.all()) {
    if (!one.facts->is_text || !has_word(one.path, {"time", "date", "stamp"})) continue;
    fields.mark_taken(one);
    text.text("field", one.path);
    text.text("unit", "calendar", "date and time, UTC");
    return 0;
  }
  text.line("field = \"\"", kState);
  return 1;
}

void guess_covariates(const FreeFields& fields, MapText& text) {
  bool any = false;
  std::set<std::string> names;
  for (const NamedFacts& one : fields.all()) {
    if (fields.is_taken(one) || one.facts->is_text || one.facts->different == 0) continue;
    if (!has_word(one.path, {"batt", "volt", "temp", "payload", "load", "current", "light", "mass",
                             "weight", "pressure"})) {
      continue;
    }
    if (!any) {
      text.blank();
      text.table("covariates", "what else may matter; a row has the last value before its end");
    }
    any = true;
    const std::string name = covariate_name(one.path);
    if (names.insert(name).second) text.text(name, one.path);
  }
}

}  // namespace

const NamedFacts* FreeFields::find(const std::vector<Words>& words, const Words& without,
                                   bool text) const {
  for (const NamedFacts& one : *fields_) {
    if (is_taken(one) || one.facts->is_text != text || one.facts->values == 0) continue;
    if (has_word(one.path, without)) continue;
    if (std::all_of(words.begin(), words.end(),
                    [&](const Words& any) { return has_word(one.path, any); })) {
      return &one;
    }
  }
  return nullptr;
}

const NamedFacts* FreeFields::take(const std::vector<Words>& words, const Words& without) {
  const NamedFacts* found = find(words, without);
  if (found != nullptr) mark_taken(*found);
  return found;
}

bool is_of(const std::optional<Unit>& unit, std::initializer_list<Quantity> quantities) {
  return unit &&
         std::find(quantities.begin(), quantities.end(), unit->quantity) != quantities.end();
}

bool is_cumulative(const LogFieldFacts& facts) {
  if (facts.values < 3) return true;
  const double mean_step = facts.total_step / static_cast<double>(facts.values - 1);
  constexpr double kMany = 12.0;
  const double range = facts.largest - facts.least;
  const bool grows = facts.decreases == 0 || facts.decreases + 1 == facts.values;
  return range > kMany * mean_step || (grows && range > 2.0 * mean_step);
}

bool looks_like_degrees(const LogFieldFacts& facts) {
  constexpr double kTurn = 7.0;  // rad
  return facts.largest - facts.least > kTurn;
}

Guessed guess_by_names(const std::vector<NamedFacts>& all, bool table, MapText& text) {
  FreeFields fields(all);
  Guessed found;
  text.table("time");
  if (table) {
    found.to_state += guess_column_time(fields, text);
  } else {
    guess_log_time(fields, text);
  }
  const std::optional<int> wheels = guess_wheels(fields, text);
  found.wheels = wheels.has_value();
  found.to_state += wheels.value_or(0);
  guess_headings(fields, text);
  const bool sightings = guess_sightings(fields, text);
  const bool fixes = guess_fixes(fields, text);
  const bool truth = guess_truth(fields, text);
  found.places = sightings || fixes || truth;
  guess_covariates(fields, text);
  return found;
}

}  // namespace trussmap
