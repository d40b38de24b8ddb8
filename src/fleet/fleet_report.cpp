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
#include <stdexcept>

#include <fmt/format.h>

namespace trussmap {
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
  return std::max(0.0, g.dot(DenseLdlt(S).solve(g)));
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

class FleetSearch {
 public:
  FleetSearch(const std::vector<FleetRow>& rows, double level)
      : fleet_(fleet_sums(rows)), members_(fleet_members(rows)), level_(level) {
    for (std::size_t k = 0; k < fleet_.blocks.size(); ++k) {
      if (fleet_.blocks[k].of_model) model_.push_back(k);
    }
    ground_ = conditioned(model_);
    candidates_ = fleet_.blocks.size() - model_.size();
  }

  void run(FleetReport& report) {
    select();
    const double tests = static_cast<double>(model_.size() + found_.size());
    for (const std::vector<std::size_t>* part : {&model_, &found_}) {
      for (const std::size_t block : *part) {
        report.findings.push_back(finding(block, tests));
      }
    }
    report.tests = pooled_tests(fleet_);
    report.keys = members_.keys;
    report.robots = members_.members.size();
  }

 private:
  [[nodiscard]] Conditioned conditioned(const std::vector<std::size_t>& blocks) const {
    Conditioned result{fleet_.rows, fleet_.all};
    for (const std::size_t k : blocks) result.sweep(fleet_.blocks[k].columns);
    return result;
  }

  /// The model's and all that is found but one.
  [[nodiscard]] std::vector<std::size_t> others(std::size_t block) const {
    std::vector<std::size_t> result;
    for (const std::vector<std::size_t>* part : {&model_, &found_}) {
      for (const std::size_t one : *part) {
        if (one != block) result.push_back(one);
      }
    }
    return result;
  }

  /// Columns of a block that a row shows.
  [[nodiscard]] std::vector<Eigen::Index> seen(const FleetBlock& block,
                                               const ColumnSums& row) const {
    std::vector<Eigen::Index> columns;
    const double phi = row.dispersion();
    for (const Eigen::Index k : block.columns) {
      if (fleet_.is_seen(row, k, phi)) columns.push_back(k);
    }
    return columns;
  }

  [[nodiscard]] static double score_in(const ColumnSums& sums,
                                       const std::vector<Eigen::Index>& columns) {
    if (columns.empty()) return 0.0;
    if (columns.size() == 1) {
      const Eigen::Index k = columns.front();
      return sums.g[k] * sums.g[k] / sums.S(k, k);
    }
    return score_of(sums.g(columns), sums.S(columns, columns));
  }

  [[nodiscard]] double found_in(const Conditioned& left, const FleetMember& member) const {
    double sum = 0.0;
    for (const std::size_t row : member.rows) {
      sum += (fleet_.rows[row].chi2 - left.rows[row].chi2) / left.rows[row].dispersion();
    }
    return std::max(0.0, sum);
  }

  /// What speaks for a candidate beside what is present in `left`.
  [[nodiscard]] Claim claim_of(std::size_t at, const Conditioned& left) const {
    const FleetBlock& block = fleet_.blocks[at];
    const double phi = left.all.dispersion();
    double found = 0.0;
    for (const FleetMember& member : members_.members) found += found_in(left, member);
    const PooledTest pooled = pooled_test(fleet_, left.all, block, phi);
    const double common = beyond(pooled.score / phi, found);
    double p = chi2_p_value(common, pooled.dof);
    double whole = 0.0;
    int whole_dof = 0;
    double gain = 0.0;
    const auto robots = static_cast<double>(members_.members.size());
    for (const FleetMember& member : members_.members) {
      double sum = 0.0;
      int dof = 0;
      Eigen::VectorXd g = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(block.columns.size()));
      Eigen::MatrixXd S = Eigen::MatrixXd::Zero(g.size(), g.size());
      for (const std::size_t row : member.rows) {
        const ColumnSums& one = left.rows[row];
        const std::vector<Eigen::Index> columns = seen(block, one);
        if (columns.empty()) continue;
        const double own = 1.0 / one.dispersion();
        sum += own * score_in(one, columns);
        dof += static_cast<int>(columns.size());
        g += own * one.g(block.columns);
        S += own * one.S(block.columns, block.columns);
      }
      if (dof == 0) continue;
      const double found_here = found_in(left, member);
      const double together = beyond(score_of(g, S), found_here);
      const double apart = beyond(sum, found_here);
      p = std::min(p, bonferroni(chi2_p_value(together, static_cast<int>(g.size())), robots));
      p = std::min(p, bonferroni(chi2_p_value(apart, dof), robots));
      whole += apart;
      whole_dof += dof;
      gain += std::max(0.0, apart - chi2_quantile(1.0 - level_ / robots, dof));
    }
    p = std::min(p, chi2_p_value(whole, whole_dof));
    return {at, bonferroni(p, kKinds * static_cast<double>(candidates_)), std::max(gain, common)};
  }

