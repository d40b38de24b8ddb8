// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "pose_graph/pose_graph_chain.hpp"
#include "pose_graph/pose_graph_descent.hpp"
#include "pose_graph/pose_graph_gauge.hpp"
#include "pose_graph/pose_graph_headings.hpp"
#include "pose_graph/pose_graph_lifting.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/pose_graph.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap {
using namespace pose_graph;

namespace {

constexpr double kSame = 1e-6;        // relative difference of chi^2 below which minima are one
constexpr double kImplausible = 4.0;  // standard deviations of chi^2 above its expectation
constexpr std::uint64_t kLiftingSeed = 1;
constexpr int kLooksAlike = 3;
constexpr linalg::DescentOptions kTrial{40,
                                        1e-8};  // a descent that only looks for a better minimum

struct Start {
  std::string name;
  std::vector<Pose> estimates;
  double chi2 = 0.0;
  std::vector<int> windings = {};
  bool tried = false;
};

/// How many standard deviations chi^2 lies above what its degrees of freedom let expect (Wilson
/// and Hilferty's cube root, good from one degree of freedom on).
double excess_of(double chi2, int dof) {
  if (dof <= 0) return 0.0;
  const double spread = 2.0 / (9.0 * dof);
  return (std::cbrt(chi2 / dof) - (1.0 - spread)) / std::sqrt(spread);
}

bool has_all_estimates(const PoseGraph& graph) {
  return std::all_of(graph.vertices.begin(), graph.vertices.end(),
                     [](const GraphVertex& v) { return v.estimate.has_value(); });
}

std::vector<Pose> file_estimates(const PoseGraph& graph) {
  std::vector<Pose> estimates;
  estimates.reserve(graph.vertices.size());
  for (const GraphVertex& vertex : graph.vertices) estimates.push_back(*vertex.estimate);
  return estimates;
}

void require_sound(const PoseGraph& graph) {
  if (graph.vertices.empty()) throw std::invalid_argument("the graph has no vertices");
  if (const std::optional<std::string> fault = find_fault(graph)) {
    throw std::invalid_argument(*fault);
  }
}

/// The search for the lowest minimum, one graph's worth.
class Search {
 public:
  Search(const PoseGraph& graph, const AdjustmentOptions& options)
      : graph_(graph),
        options_(options),
        held_(choose_gauge(graph)),
        dof_(count_measurements(graph) - count_unknowns(graph, held_)),
        system_(graph, held_),
        headings_(graph, held_, system_.order()) {}

  PoseGraphAdjustment run() {
    collect_starts();
    try_start(lowest_start(), final_descent());
    refuse_loose_vertices();
    challenge();
    return report();
  }

 private:
  void add(std::string name, std::vector<Pose> estimates) {
    Start start{std::move(name), std::move(estimates)};
    start.chi2 = system_.chi_squared(start.estimates);
    start.windings = headings_.windings(start.estimates);
    starts_.push_back(std::move(start));
  }

  void add_from_headings(const std::string& name, const std::vector<Pose>& near) {
    const std::vector<Pose> fitted = headings_.fit(near);
    const std::vector<int> windings = headings_.windings(fitted);
    const bool known = std::any_of(starts_.begin(), starts_.end(),
                                   [&](const Start& start) { return start.windings == windings; });
    if (!known) add(name, fit_positions(system_, fitted));
  }

  void collect_starts() {
    const bool from_file = options_.start != StartFrom::odometry && has_all_estimates(graph_);
    if (options_.start == StartFrom::file && !from_file) {
      throw std::invalid_argument("starting from the file needs an estimate of every vertex");
    }
    const std::vector<Pose> odometry = chain_measurements(graph_, held_, Tree::odometry);
    if (graph_.pose_edges.empty()) {
      add("odometry", odometry);
    } else {
      const std::vector<Pose> nearest = chain_measurements(graph_, held_, Tree::nearest);
      add_from_headings("headings along the nearest ways", nearest);
      add_from_headings("headings along odometry", odometry);
      add_from_headings("headings along the strongest edges",
                        chain_measurements(graph_, held_, Tree::strongest));
      add_from_headings("chordal headings", headings_.relax(nearest));
      drawn_ = starts_.size();
      add("odometry", odometry);
    }
    if (from_file) add("the file", file_estimates(graph_));
  }

  Start& lowest_start() {
    return *std::min_element(starts_.begin(), starts_.end(),
                             [](const Start& a, const Start& b) { return a.chi2 < b.chi2; });
  }

  void try_start(Start& start, const linalg::DescentOptions& how) {
    start.tried = true;
    Descent descent = descend(system_, start.estimates, how);
    const bool first = best_start_.empty();
    if (!first && std::abs(descent.chi2 - best_.chi2) <= kSame * best_.chi2 + kSame * kSame) return;
    const bool better = first || descent.chi2 < best_.chi2;
    if (!first) {
      others_.emplace_back(better ? best_start_ : start.name, better ? best_.chi2 : descent.chi2);
    }
    if (!better) return;
    descent.converged = descent.converged && how.tolerance <= options_.tolerance;
    best_ = std::move(descent);
    best_start_ = start.name;
    best_windings_ = headings_.windings(best_.estimates);
  }

  void refuse_loose_vertices() {
    const std::vector<int> loose = find_loose_vertices(system_, best_.estimates);
    if (loose.empty()) return;
    constexpr std::size_t kNamed = 5;
    std::string names;
    for (std::size_t k = 0; k < std::min(kNamed, loose.size()); ++k) {
      names += (k == 0 ? "" : ", ") + std::to_string(graph_.vertices[idx(loose[k])].id);
    }
    if (loose.size() > kNamed) names += text::joined(" and ", loose.size() - kNamed, " more");
    const bool one = loose.size() == 1;
    throw SolveError(
        text::joined(one ? "vertex " : "vertices ", names,
                     " can still move without contradicting any measurement (measure more of ",
                     one ? "it" : "them", ", or fix ", one ? "it" : "one", ")"));
  }

