// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "check/graph_loops.hpp"

#include "geometry/index.hpp"
#include "pose_graph/pose_graph_descent.hpp"
#include "pose_graph/pose_graph_gauge.hpp"
#include "statistics/median.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace trussmap::check {
namespace {

constexpr double kMedianOfThree = 2.366;  // chi^2 of three values
// A fit suits each loop better than the truth would: the median is low by so much, or less.
constexpr double kTooGood = 3.0;
constexpr double kGate = 16.27;        // that one of a thousand exceeds
constexpr double kFarOut = 30.0;       // that one of a million exceeds
constexpr double kClear = 25.0;        // what reversing takes off, in s^2
constexpr double kRatherBetter = 9.0;  // the same where others are clear
constexpr double kNearlyAll = 0.8;     // share of the misfit that is to be explained
constexpr double kLogRatio = 7.0;      // log likelihood ratio where the scale is not known
constexpr double kOne = 0.4;           // of the logarithm of chi^2 per degree of freedom
constexpr double kNoNoise = 1e-12;     // of chi^2, below which all is rounding
constexpr int kMostRounds = 25;
constexpr double kCooling = 2.5;  // of s^2, a round
constexpr int kLeastRounds = 5;
constexpr int kMostRefits = 3;
constexpr std::size_t kFewLoops = 8;
constexpr linalg::DescentOptions kRound{2, 1e-4};

using Squares = std::vector<double>;

PoseEdge turned_round(PoseEdge edge) {
  std::swap(edge.from, edge.to);
  return edge;
}

PoseGraph with_reversed(PoseGraph graph, const std::vector<int>& edges) {
  for (const int k : edges) graph.pose_edges[idx(k)] = turned_round(graph.pose_edges[idx(k)]);
  return graph;
}

double square_of(const PoseEdge& edge, const std::vector<Pose>& estimates) {
  const Eigen::Vector3d e = edge_error(edge, estimates[idx(edge.from)], estimates[idx(edge.to)]);
  return e.dot(edge.information * e);
}

/// s^2 of a fit: by the median of its loops, which wrong ones do not move.
double scale_of(const PoseGraph& graph, const std::vector<int>& loops, const GraphFit& fit) {
  const double whole = fit.dof > 0 ? fit.per_dof() : 0.0;
  if (loops.size() < kFewLoops) return whole;
  Squares squares;
  for (const int k : loops) squares.push_back(square_of(graph.pose_edges[idx(k)], fit.estimates));
  return std::min(whole, statistics::median(squares) / kMedianOfThree);
}

/// What lies outside the gate, of all pose edges together: Gaussian noise has next to none.
double misfit_of(const PoseGraph& graph, const GraphFit& fit, double scale) {
  double sum = 0.0;
  for (const double square : squared_errors(graph, fit.estimates)) {
    sum += std::max(0.0, square - kGate * scale);
  }
  return sum;
}

/// Whether a graph with edges reversed is so much better that chance does not make it so.
bool reversal_explains(const PoseGraph& graph, const GraphFit& as_given, const PoseGraph& reversed,
                       const GraphFit& fit, const std::vector<int>& loops, bool trusted) {
  const double floor = kNoNoise * as_given.chi2;
  if (!(fit.chi2 < as_given.chi2) || as_given.chi2 <= 0.0) return false;
  const double scale = std::max(scale_of(reversed, loops, fit), floor);
  const double ratio = as_given.chi2 / std::max(fit.chi2, floor);
  const double misfit = misfit_of(graph, as_given, scale);
  const double left = misfit_of(reversed, fit, scale);
  const double gain = as_given.chi2 - fit.chi2;
  const bool by_scale = trusted && fit.chi2 < 3.0 * fit.dof && gain > 20.0 && ratio > 6.0;
  const bool by_ratio = 0.5 * fit.dof * std::log(ratio) > kLogRatio && ratio > 2.0;
  const bool by_edges = loops.size() >= kFewLoops && misfit > 4.0 * kClear * scale;
  const bool by_chi2 =
      trusted && std::abs(std::log(std::max(fit.per_dof(), 1e-9))) < kOne && gain > 2.0 * kClear;
  if (!by_scale && !by_ratio && !by_edges && !by_chi2) return false;
  const double noise = by_chi2 ? fit.dof + 2.0 * std::sqrt(2.0 * fit.dof) : scale * fit.dof;
  const double explained = by_edges && !by_chi2 && misfit > 0.0
                               ? 1.0 - left / misfit
                               : gain / std::max(as_given.chi2 - noise, floor);
  return explained > kNearlyAll;
}

/// Whether there is anything that reversing could explain.
bool leaves_misfit(const PoseGraph& graph, const std::vector<int>& loops, const GraphFit& fit,
                   bool trusted) {
  if (!trusted || fit.chi2 > 1.5 * fit.dof || fit.chi2 < 0.3 * fit.dof) return true;
  const double scale = scale_of(graph, loops, fit);
  return std::any_of(loops.begin(), loops.end(), [&](int k) {
    return square_of(graph.pose_edges[idx(k)], fit.estimates) > kFarOut * scale;
  });
}

/// The loops that fit better the other way round than `graph` has them by `margin` s^2; none where
/// none is clear.
std::vector<int> better_reversed(const PoseGraph& graph, const std::vector<int>& loops,
                                 double margin, const std::vector<Pose>& estimates) {
  Squares squares;
  for (const int k : loops) {
    const PoseEdge& edge = graph.pose_edges[idx(k)];
    squares.push_back(
        std::min(square_of(edge, estimates), square_of(turned_round(edge), estimates)));
  }
  const double scale = kTooGood * statistics::median(squares) / kMedianOfThree;
  std::vector<int> edges;
  double most = 0.0;
  for (const int k : loops) {
    const PoseEdge& edge = graph.pose_edges[idx(k)];
    const double other = square_of(turned_round(edge), estimates);
    const double gain = square_of(edge, estimates) - other;
    if (gain <= margin * scale || other > kFarOut * scale) continue;
    edges.push_back(k);
    most = std::max(most, gain);
  }
  return most > kClear * scale ? edges : std::vector<int>{};
}

/// Loops that fit either way are left as they are given.
ReversedLoops without_doubtful(const PoseGraph& graph, const std::vector<int>& loops,
                               ReversedLoops found, const GraphFit& fit) {
  const double scale = fit.dof > 0 ? fit.per_dof() : 0.0;
  const double margin = 10 * found.edges.size() < loops.size() ? kClear : kRatherBetter;
  std::vector<int> clear;
  for (const int k : found.edges) {
    const PoseEdge& edge = graph.pose_edges[idx(k)];
    const double gain =
        square_of(edge, fit.estimates) - square_of(turned_round(edge), fit.estimates);
    if (gain > margin * scale) clear.push_back(k);
  }
  if (clear.empty() || clear.size() == found.edges.size()) return found;
  found.after = fit_graph(with_reversed(graph, clear)).chi2;
  found.edges = std::move(clear);
  return found;
}

/// Each loop both ways in one graph, and how much each of the two counts.
class BothWays {
 public:
  BothWays(const PoseGraph& graph, const std::vector<int>& loops)
      : loops_(loops), edges_(graph.pose_edges.size()), graph_(doubled(graph, loops)) {}

