// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Names of landmarks that differ in upper and lower case alone: in two files, where each has the
// one that the other lacks; in one file, where most names have no such twin.
#include "check/findings.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::check {
namespace {

using Names = std::set<std::string_view>;

std::string lower_case(std::string_view name) {
  std::string result(name);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

struct Twins {
  std::string_view one;
  std::string_view other;
};

/// Sighted alone, surveyed alone.
std::vector<Twins> twins_between(const Names& sighted, const Names& surveyed) {
  std::map<std::string, std::string_view> alone;
  for (const std::string_view name : surveyed) {
    if (!sighted.contains(name)) alone[lower_case(name)] = name;
  }
  std::vector<Twins> twins;
  for (const std::string_view name : sighted) {
    if (surveyed.contains(name)) continue;
    if (const auto at = alone.find(lower_case(name)); at != alone.end()) {
      twins.push_back({name, at->second});
    }
  }
  return twins;
}

std::vector<Twins> twins_within(const Names& names) {
  constexpr double kMost = 0.25;  // of the names; more are meant
  std::map<std::string, std::string_view> known;
  std::vector<Twins> twins;
  for (const std::string_view name : names) {
    const auto [at, fresh] = known.emplace(lower_case(name), name);
    if (!fresh) twins.push_back({at->second, name});
  }
  const auto count = static_cast<double>(twins.size());
  if (count > std::max(1.0, kMost * static_cast<double>(names.size()))) twins.clear();
  return twins;
}

void add_twins(Checked& checked, const char* file, const std::vector<Twins>& twins,
               const char* first_is, const char* second_is) {
  if (twins.empty()) return;
  checked.add(
      file, "landmark", "names differ in case",
      text::joined("landmark \"", twins.front().one, "\"", first_is, " and \"", twins.front().other,
                   "\"", second_is, " differ in upper and lower case alone",
                   twins.size() > 1 ? text::joined("; ", twins.size(), " pairs do") : "",
                   ": they are two landmarks"),
      "give each landmark one name");
}

}  // namespace

void check_case(Checked& checked) {
  Names sighted;
  for (const Sighting& one : checked.recording.sightings) sighted.insert(one.landmark);
  Names surveyed;
  for (const SurveyPoint& one : checked.recording.survey) surveyed.insert(one.landmark);
  add_twins(checked, "survey.csv", twins_between(sighted, surveyed), " as sighted", " as surveyed");
  add_twins(checked, "sightings.csv", twins_within(sighted), "", "");
}

}  // namespace trussmap::check
