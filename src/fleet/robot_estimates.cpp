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

namespace trussmap::fleet {
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

/// Slopes of the robots against each other.
struct Slopes {
  std::vector<std::size_t> of;  ///< members
  std::vector<double> p;        ///< of each alone: of the slope that all have
  std::vector<double> holm;     ///< over all of them
};

Slopes slopes_of(FleetCoefficient& result, const std::vector<Line>& lines, double level,
                 double tests) {
  Slopes slopes;
  std::vector<statistics::MemberEstimate> estimates;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    FleetRobot& robot = result.members[k];
    robot.has_slope = lines[k].has_slope;
    if (!robot.has_slope) continue;
    robot.slope = lines[k].slope;
    robot.slope_sd = std::sqrt(lines[k].slope_variance);
    estimates.push_back({robot.slope, lines[k].slope_variance, 0});
    slopes.of.push_back(k);
  }
  if (estimates.empty()) return slopes;
  const statistics::RandomEffects all = statistics::random_effects(estimates, 1, level / tests);
  result.slope = all.mean;
  result.slope_sd = all.sd;
  result.p_slope = statistics::bonferroni(all.p_mean, tests);
  result.all_drift = estimates.size() > 1 && result.p_slope < level;
  slopes.holm = all.p_member;
  for (const statistics::MemberEstimate& one : estimates) {
    const double z2 =
        (one.value - all.mean) * (one.value - all.mean) / (one.variance + all.tau * all.tau);
    slopes.p.push_back(statistics::chi2_p_value(z2, 1));
  }
  return slopes;
}

/// Two families share the level: the slopes of all robots, and of those whose mean differs. That
/// slope and mean of a robot are independent makes the second one fair (Bourgon, Gentleman & Huber
/// 2010): to be far off says nothing of the slope.
constexpr double kFamilies = 2.0;

/// Returns whether there are drifts that were not there before.
bool find_drifts(FleetCoefficient& result, const Slopes& slopes, const std::vector<bool>& suspects,
                 double level, double tests) {
  std::vector<double> p;
  for (std::size_t k = 0; k < slopes.of.size(); ++k) {
    if (suspects[slopes.of[k]]) p.push_back(slopes.p[k]);
  }
  const std::vector<double> among = statistics::holm(p);
  bool any = false;
  std::size_t next = 0;
  for (std::size_t k = 0; k < slopes.of.size(); ++k) {
    FleetRobot& robot = result.members[slopes.of[k]];
    double least = slopes.holm[k];
    if (suspects[slopes.of[k]]) least = std::min(least, among[next++]);
    robot.p_drifts = statistics::bonferroni(least, kFamilies * tests);
    const bool drifts = robot.p_drifts < level;
    any = any || (drifts && !robot.drifts);
    robot.drifts = drifts;
  }
  return any;
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
  return dof > 0 ? 2.0 * statistics::student_p_value(z, dof) : statistics::chi2_p_value(z * z, 1);
}

struct Fitted {
  std::vector<std::size_t> of;  ///< members
  statistics::RandomEffects effects;
};

Fitted fitted(const std::vector<Line>& lines, const std::vector<bool>& drifts,
              const Grouping& grouping, double level) {
  Fitted result;
  std::vector<statistics::MemberEstimate> members;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (grouping.group[k] < 0) continue;
    members.push_back({drifts[k] ? lines[k].first : lines[k].mean,
                       drifts[k] ? lines[k].first_variance : lines[k].mean_variance,
                       static_cast<std::size_t>(grouping.group[k])});
    result.of.push_back(k);
  }
  result.effects = statistics::random_effects(members, grouping.values.size(), level);
  return result;
}

/// What the robots' values go with, and the robots by it.
struct KeyExplanation {
  std::vector<FleetKey> goes_with;  ///< at most one
  Grouping grouping;
  Fitted fit;
};

double outlying(const Fitted& fit) {
  return static_cast<double>(
      std::count(fit.effects.outlying.begin(), fit.effects.outlying.end(), true));
}

FleetKey key_of(const std::string& key, double p, const Grouping& by, const Fitted& fit,
                double tests) {
  FleetKey found{key, p, {}, {}};
  for (std::size_t g = 0; g < by.values.size(); ++g) {
    const statistics::GroupMean& group = fit.effects.groups[g];
    found.groups.push_back(
        {by.values[g], group.members, group.mean, group.sd,
         statistics::bonferroni(group.p_value, tests * static_cast<double>(by.values.size()))});
  }
  return found;
}

