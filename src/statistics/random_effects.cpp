// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "statistics/random_effects.hpp"

#include "statistics/distributions.hpp"
#include "statistics/median.hpp"
#include "statistics/multiple_tests.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::statistics {
namespace {

constexpr double kMadToSd = 1.4826;
constexpr double kMostOutlying = 0.2;  // of the members
constexpr int kRounds = 30;

using Members = std::vector<MemberEstimate>;

struct Sums {
  std::vector<double> weight;
  std::vector<double> mean;
  std::vector<int> count;
  double misfit = 0.0;    ///< sum w (y - mu)^2
  double log_sum = 0.0;   ///< sum log(s^2 + tau^2)
  double log_info = 0.0;  ///< sum over groups of log W
  int dof = 0;
};

Sums sums_of(const Members& members, const std::vector<bool>& out, std::size_t groups,
             double tau2) {
  Sums s{std::vector<double>(groups), std::vector<double>(groups), std::vector<int>(groups)};
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (out[i]) continue;
    const double w = 1.0 / (members[i].variance + tau2);
    s.weight[members[i].group] += w;
    s.mean[members[i].group] += w * members[i].value;
    ++s.count[members[i].group];
    s.log_sum -= std::log(w);
    ++s.dof;
  }
  for (std::size_t g = 0; g < groups; ++g) {
    if (s.count[g] == 0) continue;
    s.mean[g] /= s.weight[g];
    s.log_info += std::log(s.weight[g]);
    --s.dof;
  }
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (out[i]) continue;
    const double off = members[i].value - s.mean[members[i].group];
    s.misfit += off * off / (members[i].variance + tau2);
  }
  return s;
}

double log_likelihood(const Sums& s) {
  return -0.5 * (s.log_sum + s.log_info + s.misfit);
}

/// tau^2 of the greatest restricted likelihood: the best of a grid, then golden section.
double reml_variance(const Members& members, const std::vector<bool>& out, std::size_t groups) {
  const auto at = [&](double tau2) { return log_likelihood(sums_of(members, out, groups, tau2)); };
  double least = 1e300;
  for (const MemberEstimate& one : members) least = std::min(least, one.variance);
  double spread = 0.0;
  const Sums plain = sums_of(members, out, groups, 0.0);
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (out[i]) continue;
    spread = std::max(spread, std::abs(members[i].value - plain.mean[members[i].group]));
  }
  if (plain.dof < 1 || spread == 0.0) return 0.0;
  const double low = std::log(1e-4 * least);
  const double high = std::max(low + 1.0, 2.0 * std::log(2.0 * spread));
  constexpr int kGrid = 40;
  const double step = (high - low) / kGrid;
  double best = low;
  double most = -1e300;
  for (int k = 0; k <= kGrid; ++k) {
    const double value = at(std::exp(low + k * step));
    if (value > most) {
      most = value;
      best = low + k * step;
    }
  }
  constexpr double kGolden = 0.6180339887498949;
  double a = best - step;
  double b = best + step;
  for (int k = 0; k < 60; ++k) {
    const double left = b - kGolden * (b - a);
    const double right = a + kGolden * (b - a);
    (at(std::exp(left)) > at(std::exp(right)) ? b : a) =
        at(std::exp(left)) > at(std::exp(right)) ? right : left;
  }
  const double tau2 = std::exp(0.5 * (a + b));
  return at(tau2) > at(0.0) + 1e-9 ? tau2 : 0.0;
}

struct Centre {
  std::vector<double> mean;
  double tau2 = 0.0;
};

Centre robust_centre(const Members& members, std::size_t groups) {
  Centre result{std::vector<double>(groups)};
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<double> values;
    for (const MemberEstimate& one : members) {
      if (one.group == g) values.push_back(one.value);
    }
    if (!values.empty()) result.mean[g] = median(values);
  }
  std::vector<double> off;
  std::vector<double> variances;
  for (const MemberEstimate& one : members) {
    off.push_back(std::abs(one.value - result.mean[one.group]));
    variances.push_back(one.variance);
  }
  const double sd = kMadToSd * median(off);
  result.tau2 = std::max(0.0, sd * sd - median(variances));
  return result;
}

std::vector<double> member_p_values(const Members& members, const Centre& centre) {
  std::vector<double> p;
  p.reserve(members.size());
  for (const MemberEstimate& one : members) {
    const double z = (one.value - centre.mean[one.group]) / std::sqrt(one.variance + centre.tau2);
    p.push_back(chi2_p_value(z * z, 1));
  }
  return holm(p);
}

}  // namespace

RandomEffects random_effects(const std::vector<MemberEstimate>& members, std::size_t groups,
                             double level) {
  RandomEffects result;
  std::vector<bool> out(members.size(), false);
  Centre centre = robust_centre(members, groups);
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<double> p = member_p_values(members, centre);
    std::vector<bool> now(members.size());
    for (std::size_t i = 0; i < p.size(); ++i) now[i] = p[i] < level;
    const auto count = static_cast<double>(std::count(now.begin(), now.end(), true));
    const bool too_many = count > kMostOutlying * static_cast<double>(members.size());
    if (too_many) now.assign(members.size(), false);
    if (round > 0 && now == out) break;
    out = now;
    centre.tau2 = reml_variance(members, out, groups);
    centre.mean = sums_of(members, out, groups, centre.tau2).mean;
    if (too_many) break;
  }
  result.p_member = member_p_values(members, centre);
  result.outlying = out;
  const Sums plain = sums_of(members, out, groups, 0.0);
  const Sums s = sums_of(members, out, groups, centre.tau2);
  result.tau = std::sqrt(centre.tau2);
  const double ratio = 2.0 * (log_likelihood(s) - log_likelihood(plain));
  result.p_tau = ratio > 0.0 ? 0.5 * chi2_p_value(ratio, 1) : 1.0;
  result.Q = plain.misfit;
  result.Q_dof = plain.dof;
  const double q = s.dof > 0 ? std::max(1.0, s.misfit / s.dof) : 1.0;
  const auto p_of = [](double mean, double sd, int dof) {
    return dof > 0 ? 2.0 * student_p_value(std::abs(mean) / sd, dof)
                   : chi2_p_value(mean * mean / (sd * sd), 1);
  };
  double weight = 0.0;
  for (std::size_t g = 0; g < groups; ++g) {
    GroupMean one{s.count[g], s.mean[g], s.count[g] > 0 ? std::sqrt(q / s.weight[g]) : 0.0};
    if (one.members > 0) one.p_value = p_of(one.mean, one.sd, s.dof);
    weight += s.weight[g];
    result.mean += s.weight[g] * s.mean[g];
    result.groups.push_back(one);
  }
  result.mean /= weight;
  double between = 0.0;
  int there = 0;
  for (std::size_t g = 0; g < groups; ++g) {
    if (s.count[g] == 0) continue;
    between += s.weight[g] * (s.mean[g] - result.mean) * (s.mean[g] - result.mean);
    ++there;
  }
  result.sd = std::sqrt(q / weight);
  result.p_mean = p_of(result.mean, result.sd, s.dof);
  if (there > 1 && s.dof > 0) {
    result.p_groups = fisher_p_value(between / (there - 1) / q, there - 1, s.dof);
  }
  return result;
}

}  // namespace trussmap::statistics
