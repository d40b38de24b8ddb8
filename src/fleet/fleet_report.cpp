// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Forward selection over the fleet, each candidate conditioned on what is found, robot by robot,
// and backward elimination of what the others explain; then each finding's robots.
#include "fleet/pooled_sums.hpp"
#include "fleet/robot_estimates.hpp"
#include "fleet/worth_of_effects.hpp"
#include "linalg/dense.hpp"
#include "statistics/distributions.hpp"
#include "statistics/multiple_tests.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace fleet;

namespace {

constexpr std::size_t kMostFindings = 8;
constexpr double kLeastCosine = 0.95;
/// Of what is found, in standard deviations, the share that its second order may leave elsewhere.
constexpr double kRemainder = 0.1;
/// Chi^2 by which an exchange has to be better: what is less is rounding.
constexpr double kBetter = 1e-3;
/// Tests per candidate: all robots alike, robots as a whole, one robot, one robot's slope.
constexpr double kKinds = 4.0;

double score_of(const Eigen::VectorXd& g, const Eigen::MatrixXd& S) {
  return std::max(0.0, g.dot(linalg::DenseLdlt(S).solve(g)));
}

/// What is beyond the remainder of `found`.
double beyond(double score, double found) {
  const double z = std::sqrt(score) - kRemainder * std::sqrt(std::max(0.0, found));
  return z > 0.0 ? z * z : 0.0;
}

/// All rows and their sum, with the same columns taken as present.
struct Conditioned {
  std::vector<ColumnSums> rows;
  ColumnSums all;

  void sweep(const std::vector<Eigen::Index>& columns) {
    for (ColumnSums& one : rows) one.sweep(columns);
    all.sweep(columns);
  }
};

struct Claim {
  std::size_t block = 0;
  double p_adjusted = 1.0;
  double gain = 0.0;
};

using Blocks = std::vector<std::size_t>;  // of FleetSums

/// What is searched.
struct SearchedFleet {
  FleetSums sums;
  FleetMembers members;
  double level = 0.0;
  Blocks model;
  Conditioned ground;  ///< the model's swept
  double candidates = 0.0;
};

Conditioned conditioned(const FleetSums& sums, const Blocks& blocks) {
  Conditioned result{sums.rows, sums.all};
  for (const std::size_t k : blocks) result.sweep(sums.blocks[k].columns);
  return result;
}

SearchedFleet searched_fleet(const std::vector<FleetRow>& rows, double level) {
  SearchedFleet fleet{fleet_sums(rows), fleet_members(rows), level, {}, {}, 0.0};
  for (std::size_t k = 0; k < fleet.sums.blocks.size(); ++k) {
    if (fleet.sums.blocks[k].of_model) fleet.model.push_back(k);
  }
  fleet.ground = conditioned(fleet.sums, fleet.model);
  fleet.candidates = static_cast<double>(fleet.sums.blocks.size() - fleet.model.size());
  return fleet;
}

bool contains(const Blocks& blocks, std::size_t block) {
  return std::find(blocks.begin(), blocks.end(), block) != blocks.end();
}

/// The model's and all that is found swept, but one.
Conditioned without(std::size_t block, const SearchedFleet& fleet, const Blocks& found) {
  Blocks others;
  for (const Blocks* part : {&fleet.model, &found}) {
    for (const std::size_t one : *part) {
      if (one != block) others.push_back(one);
    }
  }
  return conditioned(fleet.sums, others);
}

/// Columns of a block that a row shows.
std::vector<Eigen::Index> seen(const FleetSums& sums, const FleetBlock& block,
                               const ColumnSums& row) {
  std::vector<Eigen::Index> columns;
  const double phi = row.dispersion();
  for (const Eigen::Index k : block.columns) {
    if (sums.is_seen(row, k, phi)) columns.push_back(k);
  }
  return columns;
}

double score_in(const ColumnSums& sums, const std::vector<Eigen::Index>& columns) {
  if (columns.empty()) return 0.0;
  if (columns.size() == 1) {
    const Eigen::Index k = columns.front();
    return sums.g[k] * sums.g[k] / sums.S(k, k);
  }
  return score_of(sums.g(columns), sums.S(columns, columns));
}

double found_in(const FleetSums& sums, const Conditioned& left, const FleetMember& member) {
  double sum = 0.0;
  for (const std::size_t row : member.rows) {
    sum += (sums.rows[row].chi2 - left.rows[row].chi2) / left.rows[row].dispersion();
  }
  return std::max(0.0, sum);
}

/// What one robot says of a candidate, beyond what is found.
struct MemberClaim {
  double together = 0.0;  ///< score of one size on all days
  double apart = 0.0;     ///< of each day's own
  int sizes = 0;          ///< degrees of freedom
  int dof = 0;            ///< likewise, of all days; 0: none shows it
};

MemberClaim claim_of_member(const FleetSums& sums, const FleetBlock& block,
                            const FleetMember& member, const Conditioned& left) {
  MemberClaim claim;
  double sum = 0.0;
  Eigen::VectorXd g = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(block.columns.size()));
  Eigen::MatrixXd S = Eigen::MatrixXd::Zero(g.size(), g.size());
  for (const std::size_t row : member.rows) {
    const ColumnSums& one = left.rows[row];
    const std::vector<Eigen::Index> columns = seen(sums, block, one);
    if (columns.empty()) continue;
    const double own = 1.0 / one.dispersion();
    sum += own * score_in(one, columns);
    claim.dof += static_cast<int>(columns.size());
    g += own * one.g(block.columns);
    S += own * one.S(block.columns, block.columns);
  }
  if (claim.dof == 0) return claim;
  const double found_here = found_in(sums, left, member);
  claim.together = beyond(score_of(g, S), found_here);
  claim.apart = beyond(sum, found_here);
  claim.sizes = static_cast<int>(g.size());
  return claim;
}