  /// Both ways at half weight.
  [[nodiscard]] std::vector<Pose> midway() const {
    PoseGraph halves = graph_;
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      halves.pose_edges[idx(loops_[k])].information *= 0.5;
      halves.pose_edges[edges_ + k].information *= 0.5;
    }
    return fit_graph(halves).estimates;
  }

  /// The loops that suit better the other way round.
  std::vector<int> settle(std::vector<Pose> start) {
    estimates_ = std::move(start);
    pose_graph::PoseGraphSystem system(graph_, pose_graph::choose_gauge(graph_));
    double scale = better_scale();
    for (int round = 0; round < kMostRounds && scale > 0.0; ++round) {
      system.set_weights(weights(scale));
      estimates_ = pose_graph::descend(system, std::move(estimates_), kRound).estimates;
      const double before = scale;
      scale = std::max(better_scale(), scale / kCooling);
      if (round >= kLeastRounds && scale > 0.95 * before) break;
    }
    return better_reversed(graph_, loops_, kRatherBetter, estimates_);
  }

 private:
  static PoseGraph doubled(PoseGraph graph, const std::vector<int>& loops) {
    for (const int k : loops) graph.pose_edges.push_back(turned_round(graph.pose_edges[idx(k)]));
    return graph;
  }

  [[nodiscard]] double as_given(std::size_t k) const {
    return square_of(graph_.pose_edges[idx(loops_[k])], estimates_);
  }
  [[nodiscard]] double reversed(std::size_t k) const {
    return square_of(graph_.pose_edges[edges_ + k], estimates_);
  }

