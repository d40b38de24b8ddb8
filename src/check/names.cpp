// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/findings.hpp"
#include "statistics/median.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

namespace trussmap {
namespace {

bool has_blanks(std::string_view name) {
  return !name.empty() && (name.front() == ' ' || name.back() == ' ');
}

void check_blanks(Checked& checked, const char* file, const std::set<std::string_view>& names) {
  const auto first = std::find_if(names.begin(), names.end(), has_blanks);
  if (first == names.end()) return;
  const auto count = std::count_if(names.begin(), names.end(), has_blanks);
  checked.add(file, "landmark", "blank in a name",
              joined("landmark \"", *first, "\" begins or ends with a blank",
                     count > 1 ? joined("; ", count, " names do") : "",
                     ": it is another than the one without"),
              "remove the blanks");
}

/// Where one landmark was.
struct Visit {
  double t = 0.0;    ///< s
  double way = 0.0;  ///< m driven until then
  Vector2 place = Vector2::Zero();
  bool seen = false;  ///< from afar
};
using Visits = std::map<std::string_view, std::vector<Visit>>;

constexpr double kPass = 1.0;         // m: sightings within it are one visit
constexpr double kApart = 1.0;        // m, and
constexpr double kApartShare = 0.05;  // of the way in between, and
constexpr double kApartTimes = 6.0;   // as much as is usual
constexpr double kBeyond = 1.5;       // times what is allowed
constexpr double kNearer = 0.75;      // of the distance to the other place, and
constexpr double kNear = 0.6;         // of that between the two
constexpr double kShareOthers = 0.1;  // of the other landmarks
constexpr std::size_t kFewestReturns = 8;
constexpr std::size_t kFewestAtEach = 2;      // visits: one may be a wrong sighting;
constexpr std::size_t kFewestSeenAtEach = 3;  // from afar wrong sightings are more frequent

/// Straight between two rows of truth, the nearest row just outside of them; nothing in gaps.
std::optional<Pose> truth_at(const std::vector<TruthRow>& truth, double t) {
  constexpr double kGap = 1.0;  // s
  const auto after = std::lower_bound(truth.begin(), truth.end(), t,
                                      [](const TruthRow& row, double at) { return row.t < at; });
  if (after == truth.end() || after == truth.begin()) {
    const TruthRow& end = after == truth.end() ? truth.back() : truth.front();
    if (std::abs(end.t - t) > 0.5 * kGap) return std::nullopt;
    return Pose{end.x, end.y, end.heading};
  }
  const TruthRow& a = *(after - 1);
  const TruthRow& b = *after;
  if (b.t - a.t > kGap) return std::nullopt;
  const double share = (t - a.t) / (b.t - a.t);
  return Pose{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y),
              a.heading + share * wrap_angle(b.heading - a.heading)};
}

Visits visits_of(const Checked& checked, const Track& track, bool by_truth) {
  Visits visits;
  for (const Sighting& one : checked.recording.sightings) {
    if (!tells_place(one)) continue;
    const double way = track.way_at(one.t);
    std::vector<Visit>& own = visits[one.landmark];
    // Twice in one frame is worth asking.
    if (!own.empty() && way - own.back().way < kPass && one.t != own.back().t) continue;
    std::optional<Pose> pose = track.at(one.t);
    if (by_truth) pose = truth_at(checked.recording.truth, one.t);
    if (pose)
      own.push_back({one.t, way, place_seen(one, *pose, checked.angle_unit), !one.standing()});
  }
  return visits;
}

/// By how much returns to a landmark miss it, as medians.
struct Usual {
  bool known = false;
  double share = 0.0;  ///< of the way
  double off = 0.0;    ///< m, of what is seen from afar, the third of the returns that are soonest
};

Usual usual_of(const Visits& visits) {
  struct Return {
    double way;
    double off;
    bool seen;
  };
  std::vector<Return> returns;
  for (const auto& [name, all] : visits) {
    for (std::size_t k = 1; k < all.size(); ++k) {
      if (all[k].t == all[k - 1].t) continue;
      returns.push_back(
          {all[k].way - all[k - 1].way, (all[k].place - all[k - 1].place).norm(), all[k].seen});
    }
  }
  if (returns.size() < kFewestReturns) return {};
  std::sort(returns.begin(), returns.end(),
            [](const Return& a, const Return& b) { return a.way < b.way; });
  std::vector<double> shares;
  std::vector<double> offs;
  for (std::size_t k = 0; k < returns.size(); ++k) {
    shares.push_back(returns[k].off / returns[k].way);
    if (3 * k <= returns.size() && returns[k].seen) offs.push_back(returns[k].off);
  }
  return {true, median(std::move(shares)), offs.empty() ? 0.0 : median(std::move(offs))};
}

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

/// Places may be off by so much, or such a share of the way. About the two neighbours in time that
/// lie farthest beyond that.
Split split_of(const std::vector<Visit>& visits, double off, double share) {
  const auto allowed = [off, share](const Visit& a, const Visit& b) {
    return std::max(off, share * std::abs(b.way - a.way));
  };
  std::size_t at = 0;
  double most = kBeyond;
  for (std::size_t k = 1; k < visits.size(); ++k) {
    const double beyond =
        (visits[k].place - visits[k - 1].place).norm() / allowed(visits[k - 1], visits[k]);
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

}  // namespace

void check_names(Checked& checked) {
  std::set<std::string_view> sighted;
  for (const Sighting& one : checked.recording.sightings) sighted.insert(one.landmark);
  check_blanks(checked, "sightings.csv", sighted);
  std::set<std::string_view> surveyed;
  for (const SurveyPoint& one : checked.recording.survey) surveyed.insert(one.landmark);
  check_blanks(checked, "survey.csv", surveyed);
}

void check_two_places(Checked& checked, const Track& track, bool by_truth) {
  for (const char* column : {"left", "right", "t", "range", "bearing"}) {
    if (checked.wrong.contains(column)) return;
  }
  const Visits visits = visits_of(checked, track, by_truth);
  const Usual usual = usual_of(visits);
  if (!usual.known) return;
  const double share = by_truth ? 0.0 : std::max(kApartShare, kApartTimes * usual.share);
  const double off = std::max(kApart, kApartTimes * usual.off);
  std::map<std::string_view, Split> splits;
  for (const auto& [name, all] : visits) {
    const Split split = split_of(all, off, share);
    if (split.clear()) splits[name] = split;
  }
  const auto landmarks = static_cast<double>(visits.size());
  if (static_cast<double>(splits.size()) > std::max(1.0, kShareOthers * landmarks)) return;
  for (const auto& [name, split] : splits) {
    checked.add(
        "sightings.csv", "landmark", "one name at two places",
        joined("landmark ", name, " is found in ", split.first, " visits at one place and in ",
               split.second, " at another, ", figure(split.apart, "m"), " from it"),
        "look for a second landmark of that name, or one that was moved");
  }
}

}  // namespace trussmap