  void select() {
    Conditioned left = ground_;
    while (found_.size() < kMostFindings) {
      Claim best;
      for (std::size_t k = 0; k < fleet_.blocks.size(); ++k) {
        if (fleet_.blocks[k].of_model || std::find(found_.begin(), found_.end(), k) != found_.end())
          continue;
        const Claim one = claim_of(k, left);
        if (one.p_adjusted < level_ && one.gain > best.gain) best = one;
      }
      if (!(best.gain > 0.0)) break;
      found_.push_back(best.block);
      left.sweep(fleet_.blocks[best.block].columns);
    }
    eliminate();
    simplify();
  }

  [[nodiscard]] double worth_of(const std::vector<std::size_t>& blocks) const {
    std::vector<FleetBlock> effects;
    effects.reserve(blocks.size());
    for (const std::size_t block : blocks) effects.push_back(fleet_.blocks[block]);
    const double level = level_ / static_cast<double>(members_.members.size());
    double sum = 0.0;
    for (const FleetMember& member : members_.members) {
      std::vector<const ColumnSums*> days;
      for (const std::size_t row : member.rows) days.push_back(&ground_.rows[row]);
      sum += worth_of_effects(days, effects, level);
    }
    return sum;
  }

  /// Exchanges what is found for its look-alikes, as long as they explain more, or the same with
  /// fewer robots that need them.
  void simplify() {
    double most = worth_of(found_);
    for (bool better = true; better;) {
      better = false;
      for (std::size_t k = 0; k < found_.size(); ++k) {
        for (const std::size_t rival : rivals_of(found_[k], conditioned(others(found_[k])))) {
          if (std::find(found_.begin(), found_.end(), rival) != found_.end()) continue;
          std::vector<std::size_t> exchanged = found_;
          exchanged[k] = rival;
          const double worth = worth_of(exchanged);
          if (worth < most + kBetter) continue;
          most = worth;
          found_ = exchanged;
          better = true;
        }
      }
    }
  }

  void eliminate() {
    while (found_.size() > 1) {
      Claim weakest{0, 0.0, 0.0};
      for (const std::size_t block : found_) {
        const Claim one = claim_of(block, conditioned(others(block)));
        if (one.p_adjusted > weakest.p_adjusted) weakest = one;
      }
      if (weakest.p_adjusted < level_) return;
      std::erase(found_, weakest.block);
    }
  }

  [[nodiscard]] FleetFinding finding(std::size_t at, double tests) const {
    const FleetBlock& block = fleet_.blocks[at];
    const Conditioned left = conditioned(others(at));
    FleetFinding result;
    result.of_model = block.of_model;
    result.effect = block.effect;
    result.channel = block.channel;
    if (!block.of_model) result.p_adjusted = claim_of(at, left).p_adjusted;
    std::vector<std::vector<DayEstimate>> days(block.columns.size(),
                                               std::vector<DayEstimate>(left.rows.size()));
    for (const FleetMember& member : members_.members) {
      // Of the other findings a second order is left here, too.
      const double found_here = kRemainder * kRemainder * found_in(left, member);
      const double rest = 1.0 + found_here;
      for (const std::size_t row : member.rows) {
        const ColumnSums& one = left.rows[row];
        const std::vector<Eigen::Index> columns = seen(block, one);
        if (columns.size() != block.columns.size()) continue;
        ColumnSums after = one;
        after.sweep(columns);
        const Eigen::MatrixXd C = DenseLdlt(one.S(columns, columns)).inverse();
        const Eigen::VectorXd step = -C * one.g(columns);
        for (std::size_t k = 0; k < columns.size(); ++k) {
          const auto c = static_cast<Eigen::Index>(k);
          days[k][row] = {true, fleet_.reference[static_cast<std::size_t>(columns[k])] + step[c],
                          C(c, c) * after.dispersion() * rest, found_here / rest};
        }
      }
    }
    const double shared = tests * static_cast<double>(block.columns.size());
    for (std::size_t k = 0; k < block.columns.size(); ++k) {
      result.coefficients.push_back(analyse_coefficient(members_, days[k], level_, shared));
      result.coefficients.back().shape = block.shape[k];
    }
    result.look_alikes = look_alikes(at, left);
    return result;
  }

