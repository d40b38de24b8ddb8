// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/named_fields.hpp"

#include <algorithm>

namespace trussmap::logs {
namespace {

void guess_covariates(const FreeFields& fields, MapText& text) {
  bool any = false;
  std::set<std::string> names;
  for (const NamedFacts& one : fields.all()) {
    if (!fields.is_free(one) || one.facts->is_text) continue;
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
    if (!names.insert(name).second) continue;
    if (one.file.empty()) {
      text.text(name, one.path);
    } else {
      text.line(fmt::format("{} = {{ file = {}, field = {} }}", name, io::toml_string(one.file),
                            io::toml_string(one.path)));
    }
  }
}

}  // namespace

bool FreeFields::is_free(const NamedFacts& field) const {
  return !is_taken(field) && field.facts->values > 0 && field.facts->different > 0 &&
         (!file_ || field.file == *file_);
}

const NamedFacts* FreeFields::find(const std::vector<Words>& words, const Words& without,
                                   bool text) const {
  for (const bool by_file : {false, true}) {
    for (const NamedFacts& one : *fields_) {
      if (!is_free(one) || one.facts->is_text != text || has_word(one.path, without)) continue;
      if (by_file && one.file.empty()) continue;
      const std::string name = by_file ? stem_of(one.file) + ' ' + one.path : one.path;
      if (std::all_of(words.begin(), words.end(),
                      [&](const Words& any) { return has_word(name, any); })) {
        return &one;
      }
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

char axis_of(const std::string& path) {
  const std::vector<std::string> words = words_of(path);
  for (auto word = words.rbegin(); word != words.rend(); ++word) {
    const bool number = std::all_of(word->begin(), word->end(),
                                    [](unsigned char c) { return std::isdigit(c) != 0; });
    if (number || unit_named(*word)) continue;
    const char last = word->back();
    if (last != 'x' && last != 'y' && last != 'z' && last != 'w') return '\0';
    const std::string before = word->substr(0, word->size() - 1);
    for (const char* one : {"", "p", "q", "v", "w", "g", "a", "m", "pos", "gyro", "acc", "mag",
                            "ang", "lin", "rot", "quat", "omega"}) {
      if (before == one) return last;
    }
    return '\0';
  }
  return '\0';
}

std::string stem_of(const std::string& file) {
  const std::string name = file.substr(file.rfind('/') + 1);
  return name.substr(0, name.find('.'));
}

void write_file_of(const NamedFacts& field, MapText& text) {
  if (!field.file.empty()) text.text("file", field.file);
}

bool guess_beside(const std::vector<NamedFacts>& all, const Guessed& bag, MapText& text) {
  FreeFields fields(all);
  MapText none;
  const bool truth = guess_truth(fields, bag.truth ? none : text) && !bag.truth;
  const bool sightings = guess_sightings(fields, text);
  const bool fixes = guess_fixes(fields, bag.fixes ? none : text) && !bag.fixes;
  return truth || sightings || fixes;
}

Guessed guess_by_names(const std::vector<NamedFacts>& all, bool table,
                       const std::vector<LogClockFacts>& clocks, MapText& text) {
  FreeFields fields(all);
  Guessed found;
  if (table) {
    found.to_state += guess_times(fields, clocks, text);
  } else {
    text.table("time");
    guess_log_time(fields, text);
  }
  // What is called a truth first, lest its poses be taken for an odometry's.
  MapText truths;
  const bool truth = guess_truth(fields, truths);
  std::optional<int> wheels = guess_body_speeds(fields, true, text);
  if (!wheels) wheels = guess_wheels(fields, text);
  if (!wheels) wheels = guess_body_speeds(fields, false, text);
  pass_over_body_speeds(fields);
  MapText marks;
  const bool sightings = guess_sightings(fields, marks);
  MapText places;
  const bool fixes = guess_fixes(fields, places);
  if (wheels) {
    pass_over_odometries(fields, text);
  } else {
    wheels = guess_odometry(fields, text);
  }
  found.wheels = wheels.has_value();
  found.to_state += wheels.value_or(0);
  guess_headings(fields, text);
  text.append(marks);
  text.append(places);
  text.append(truths);
  found.places = sightings || fixes || truth;
  guess_covariates(fields, text);
  list_unnamed(fields, text);
  return found;
}

}  // namespace trussmap::logs
