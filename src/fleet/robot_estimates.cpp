// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "fleet/robot_estimates.hpp"

#include "statistics/distributions.hpp"
#include "statistics/multiple_tests.hpp"
#include "statistics/random_effects.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace trussmap {
namespace {

constexpr double kMostRobots = 0.9;          // whose remainder a mean has to be beyond
constexpr int kLeastGroup = 3;               // robots
constexpr const char* kService = "service";  // the key whose date days count from

/// Weighted line through a robot's days.
struct Line {
  int days = 0;
  double mean = 0.0;
  double mean_variance = 0.0;
  bool has_slope = false;
  double slope = 0.0;
  double slope_variance = 0.0;
  double first = 0.0;  ///< value on its first day
  double first_variance = 0.0;
  double misfit = 0.0;  ///< chi^2 about the line
  int dof = 0;
  double remainder = 0.0;  ///< of the mean: error that robots may have in common
};

Line line_of(const FleetMember& member, const std::vector<DayEstimate>& days) {
  Line line;
  double W = 0.0;
  double Wx = 0.0;
  double Wy = 0.0;
  double first_day = 0.0;
  for (std::size_t k = 0; k < member.rows.size(); ++k) {
    const DayEstimate& one = days[member.rows[k]];
    if (!one.seen) continue;
    if (line.days == 0) first_day = member.day[k];
    ++line.days;
    const double w = 1.0 / one.variance;
    W += w;
    Wx += w * member.day[k];
    Wy += w * one.value;
  }
  if (line.days == 0) return line;
  double share = 0.0;
  for (const std::size_t row : member.rows) share = std::max(share, days[row].remainder);
  line.remainder = std::sqrt(share / W);
  const double x0 = Wx / W;
  line.mean = Wy / W;
  line.mean_variance = 1.0 / W;
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t k = 0; k < member.rows.size(); ++k) {
    const DayEstimate& one = days[member.rows[k]];
    if (!one.seen) continue;
    const double x = member.day[k] - x0;
    xx += x * x / one.variance;
    xy += x * (one.value - line.mean) / one.variance;
  }
  constexpr double kSameDay = 1e-9;
  line.has_slope = xx > kSameDay * W;
  if (line.has_slope) {
    line.slope = xy / xx;
    line.slope_variance = 1.0 / xx;
    line.first = line.mean + line.slope * (first_day - x0);
    line.first_variance = line.mean_variance + (first_day - x0) * (first_day - x0) / xx;
  }
  for (std::size_t k = 0; k < member.rows.size(); ++k) {
    const DayEstimate& one = days[member.rows[k]];
    if (!one.seen) continue;
    const double off = one.value - line.mean - line.slope * (member.day[k] - x0);
    line.misfit += off * off / one.variance;
  }
  line.dof = line.days - (line.has_slope ? 2 : 1);
  return line;
}

/// What days scatter by beyond their errors (Birge's ratio), taken into all variances.
void widen(std::vector<Line>& lines) {
  double misfit = 0.0;
  int dof = 0;
  for (const Line& one : lines) {
    misfit += one.misfit;
    dof += one.dof;
  }
  const double ratio = dof > 0 ? std::max(1.0, misfit / dof) : 1.0;
  for (Line& one : lines) {
    one.mean_variance *= ratio;
    one.slope_variance *= ratio;
    one.first_variance *= ratio;
  }
}

void find_drifts(FleetCoefficient& result, const std::vector<Line>& lines, double level,
                 double tests) {
  std::vector<MemberEstimate> slopes;
  std::vector<std::size_t> of;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    FleetRobot& robot = result.members[k];
    robot.has_slope = lines[k].has_slope;
    if (!robot.has_slope) continue;
    robot.slope = lines[k].slope;
    robot.slope_sd = std::sqrt(lines[k].slope_variance);
    slopes.push_back({robot.slope, lines[k].slope_variance, 0});
    of.push_back(k);
  }
  if (slopes.empty()) return;
  const RandomEffects all = random_effects(slopes, 1, level / tests);
  result.slope = all.mean;
  result.slope_sd = all.sd;
  result.p_slope = bonferroni(all.p_mean, tests);
  result.all_drift = slopes.size() > 1 && result.p_slope < level;
  for (std::size_t k = 0; k < of.size(); ++k) {
    FleetRobot& robot = result.members[of[k]];
    robot.p_drifts = bonferroni(all.p_member[k], tests);
    robot.drifts = robot.p_drifts < level;
  }
}