  /// s^2 by the better of each loop's two.
  [[nodiscard]] double better_scale() const {
    Squares squares;
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      squares.push_back(std::min(as_given(k), reversed(k)));
    }
    return kTooGood * statistics::median(squares) / kMedianOfThree;
  }

  /// How much each of the two counts; a loop that fits neither way counts for nothing.
  [[nodiscard]] std::vector<double> weights(double scale) const {
    std::vector<double> result(graph_.edges(), 1.0);
    for (std::size_t k = 0; k < loops_.size(); ++k) {
      const double a = as_given(k);
      const double b = reversed(k);
      const double share = 1.0 / (1.0 + std::exp(0.5 * (a - b) / scale));
      const double kept = 1.0 / (1.0 + std::exp(0.5 * (std::min(a, b) / scale - kGate)));
      result[idx(loops_[k])] = kept * share;
      result[edges_ + k] = kept * (1.0 - share);
    }
    return result;
  }

  const std::vector<int>& loops_;
  std::size_t edges_;
  PoseGraph graph_;
  std::vector<Pose> estimates_;
};

/// With these reversed, and others that show once they are, if that explains the misfit.
std::optional<ReversedLoops> put_right(const PoseGraph& graph, const std::vector<int>& loops,
                                       std::vector<int> edges, const GraphFit& as_given,
                                       bool trusted) {
  for (int refit = 0; refit < kMostRefits; ++refit) {
    if (edges.empty() || edges.size() == loops.size()) break;
    const PoseGraph some = with_reversed(graph, edges);
    const GraphFit fit = fit_graph(some);
    std::vector<int> more;
    for (const int k : better_reversed(some, loops, kClear, fit.estimates)) {
      if (!std::binary_search(edges.begin(), edges.end(), k)) more.push_back(k);
    }
    if (more.empty() || refit + 1 == kMostRefits) {
      if (!reversal_explains(graph, as_given, some, fit, loops, trusted)) break;
      return without_doubtful(graph, loops, {edges, false, as_given.chi2, fit.chi2}, fit);
    }
    edges.insert(edges.end(), more.begin(), more.end());
    std::sort(edges.begin(), edges.end());
  }
  return std::nullopt;
}

}  // namespace

std::optional<ReversedLoops> reversed_loops(const PoseGraph& graph, const std::vector<int>& loops,
                                            const GraphFit& as_given, bool trusted) {
  if (loops.empty() || as_given.dof <= 0) return std::nullopt;
  const PoseGraph all = with_reversed(graph, loops);
  const GraphFit all_fit = fit_graph(all);
  const bool all_explains = reversal_explains(graph, as_given, all, all_fit, loops, trusted);
  ReversedLoops result{loops, true, as_given.chi2, all_fit.chi2};
  if (all_explains && !leaves_misfit(all, loops, all_fit, trusted)) return result;
  if (!leaves_misfit(graph, loops, as_given, trusted)) return std::nullopt;

  BothWays both(graph, loops);
  std::optional<ReversedLoops> best = all_explains ? std::optional(result) : std::nullopt;
  // Few reversed ones show beside the fit as given; many, or half, where neither way leads.
  for (const bool midway : {false, true}) {
    std::vector<int> edges = both.settle(midway ? both.midway() : as_given.estimates);
    const auto found = put_right(graph, loops, std::move(edges), as_given, trusted);
    if (found && (!best || found->after < 0.5 * best->after)) best = found;
    if (trusted && best && best->after < 1.5 * as_given.dof) break;
  }
  return best;
}

}  // namespace trussmap::check