/// What speaks for a candidate beside what is present in `left`.
Claim claim_of(std::size_t at, const Conditioned& left, const SearchedFleet& fleet) {
  const FleetBlock& block = fleet.sums.blocks[at];
  const std::vector<FleetMember>& members = fleet.members.members;
  const auto robots = static_cast<double>(members.size());
  const double phi = left.all.dispersion();
  double found = 0.0;
  for (const FleetMember& member : members) found += found_in(fleet.sums, left, member);
  const PooledTest pooled = pooled_test(fleet.sums, left.all, block, phi);
  const double common = beyond(pooled.score / phi, found);
  double p = statistics::chi2_p_value(common, pooled.dof);
  double whole = 0.0;
  int whole_dof = 0;
  double gain = 0.0;
  for (const FleetMember& member : members) {
    const MemberClaim one = claim_of_member(fleet.sums, block, member, left);
    if (one.dof == 0) continue;
    p = std::min(p,
                 statistics::bonferroni(statistics::chi2_p_value(one.together, one.sizes), robots));
    p = std::min(p, statistics::bonferroni(statistics::chi2_p_value(one.apart, one.dof), robots));
    whole += one.apart;
    whole_dof += one.dof;
    gain +=
        std::max(0.0, one.apart - statistics::chi2_quantile(1.0 - fleet.level / robots, one.dof));
  }
  p = std::min(p, statistics::chi2_p_value(whole, whole_dof));
  return {at, statistics::bonferroni(p, kKinds * fleet.candidates), std::max(gain, common)};
}

Blocks selected(const SearchedFleet& fleet) {
  Blocks found;
  Conditioned left = fleet.ground;
  while (found.size() < kMostFindings) {
    Claim best;
    for (std::size_t k = 0; k < fleet.sums.blocks.size(); ++k) {
      if (fleet.sums.blocks[k].of_model || contains(found, k)) continue;
      const Claim one = claim_of(k, left, fleet);
      if (one.p_adjusted < fleet.level && one.gain > best.gain) best = one;
    }
    if (!(best.gain > 0.0)) break;
    found.push_back(best.block);
    left.sweep(fleet.sums.blocks[best.block].columns);
  }
  return found;
}