/// Members by the values of a key; those of values that are too few have no group.
struct Grouping {
  std::vector<std::string> values;
  std::vector<int> group;  ///< per member, -1: none
};

Grouping grouping_by(const std::string& key, const FleetMembers& fleet,
                     const std::vector<bool>& there) {
  std::map<std::string, int> count;
  const auto value_of = [&](std::size_t k) -> const std::string* {
    const auto found = fleet.members[k].metadata.find(key);
    return there[k] && found != fleet.members[k].metadata.end() ? &found->second : nullptr;
  };
  for (std::size_t k = 0; k < fleet.members.size(); ++k) {
    if (const std::string* value = value_of(k)) ++count[*value];
  }
  Grouping result;
  for (const auto& [value, members] : count) {
    if (members >= kLeastGroup) result.values.push_back(value);
  }
  for (std::size_t k = 0; k < fleet.members.size(); ++k) {
    const std::string* value = value_of(k);
    const auto at = value == nullptr
                        ? result.values.end()
                        : std::find(result.values.begin(), result.values.end(), *value);
    result.group.push_back(
        at == result.values.end() ? -1 : static_cast<int>(at - result.values.begin()));
  }
  return result;
}

/// p of a mean that is as far from 0 as the remainder at most.
double p_beyond(double mean, double sd, double remainder, int dof) {
  const double z = std::max(0.0, std::abs(mean) - remainder) / sd;
  return dof > 0 ? 2.0 * student_p_value(z, dof) : chi2_p_value(z * z, 1);
}

struct Fitted {
  std::vector<std::size_t> of;  ///< members
  RandomEffects effects;
};

Fitted fitted(const std::vector<Line>& lines, const std::vector<bool>& drifts,
              const Grouping& grouping, double level) {
  Fitted result;
  std::vector<MemberEstimate> members;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (grouping.group[k] < 0) continue;
    members.push_back({drifts[k] ? lines[k].first : lines[k].mean,
                       drifts[k] ? lines[k].first_variance : lines[k].mean_variance,
                       static_cast<std::size_t>(grouping.group[k])});
    result.of.push_back(k);
  }
  result.effects = random_effects(members, grouping.values.size(), level);
  return result;
}

}  // namespace

FleetMembers fleet_members(const std::vector<FleetRow>& rows) {
  FleetMembers fleet;
  std::set<std::string> keys;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const FleetRow& row = rows[k];
    const bool first = fleet.members.empty() || fleet.members.back().robot != row.robot;
    if (first) fleet.members.push_back({row.robot, {}, {}, row.metadata});
    FleetMember& member = fleet.members.back();
    int since = day_number(rows[first ? k : member.rows.front()].date);
    if (const auto service = row.metadata.find(kService); service != row.metadata.end()) {
      try {
        since = day_number(service->second);
      } catch (const InputError&) {  // words, no date
      }
    }
    member.rows.push_back(k);
    member.day.push_back(day_number(row.date) - since);
    std::erase_if(member.metadata, [&row](const auto& one) {
      const auto found = row.metadata.find(one.first);
      return found == row.metadata.end() || found->second != one.second;
    });
    for (const auto& [key, value] : row.metadata) {
      if (key != kService) keys.insert(key);
    }
  }
  const std::vector<bool> all(fleet.members.size(), true);
  for (const std::string& key : keys) {
    if (grouping_by(key, fleet, all).values.size() > 1) fleet.keys.push_back(key);
  }
  return fleet;
}

