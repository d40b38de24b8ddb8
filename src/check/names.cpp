// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/findings.hpp"
#include "check/visits.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace trussmap::check {
namespace {

bool has_blanks(std::string_view name) {
  return !name.empty() && (name.front() == ' ' || name.back() == ' ');
}

void check_blanks(Checked& checked, const char* file, const std::set<std::string_view>& names) {
  const auto first = std::find_if(names.begin(), names.end(), has_blanks);
  if (first == names.end()) return;
  const auto count = std::count_if(names.begin(), names.end(), has_blanks);
  checked.add(file, "landmark", "blank in a name",
              text::joined("landmark \"", *first, "\" begins or ends with a blank",
                           count > 1 ? text::joined("; ", count, " names do") : "",
                           ": it is another than the one without"),
              "remove the blanks");
}

constexpr double kNearer = 0.75;              // of the distance to the other place, and
constexpr double kNear = 0.6;                 // of that between the two
constexpr double kShareOthers = 0.1;          // of the other landmarks
constexpr std::size_t kFewestAtEach = 2;      // visits: one may be a wrong sighting;
constexpr std::size_t kFewestSeenAtEach = 3;  // from afar wrong sightings are more frequent

/// How many visits are at each of two places; 0 of what is at one.
struct Split {
  std::size_t all = 0;
  std::size_t fewest = kFewestAtEach;
  std::size_t first = 0;
  std::size_t second = 0;
  double apart = 0.0;  ///< m

  [[nodiscard]] bool clear() const {
    return first >= fewest && second >= fewest && 2 * (first + second) > all;
  }
};

/// About the two neighbours in time that lie farthest beyond what is usual.
Split split_of(const std::vector<Visit>& visits, const UsualMiss& usual) {
  std::size_t at = 0;
  double most = kOtherPlace;
  for (std::size_t k = 1; k < visits.size(); ++k) {
    const double beyond =
        (visits[k].place - visits[k - 1].place).norm() / usual.allowed(visits[k - 1], visits[k]);
    if (beyond <= most) continue;
    most = beyond;
    at = k;
  }
  Split split;
  split.all = visits.size();
  const bool seen =
      std::any_of(visits.begin(), visits.end(), [](const Visit& v) { return v.seen; });
  if (seen) split.fewest = kFewestSeenAtEach;
  if (at == 0) return split;
  const Visit& a = visits[at - 1];
  const Visit& b = visits[at];
  split.apart = (b.place - a.place).norm();
  for (const Visit& one : visits) {
    const double to_a = (one.place - a.place).norm();
    const double to_b = (one.place - b.place).norm();
    // Nearer by far to one than to the other, or it tells nothing.
    if (to_a < kNearer * to_b && to_a < kNear * split.apart) ++split.first;
    if (to_b < kNearer * to_a && to_b < kNear * split.apart) ++split.second;
  }
  return split;
}

void check_two_places(Checked& checked, const Visits& visits, const UsualMiss& usual) {
  std::map<std::string_view, Split> splits;
  for (const auto& [name, all] : visits) {
    const Split split = split_of(all, usual);
    if (split.clear()) splits[name] = split;
  }
  const auto landmarks = static_cast<double>(visits.size());
  if (static_cast<double>(splits.size()) > std::max(1.0, kShareOthers * landmarks)) return;
  for (const auto& [name, split] : splits) {
    checked.add("sightings.csv", "landmark", "one name at two places",
                text::joined("landmark ", name, " is found in ", split.first,
                             " visits at one place and in ", split.second, " at another, ",
                             figure(split.apart, "m"), " from it"),
                "look for a second landmark of that name, or one that was moved");
  }
}

}  // namespace

void check_names(Checked& checked) {
  std::set<std::string_view> sighted;
  for (const Sighting& one : checked.recording.sightings) sighted.insert(one.landmark);
  check_blanks(checked, "sightings.csv", sighted);
  std::set<std::string_view> surveyed;
  for (const SurveyPoint& one : checked.recording.survey) surveyed.insert(one.landmark);
  check_blanks(checked, "survey.csv", surveyed);
}

void check_labels(Checked& checked, const Track& track, bool by_truth) {
  constexpr double kPass = 1.0;  // m
  const Visits visits = visits_of(checked, track, by_truth, kPass);
  const UsualMiss usual = usual_miss(visits, by_truth);
  if (!usual.known) return;
  check_two_places(checked, visits, usual);
  check_wrong_labels(checked, visits_of(checked, track, by_truth, 0.0), usual);
}

}  // namespace trussmap::check