/// Of keys that both matter the one that leaves fewer robots that differ and the smaller spread.
KeyExplanation key_explanation(const FleetMembers& seen, const std::vector<Line>& lines,
                               const std::vector<bool>& drifts, double remainder, double level,
                               double tests) {
  const std::vector<bool> all(lines.size(), true);
  KeyExplanation best{{}, {{""}, std::vector<int>(lines.size(), 0)}, {}};
  best.fit = fitted(lines, drifts, best.grouping, level / tests);
  const double key_tests = tests * static_cast<double>(std::max<std::size_t>(1, seen.keys.size()));
  double best_p = 1.0;
  for (const std::string& key : seen.keys) {
    const Grouping by = grouping_by(key, seen, all);
    if (by.values.size() < 2) continue;
    const Fitted one = fitted(lines, drifts, by, level / tests);
    const double p = statistics::bonferroni(one.effects.p_groups, key_tests);
    const auto [least, most] =
        std::minmax_element(one.effects.groups.begin(), one.effects.groups.end(),
                            [](const statistics::GroupMean& a, const statistics::GroupMean& b) {
                              return a.mean < b.mean;
                            });
    if (!(p < level) || most->mean - least->mean < 2.0 * remainder) continue;
    if (!best.goes_with.empty() && by.group == best.grouping.group) {
      best.goes_with.front().same_as.push_back(key);
      continue;
    }
    const double out = outlying(one);
    const double had = outlying(best.fit);
    const bool better =
        best.goes_with.empty() || out < had ||
        (out == had && (p < best_p || (p == best_p && one.effects.tau < best.fit.effects.tau)));
    if (!better) continue;
    best = {{key_of(key, p, by, one, tests)}, by, one};
    best_p = p;
  }
  return best;
}

/// What a mean has to be beyond: of nearly every robot, the error that robots may have in common.
double remainder_of(const std::vector<Line>& lines) {
  std::vector<double> remainders;
  remainders.reserve(lines.size());
  for (const Line& one : lines) remainders.push_back(one.remainder);
  std::sort(remainders.begin(), remainders.end());
  return remainders[static_cast<std::size_t>(kMostRobots *
                                             static_cast<double>(remainders.size() - 1))];
}

void take_means(FleetCoefficient& result, const KeyExplanation& found, double remainder,
                double level, double tests) {
  const statistics::RandomEffects& effects = found.fit.effects;
  result.goes_with = found.goes_with;
  result.mean = effects.mean;
  result.sd = effects.sd;
  result.p_common =
      statistics::bonferroni(p_beyond(effects.mean, effects.sd, remainder, effects.Q_dof), tests);
  result.common = result.p_common < level;
  if (!result.goes_with.empty()) {
    const std::vector<FleetGroup>& groups = result.goes_with.front().groups;
    result.common = std::all_of(groups.begin(), groups.end(), [&](const FleetGroup& one) {
      return one.p_value < level && (one.mean > 0.0) == (groups.front().mean > 0.0);
    });
  }
  result.tau = effects.tau;
  result.p_tau = statistics::bonferroni(effects.p_tau, tests);
  result.Q = effects.Q;
  result.Q_dof = effects.Q_dof;
}

void take_robots(FleetCoefficient& result, const KeyExplanation& found,
                 const std::vector<Line>& lines, double tests) {
  const statistics::RandomEffects& effects = found.fit.effects;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    FleetRobot& robot = result.members[k];
    robot.value = robot.drifts ? lines[k].first : lines[k].mean;
    robot.sd = std::sqrt(robot.drifts ? lines[k].first_variance : lines[k].mean_variance);
    robot.shrunken = robot.value;
    robot.shrunken_sd = robot.sd;
  }
  for (std::size_t at = 0; at < found.fit.of.size(); ++at) {
    const std::size_t k = found.fit.of[at];
    FleetRobot& robot = result.members[k];
    robot.p_differs = statistics::bonferroni(effects.p_member[at], tests);
    robot.differs = effects.outlying[at];
    if (robot.differs) continue;
    const statistics::GroupMean& group =
        effects.groups[static_cast<std::size_t>(found.grouping.group[k])];
    const double tau2 = effects.tau * effects.tau;
    const double share = tau2 / (tau2 + robot.sd * robot.sd);
    robot.shrunken = group.mean + share * (robot.value - group.mean);
    robot.shrunken_sd = std::sqrt(share * robot.sd * robot.sd +
                                  (1.0 - share) * (1.0 - share) * group.sd * group.sd);
  }
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
  FleetMembers seen{{}, fleet.keys};
  for (const FleetMember& member : fleet.members) {
    const Line line = line_of(member, days);
    if (line.days == 0) continue;
    seen.members.push_back(member);
    lines.push_back(line);
    result.members.push_back({member.robot, line.days});
  }
  result.robots = static_cast<int>(lines.size());
  if (lines.empty()) return result;
  widen(lines);
  const double remainder = remainder_of(lines);
  const Slopes slopes = slopes_of(result, lines, level, tests);
  std::vector<bool> suspects(lines.size(), false);
  find_drifts(result, slopes, suspects, level, tests);
  for (;;) {
    std::vector<bool> drifts;
    for (const FleetRobot& one : result.members) drifts.push_back(one.drifts);
    const KeyExplanation found = key_explanation(seen, lines, drifts, remainder, level, tests);
    for (std::size_t at = 0; at < found.fit.of.size(); ++at) {
      if (found.fit.effects.outlying[at]) suspects[found.fit.of[at]] = true;
    }
    if (find_drifts(result, slopes, suspects, level, tests)) continue;
    take_means(result, found, remainder, level, tests);
    take_robots(result, found, lines, tests);
    return result;
  }
}

}  // namespace trussmap::fleet