FleetCoefficient analyse_coefficient(const FleetMembers& fleet,
                                     const std::vector<DayEstimate>& days, double level,
                                     double tests) {
  FleetCoefficient result;
  std::vector<Line> lines;
  std::vector<bool> there;
  for (const FleetMember& member : fleet.members) {
    const Line line = line_of(member, days);
    there.push_back(line.days > 0);
    if (line.days == 0) continue;
    ++result.robots;
  }
  FleetMembers seen{{}, fleet.keys};
  for (std::size_t k = 0; k < there.size(); ++k) {
    if (!there[k]) continue;
    seen.members.push_back(fleet.members[k]);
    lines.push_back(line_of(fleet.members[k], days));
    result.members.push_back({fleet.members[k].robot, lines.back().days});
  }
  if (lines.empty()) return result;
  widen(lines);
  double remainder = 0.0;  // at most, of any robot
  std::vector<double> remainders;
  for (const Line& one : lines) remainders.push_back(one.remainder);
  std::sort(remainders.begin(), remainders.end());
  remainder = remainders[static_cast<std::size_t>(kMostRobots *
                                                  static_cast<double>(remainders.size() - 1))];
  find_drifts(result, lines, level, tests);
  std::vector<bool> drifts;
  for (const FleetRobot& one : result.members) drifts.push_back(one.drifts);

  const std::vector<bool> all(lines.size(), true);
  Grouping grouping{{""}, std::vector<int>(lines.size(), 0)};
  Fitted fit = fitted(lines, drifts, grouping, level / tests);
  const double key_tests = tests * static_cast<double>(std::max<std::size_t>(1, fleet.keys.size()));
  std::vector<std::pair<std::string, Grouping>> chosen;
  double best_p = 1.0;
  for (const std::string& key : fleet.keys) {
    Grouping by = grouping_by(key, seen, all);
    if (by.values.size() < 2) continue;
    const Fitted one = fitted(lines, drifts, by, level / tests);
    const double p = bonferroni(one.effects.p_groups, key_tests);
    const auto [least, most] =
        std::minmax_element(one.effects.groups.begin(), one.effects.groups.end(),
                            [](const GroupMean& a, const GroupMean& b) { return a.mean < b.mean; });
    if (!(p < level) || most->mean - least->mean < 2.0 * remainder) continue;
    if (!chosen.empty() && by.group == chosen.front().second.group) {
      result.goes_with.front().same_as.push_back(key);
      continue;
    }
    // Of keys that both matter the one that leaves the smaller spread and fewer robots that differ.
    const auto left = [](const Fitted& f) {
      double sum = 0.0;
      for (std::size_t k = 0; k < f.effects.outlying.size(); ++k) sum += f.effects.outlying[k];
      return sum;
    };
    const bool better = chosen.empty() || left(one) < left(fit) ||
                        (left(one) == left(fit) &&
                         (p < best_p || (p == best_p && one.effects.tau < fit.effects.tau)));
    if (!better) continue;
    chosen = {{key, by}};
    best_p = p;
    fit = one;
    FleetKey found{key, p, {}, {}};
    for (std::size_t g = 0; g < by.values.size(); ++g) {
      const GroupMean& group = one.effects.groups[g];
      found.groups.push_back(
          {by.values[g], group.members, group.mean, group.sd,
           bonferroni(group.p_value, tests * static_cast<double>(by.values.size()))});
    }
    result.goes_with = {found};
  }
  if (!chosen.empty()) grouping = chosen.front().second;

  const RandomEffects& effects = fit.effects;
  result.mean = effects.mean;
  result.sd = effects.sd;
  result.p_common = bonferroni(p_beyond(effects.mean, effects.sd, remainder, effects.Q_dof), tests);
  result.common = result.p_common < level;
  if (!result.goes_with.empty()) {
    const std::vector<FleetGroup>& groups = result.goes_with.front().groups;
    result.common = std::all_of(groups.begin(), groups.end(), [&](const FleetGroup& one) {
      return one.p_value < level && (one.mean > 0.0) == (groups.front().mean > 0.0);
    });
  }
  result.tau = effects.tau;
  result.p_tau = bonferroni(effects.p_tau, tests);
  result.Q = effects.Q;
  result.Q_dof = effects.Q_dof;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    FleetRobot& robot = result.members[k];
    robot.value = drifts[k] ? lines[k].first : lines[k].mean;
    robot.sd = std::sqrt(drifts[k] ? lines[k].first_variance : lines[k].mean_variance);
    robot.shrunken = robot.value;
    robot.shrunken_sd = robot.sd;
  }
  for (std::size_t at = 0; at < fit.of.size(); ++at) {
    FleetRobot& robot = result.members[fit.of[at]];
    robot.p_differs = bonferroni(effects.p_member[at], tests);
    robot.differs = effects.outlying[at];
    if (robot.differs) continue;
    const GroupMean& group = effects.groups[static_cast<std::size_t>(grouping.group[fit.of[at]])];
    const double tau2 = effects.tau * effects.tau;
    const double share = tau2 / (tau2 + robot.sd * robot.sd);
    robot.shrunken = group.mean + share * (robot.value - group.mean);
    robot.shrunken_sd = std::sqrt(share * robot.sd * robot.sd +
                                  (1.0 - share) * (1.0 - share) * group.sd * group.sd);
  }
  return result;
}

}  // namespace trussmap