  /// Lets other starts try to beat what was found, then makes the best exact.
  void challenge() {
    for (std::size_t k = 0; k < starts_.size(); ++k) {
      Start& start = starts_[k];
      if (start.tried || start.windings == best_windings_) continue;
      const bool drawn = k < drawn_;
      const bool wanted = options_.start == StartFrom::file && k + 1 == starts_.size();
      if (drawn || wanted || is_implausible() || start.chi2 < best_.chi2) try_start(start, kTrial);
    }
    // A chi^2 that looks right proves little where there are few loops: starts that disagree are
    // reason enough to look further.
    const bool doubtful = is_implausible() || !others_.empty();
    if (doubtful && !graph_.pose_edges.empty()) try_lifted_start();
    if (best_.converged) return;
    const int before = best_.iterations;
    best_ = descend(system_, best_.estimates, final_descent());
    best_.iterations += before;
  }

  void try_lifted_start() {
    // Windings tell everything of poses, but not of poses that hang on points.
    const auto nothing_new = [this](const std::vector<Pose>& estimates) {
      return graph_.point_edges.empty() && headings_.windings(estimates) == best_windings_;
    };
    int in_a_row = 0;  // the search may pass by on its way to something better
    const auto enough = [&](const std::vector<Pose>& estimates) {
      in_a_row = nothing_new(estimates) ? in_a_row + 1 : 0;
      return in_a_row == kLooksAlike;
    };
    const std::vector<Pose> lifted =
        solve_lifted(graph_, held_, system_.order(), kLiftingSeed, enough);
    if (nothing_new(lifted)) return;
    Start start{"the lifted problem", fit_positions(system_, lifted)};
    try_start(start, kTrial);
  }

  [[nodiscard]] bool is_implausible() const { return excess_of(best_.chi2, dof_) > kImplausible; }

  [[nodiscard]] linalg::DescentOptions final_descent() const {
    return {options_.max_iterations, options_.tolerance};
  }

  PoseGraphAdjustment report() {
    PoseGraphAdjustment result;
    result.estimates = best_.estimates;
    for (std::size_t v = 0; v < result.estimates.size(); ++v) {
      Pose& pose = result.estimates[v];
      pose.heading = is_pose(graph_.vertices[v]) ? wrap_angle(pose.heading) : 0.0;
    }
    result.chi2 = best_.chi2;
    result.dof = dof_;
    result.iterations = best_.iterations;
    result.gradient_norm = best_.gradient_norm;
    result.converged = best_.converged;
    result.start = best_start_;
    if (!best_.converged) {
      result.warnings.push_back(text::joined("not converged after ", best_.iterations,
                                             " iterations; the result is not a minimum of chi2"));
    }
    if (is_implausible()) {
      result.warnings.push_back(text::joined(
          "chi2 ", text::short_text(best_.chi2), " is far too large for ", dof_,
          " degrees of freedom: wrong edges, too much information claimed, or a local minimum"));
    }
    for (const auto& [name, chi2] : others_) {
      result.warnings.push_back(text::joined("a start from ", name,
                                             " ends in another minimum, chi2 ",
                                             text::short_text(chi2), "; the lower one is kept"));
    }
    return result;
  }

  const PoseGraph& graph_;
  const AdjustmentOptions& options_;
  std::vector<std::uint8_t> held_;
  int dof_;
  PoseGraphSystem system_;
  HeadingSystem headings_;
  std::vector<Start> starts_;
  std::size_t drawn_ = 0;  ///< the first so many starts came from headings
  Descent best_;
  std::string best_start_;
  std::vector<int> best_windings_;
  std::vector<std::pair<std::string, double>> others_;
};

}  // namespace

PoseGraphAdjustment adjust(const PoseGraph& graph, const AdjustmentOptions& options) {
  require_sound(graph);
  return Search(graph, options).run();
}

std::vector<Eigen::MatrixXd> marginal_covariances(const PoseGraph& graph,
                                                  const std::vector<Pose>& estimates,
                                                  const std::vector<int>& vertices) {
  require_sound(graph);
  if (estimates.size() != graph.vertices.size()) {
    throw std::invalid_argument("one estimate per vertex of the graph is needed");
  }
  const std::vector<std::uint8_t> held = choose_gauge(graph);
  PoseGraphSystem system(graph, held);
  system.linearise(estimates);
  linalg::BlockSystem& H = system.normal_equations();
  try {
    if (H.unknowns() > 0) H.factorise();
  } catch (const linalg::NotPositiveDefinite& failure) {
    throw SolveError(text::joined("vertex ",
                                  graph.vertices[idx(system.vertex_of(failure.column()))].id,
                                  " can still move without contradicting any measurement"));
  }
  std::vector<Eigen::MatrixXd> result;
  for (const int vertex : vertices) {
    const int full = is_pose(graph.vertices.at(idx(vertex))) ? 3 : 2;
    Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(full, full);
    const int size = H.size(vertex);
    if (size > 0) {
      Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(H.unknowns(), size);
      unit.middleRows(H.offset(vertex), size).setIdentity();
      covariance = H.solve(unit).middleRows(H.offset(vertex), size);
      for (int k = 0; k < size; ++k) {  // what is pinned within a free vertex is known exactly
        if (estimation::is_held(held[idx(vertex)], k)) covariance(k, k) = 0.0;
      }
    }
    result.push_back(covariance);
  }
  return result;
}

}  // namespace trussmap