/// Less what the others explain.
Blocks eliminated(Blocks found, const SearchedFleet& fleet) {
  while (found.size() > 1) {
    Claim weakest{0, 0.0, 0.0};
    for (const std::size_t block : found) {
      const Claim one = claim_of(block, without(block, fleet, found), fleet);
      if (one.p_adjusted > weakest.p_adjusted) weakest = one;
    }
    if (weakest.p_adjusted < fleet.level) break;
    std::erase(found, weakest.block);
  }
  return found;
}

double worth_of(const Blocks& blocks, const SearchedFleet& fleet) {
  std::vector<FleetBlock> effects;
  effects.reserve(blocks.size());
  for (const std::size_t block : blocks) effects.push_back(fleet.sums.blocks[block]);
  const double level = fleet.level / static_cast<double>(fleet.members.members.size());
  double sum = 0.0;
  for (const FleetMember& member : fleet.members.members) {
    std::vector<const ColumnSums*> days;
    for (const std::size_t row : member.rows) days.push_back(&fleet.ground.rows[row]);
    sum += worth_of_effects(days, effects, level);
  }
  return sum;
}

/// |P v|/|v| of the trace v of what all robots together say; of the same number of shapes.
double cosine(const FleetBlock& block, const FleetBlock& rival, const Conditioned& left) {
  const Eigen::MatrixXd S = left.all.S(block.columns, block.columns);
  const Eigen::VectorXd v = linalg::DenseLdlt(S).solve(left.all.g(block.columns));
  const double length = v.dot(S * v);
  const Eigen::MatrixXd R = left.all.S(rival.columns, rival.columns);
  if (!(length > 0.0) || !(R.diagonal().maxCoeff() > 0.0)) return 0.0;
  const Eigen::VectorXd c = left.all.S(rival.columns, block.columns) * v;
  return std::min(1.0, std::sqrt(score_of(c, R) / length));
}

struct Rival {
  std::size_t block = 0;
  double cosine = 0.0;
};

std::vector<Rival> rivals_of(std::size_t at, const FleetSums& sums, const Conditioned& left) {
  std::vector<Rival> rivals;
  for (std::size_t k = 0; k < sums.blocks.size(); ++k) {
    if (k == at || sums.blocks[k].of_model) continue;
    const double alike = cosine(sums.blocks[at], sums.blocks[k], left);
    if (alike >= kLeastCosine) rivals.push_back({k, alike});
  }
  return rivals;
}

/// Exchanges what is found for its look-alikes, as long as they explain more, or the same with
/// fewer robots that need them.
Blocks simplified(Blocks found, const SearchedFleet& fleet) {
  double most = worth_of(found, fleet);
  for (bool better = true; better;) {
    better = false;
    for (std::size_t k = 0; k < found.size(); ++k) {
      const Conditioned left = without(found[k], fleet, found);
      for (const Rival& rival : rivals_of(found[k], fleet.sums, left)) {
        if (contains(found, rival.block)) continue;
        Blocks exchanged = found;
        exchanged[k] = rival.block;
        const double worth = worth_of(exchanged, fleet);
        if (worth < most + kBetter) continue;
        most = worth;
        found = exchanged;
        better = true;
      }
    }
  }
  return found;
}

/// Of each of the block's coefficients, per row.
std::vector<std::vector<DayEstimate>> estimates_of(const FleetBlock& block, const Conditioned& left,
                                                   const SearchedFleet& fleet) {
  std::vector<std::vector<DayEstimate>> days(block.columns.size(),
                                             std::vector<DayEstimate>(left.rows.size()));
  for (const FleetMember& member : fleet.members.members) {
    // Of the other findings a second order is left here, too.
    const double found_here = kRemainder * kRemainder * found_in(fleet.sums, left, member);
    const double rest = 1.0 + found_here;
    for (const std::size_t row : member.rows) {
      const ColumnSums& one = left.rows[row];
      const std::vector<Eigen::Index> columns = seen(fleet.sums, block, one);
      if (columns.size() != block.columns.size()) continue;
      ColumnSums after = one;
      after.sweep(columns);
      const Eigen::MatrixXd C = linalg::DenseLdlt(one.S(columns, columns)).inverse();
      const Eigen::VectorXd step = -C * one.g(columns);
      for (std::size_t k = 0; k < columns.size(); ++k) {
        const auto c = static_cast<Eigen::Index>(k);
        const double reference = fleet.sums.reference[static_cast<std::size_t>(columns[k])];
        days[k][row] = {true, reference + step[c], C(c, c) * after.dispersion() * rest,
                        found_here / rest};
      }
    }
  }
  return days;
}