  /// |P v|/|v| of the trace v of what all robots together say; of the same number of shapes.
  [[nodiscard]] double cosine(const FleetBlock& block, const FleetBlock& rival,
                              const Conditioned& left) const {
    const Eigen::MatrixXd S = left.all.S(block.columns, block.columns);
    const Eigen::VectorXd v = DenseLdlt(S).solve(left.all.g(block.columns));
    const double length = v.dot(S * v);
    const Eigen::MatrixXd R = left.all.S(rival.columns, rival.columns);
    if (!(length > 0.0) || !(R.diagonal().maxCoeff() > 0.0)) return 0.0;
    const Eigen::VectorXd c = left.all.S(rival.columns, block.columns) * v;
    return std::min(1.0, std::sqrt(score_of(c, R) / length));
  }

  [[nodiscard]] std::vector<std::size_t> rivals_of(std::size_t at, const Conditioned& left) const {
    std::vector<std::size_t> rivals;
    for (std::size_t k = 0; k < fleet_.blocks.size(); ++k) {
      if (k == at || fleet_.blocks[k].of_model) continue;
      if (cosine(fleet_.blocks[at], fleet_.blocks[k], left) >= kLeastCosine) rivals.push_back(k);
    }
    return rivals;
  }

  [[nodiscard]] std::vector<FleetLookAlike> look_alikes(std::size_t at,
                                                        const Conditioned& left) const {
    std::vector<FleetLookAlike> alike;
    for (const std::size_t k : rivals_of(at, left)) {
      alike.push_back({fleet_.blocks[k].effect, cosine(fleet_.blocks[at], fleet_.blocks[k], left)});
    }
    std::stable_sort(
        alike.begin(), alike.end(),
        [](const FleetLookAlike& a, const FleetLookAlike& b) { return a.cosine > b.cosine; });
    return alike;
  }

  FleetSums fleet_;
  FleetMembers members_;
  double level_;
  std::vector<std::size_t> model_;
  std::vector<std::size_t> found_;
  Conditioned ground_;
  std::size_t candidates_ = 0;
};

}  // namespace

FleetReport fleet_report(std::vector<FleetRow> rows, double level) {
  if (!(level > 0.0 && level < 1.0)) throw std::invalid_argument("a level is between 0 and 1");
  std::sort(rows.begin(), rows.end(), [](const FleetRow& a, const FleetRow& b) {
    return std::tie(a.robot, a.date) < std::tie(b.robot, b.date);
  });
  FleetReport report;
  report.level = level;
  report.days = rows.size();
  std::map<std::string, std::pair<double, int>> squares;
  for (const FleetRow& row : rows) {
    report.chi2 += row.chi2;
    report.dof += row.dof;
    auto& [sum, legs] = squares[row.robot];
    sum += row.held_out_legs * row.held_out_rms * row.held_out_rms;
    legs += row.held_out_legs;
  }
  for (const auto& [robot, sum] : squares) {
    report.held_out_rms[robot] = sum.second > 0 ? std::sqrt(sum.first / sum.second) : 0.0;
  }
  FleetSearch(rows, level).run(report);
  report.notes.emplace_back(
      "effects with a fitted place or threshold differ from robot to robot: they do not pool, and "
      "are not among the candidates");
  return report;
}

}  // namespace trussmap