std::vector<FleetLookAlike> look_alikes(std::size_t at, const FleetSums& sums,
                                        const Conditioned& left) {
  std::vector<FleetLookAlike> alike;
  for (const Rival& one : rivals_of(at, sums, left)) {
    alike.push_back({sums.blocks[one.block].effect, one.cosine});
  }
  std::stable_sort(
      alike.begin(), alike.end(),
      [](const FleetLookAlike& a, const FleetLookAlike& b) { return a.cosine > b.cosine; });
  return alike;
}

/// `tests`: the findings that share the level.
FleetFinding finding_of(std::size_t at, const SearchedFleet& fleet, const Blocks& found,
                        double tests) {
  const FleetBlock& block = fleet.sums.blocks[at];
  const Conditioned left = without(at, fleet, found);
  FleetFinding result;
  result.of_model = block.of_model;
  result.effect = block.effect;
  result.channel = block.channel;
  if (!block.of_model) result.p_adjusted = claim_of(at, left, fleet).p_adjusted;
  const std::vector<std::vector<DayEstimate>> days = estimates_of(block, left, fleet);
  const double shared = tests * static_cast<double>(block.columns.size());
  for (std::size_t k = 0; k < block.columns.size(); ++k) {
    result.coefficients.push_back(analyse_coefficient(fleet.members, days[k], fleet.level, shared));
    result.coefficients.back().shape = block.shape[k];
  }
  result.look_alikes = look_alikes(at, fleet.sums, left);
  return result;
}

std::vector<FleetFinding> findings_of(const SearchedFleet& fleet) {
  const Blocks found = simplified(eliminated(selected(fleet), fleet), fleet);
  const double tests = static_cast<double>(fleet.model.size() + found.size());
  std::vector<FleetFinding> findings;
  for (const Blocks* part : {&fleet.model, &found}) {
    for (const std::size_t block : *part) {
      findings.push_back(finding_of(block, fleet, found, tests));
    }
  }
  return findings;
}

/// Over all days of each robot, m.
std::map<std::string, double> held_out_rms_of(const std::vector<FleetRow>& rows) {
  std::map<std::string, std::pair<double, int>> squares;
  for (const FleetRow& row : rows) {
    auto& [sum, legs] = squares[row.robot];
    sum += row.held_out_legs * row.held_out_rms * row.held_out_rms;
    legs += row.held_out_legs;
  }
  std::map<std::string, double> result;
  for (const auto& [robot, sum] : squares) {
    result[robot] = sum.second > 0 ? std::sqrt(sum.first / sum.second) : 0.0;
  }
  return result;
}

}  // namespace

FleetReport fleet_report(std::vector<FleetRow> rows, double level) {
  if (!(level > 0.0 && level < 1.0)) throw std::invalid_argument("a level is between 0 and 1");
  std::sort(rows.begin(), rows.end(), [](const FleetRow& a, const FleetRow& b) {
    return std::tie(a.robot, a.date) < std::tie(b.robot, b.date);
  });
  FleetReport report;
  report.level = level;
  report.days = rows.size();
  for (const FleetRow& row : rows) {
    report.chi2 += row.chi2;
    report.dof += row.dof;
  }
  report.held_out_rms = held_out_rms_of(rows);
  const SearchedFleet fleet = searched_fleet(rows, level);
  report.findings = findings_of(fleet);
  report.tests = pooled_tests(fleet.sums);
  report.keys = fleet.members.keys;
  report.robots = fleet.members.members.size();
  report.notes.emplace_back(
      "effects with a fitted place or threshold differ from robot to robot: they do not pool, and "
      "are not among the candidates");
  return report;
}

}  // namespace trussmap
