// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/recording_robust.hpp"

#include "estimation/fitted_rows.hpp"
#include "estimation/pose_reckoner.hpp"
#include "estimation/robust_weights.hpp"
#include "linalg/dense.hpp"
#include "statistics/thinned.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace trussmap::estimation {
namespace {

/// A landmark without any sighting would be tied to nothing, unless it is surveyed: then one that
/// is never seen but by labels misread would pull the robot to where it lies.
void keep_one_per_landmark(const RecordingProblem& problem,
                           const std::vector<double>& squared_errors,
                           std::vector<double>& weights) {
  std::vector<std::size_t> best(problem.landmarks.size(), problem.measurements.size());
  std::vector<bool> surveyed(problem.landmarks.size(), false);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (is_surveyed_place(one)) surveyed[idx(one.from)] = true;
    if (!is_sighting(one)) continue;
    std::size_t& chosen = best[idx(one.to)];
    if (chosen == problem.measurements.size() || squared_errors[k] < squared_errors[chosen]) {
      chosen = k;
    }
  }
  constexpr double kLeast = 1e-3;
  for (const std::size_t k : best) {
    if (k == problem.measurements.size()) continue;
    if (!surveyed[idx(problem.measurements[k].to)]) weights[k] = std::max(weights[k], kLeast);
  }
}

/// A session that no sighting ties to the others any more gets its best one back.
void keep_tied(const RecordingProblem& problem, const std::vector<double>& squared_errors,
               std::vector<double>& weights) {
  for (;;) {
    const std::vector<int> untied = untied_poses(problem, weights);
    if (untied.empty()) return;
    const std::set<int> loose(untied.begin(), untied.end());
    std::size_t best = weights.size();
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const Measurement& one = problem.measurements[k];
      if (weights[k] > 0.0 || !may_be_wrong(one)) continue;
      if (is_of_orientation(one)) continue;  // it ties no pose
      const auto is_loose = [&](int node) {
        return loose.contains(node - problem.landmark_count());
      };
      if (!is_loose(one.from) && !(is_tie(one) && is_loose(one.to))) continue;
      if (best == weights.size() || squared_errors[k] < squared_errors[best]) best = k;
    }
    if (best == weights.size()) return;  // nothing ever tied it
    weights[best] = 1.0;
  }
}

std::vector<double> soft_weights(const RecordingProblem& problem,
                                 const std::vector<double>& squared_errors, double gate) {
  std::vector<double> weights(squared_errors.size(), 1.0);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    if (!may_be_wrong(problem.measurements[k])) continue;
    weights[k] = soft_weight(squared_errors[k], gate);
  }
  return weights;
}

/// Of loops, or of what else may be wrong.
double share_of_kind_beyond(const RecordingProblem& problem,
                            const std::vector<double>& squared_errors, double limit, bool loops) {
  double beyond = 0.0;
  double all = 0.0;
  for (std::size_t k = 0; k < squared_errors.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (!may_be_wrong(one) || is_tie(one) != loops) continue;
    all += 1.0;
    if (squared_errors[k] > limit) beyond += 1.0;
  }
  return beyond / std::max(all, 1.0);
}

}  // namespace

double share_beyond(const RecordingProblem& problem, const std::vector<double>& squared_errors,
                    double limit) {
  return share_of_kind_beyond(problem, squared_errors, limit, false);
}

namespace {

/// Places are taken for one another far more often than landmarks are misread; but where most loops
/// contradict the drive, it is the drive that is wrong.
constexpr double kMostLoopsOut = 0.5;

bool are_few_beyond(const RecordingProblem& problem, const std::vector<double>& squared_errors,
                    double limit, double most) {
  return share_beyond(problem, squared_errors, limit) <= most &&
         share_of_kind_beyond(problem, squared_errors, limit, true) <=
             std::max(most, kMostLoopsOut);
}

constexpr double kRoughTolerance = 1e-6;  // of descents on the way, whose weights change again

constexpr double kSamePlace = 0.5;  // m

constexpr std::size_t kMostCompared = 25;  // places of a landmark, with one another

std::ptrdiff_t votes(const std::vector<Vector2>& places, const Vector2& place) {
  return std::count_if(places.begin(), places.end(), [&place](const Vector2& other) {
    return (other - place).norm() < kSamePlace;
  });
}

constexpr double kTruncated = 1e9;  // mu: the truncated square itself

/// Narrowing has told most wrong ones from right ones: the bending begins in its midst, and ends
/// where hardly any error is so near the gate (by a thousandth of it) that it counts in part.
constexpr Bending kBending{.first = 0.1, .last = 1e3};

/// The robust fit, stage by stage.
class RobustDescent {
 public:
  RobustDescent(RecordingSystem& system, const RecordingProblem& problem, RobustFit fit)
      : system_(system), problem_(problem), fit_(std::move(fit)) {
    system_.set_slack(RecordingSystem::kRoughSlack);
  }
  ~RobustDescent() { system_.set_slack(RecordingSystem::kFineSlack); }
  RobustDescent(const RobustDescent&) = delete;
  RobustDescent& operator=(const RobustDescent&) = delete;

  void heed() { follow_majority(problem_, fit_.state); }

  /// From a wide gate down to the one wanted; then back to the narrowest that few sightings are
  /// beyond.
  void narrow(double wanted, double most) {
    constexpr double kStep = 4.0;
    constexpr int kSteps = 4;
    constexpr linalg::DescentOptions kRound{10, kRoughTolerance, kNegligibleDecrease};
    RobustFit best = fit_;
    best.gate = std::numeric_limits<double>::infinity();
    double gate = wanted * std::pow(kStep, kSteps);
    for (int step = 0; step <= kSteps; ++step, gate /= kStep) {
      go_on_from(descend_softly(system_, problem_, position(), gate, 2, kRound));
      fit_.gate = gate;
      if (are_few_beyond(problem_, system_.squared_errors(), gate, most)) best = fit_;
    }
    fit_ = std::move(best);
  }

  /// The weights are bent until each is 0 or 1.
  void harden() {
    fit_.weights.assign(problem_.measurements.size(), 1.0);
    if (std::isfinite(fit_.gate)) {
      system_.linearise(fit_.state, fit_.coefficients);
      const auto weigh_on = [this](double mu) {
        weigh(mu);
        return true;  // a landmark's best one keeps its weight, however wrong
      };
      bend(kBending, weigh_on, [this] { descend_by(2); });
      sort_out();
      look_again();
    }
    system_.set_weights(fit_.weights);
  }

  /// Lets in what fits and takes out what does not, until nothing changes.
  void look_again() {
    reconsider([this](int round) {
      system_.set_weights(fit_.weights);
      descend_by(10);
      // Where chi^2 is least, and once more when the best of them are in.
      if (round < 2 && readmit()) descend_by(10);
      const std::vector<double> before = fit_.weights;
      if (std::isfinite(fit_.gate)) sort_out();
      return fit_.weights != before;
    });
    system_.set_weights(fit_.weights);
  }

  [[nodiscard]] RobustFit take() { return std::move(fit_); }

 private:
  void descend_by(int steps) {
    go_on_from(descend(system_, std::move(fit_.state), std::move(fit_.coefficients),
                       {steps, kRoughTolerance, kNegligibleDecrease}));
  }

  /// Where the fit stands, to go on from.
  [[nodiscard]] RecordingDescent position() {
    return {std::move(fit_.state), std::move(fit_.coefficients)};
  }

  void go_on_from(RecordingDescent next) {
    fit_.state = std::move(next.state);
    fit_.coefficients = std::move(next.coefficients);
  }

  /// A sighting that is out may have to stay so only for want of itself: without it its robot is
  /// where the wheels have it, and that is less certain than the sighting is exact. What counts is
  /// by how much chi^2 would rise with it, e'(I + J A^-1 J')^-1 e. Says whether any came back.
  bool readmit() {
    if (!std::isfinite(fit_.gate)) return false;
    constexpr double kFaint = 1e-10;  // a weight that tells nothing and hides no derivative
    std::vector<std::size_t> out;
    std::vector<double> weights = fit_.weights;
    for (std::size_t k = 0; k < weights.size(); ++k) {
      if (weights[k] > 0.0 || !may_be_wrong(problem_.measurements[k])) continue;
      out.push_back(k);
      weights[k] = kFaint;
    }
    if (out.empty()) return false;
    system_.set_weights(weights);
    system_.linearise(fit_.state, fit_.coefficients);
    try {
      system_.factorise();
    } catch (const linalg::NotPositiveDefinite&) {  // what is in leaves something undetermined
      system_.set_weights(fit_.weights);
      return false;
    }
    const FittedRows fitted(system_);  // of all at once: a solve for each would be out times nodes
    bool any = false;
    for (const std::size_t k : out) {
      const Eigen::Index count = problem_.measurements[k].rows;
      const Eigen::VectorXd error =
          system_.residuals().segment(system_.first_row(k), count) / std::sqrt(kFaint);
      Eigen::MatrixXd inner = fitted.covariance(system_, k) / kFaint;
      inner.diagonal().array() += 1.0;
      if (error.dot(linalg::DenseLdlt(inner).solve(error)) > fit_.gate) continue;
      fit_.weights[k] = 1.0;
      any = true;
    }
    system_.set_weights(fit_.weights);
    return any;
  }

  /// In or out.
  void sort_out() {
    weigh(kTruncated);
    for (double& weight : fit_.weights) weight = weight > 0.0 ? 1.0 : 0.0;
    keep_tied(problem_, system_.squared_errors(), fit_.weights);
  }

  void weigh(double mu) {
    for (std::size_t k = 0; k < fit_.weights.size(); ++k) {
      if (!may_be_wrong(problem_.measurements[k])) continue;
      fit_.weights[k] = gnc_weight(system_.squared_errors()[k], fit_.gate, mu);
    }
    keep_one_per_landmark(problem_, system_.squared_errors(), fit_.weights);
    system_.set_weights(fit_.weights);
  }

  RecordingSystem& system_;
  const RecordingProblem& problem_;
  RobustFit fit_;
};

}  // namespace

RecordingDescent descend_softly(RecordingSystem& system, const RecordingProblem& problem,
                                RecordingDescent fit, double gate, int rounds,
                                const linalg::DescentOptions& options) {
  for (int round = 0; round < rounds; ++round) {
    system.linearise(fit.state, fit.coefficients);
    system.set_weights(soft_weights(problem, system.squared_errors(), gate));
    fit = descend(system, std::move(fit.state), std::move(fit.coefficients), options);
  }
  return fit;
}

void follow_majority(const RecordingProblem& problem, RecordingState& state) {
  std::vector<std::vector<Vector2>> places(state.landmarks.size());
  for (const Measurement& one : problem.measurements) {
    if (!locates(one)) continue;
    const Pose& pose = state.poses[idx(one.from - problem.landmark_count())];
    places[idx(one.to)].push_back(*one.kind->seen_from(one, pose, one.mounted));
  }
  const std::vector<Vector2> before = state.landmarks;
  const auto others = [&](std::size_t landmark, const Vector2& place) {
    for (std::size_t k = 0; k < before.size(); ++k) {
      if (k != landmark && (before[k] - place).norm() < kSamePlace) return true;
    }
    return false;
  };
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::vector<Vector2> seen = statistics::thinned(places[k], kMostCompared);
    const std::ptrdiff_t here = votes(seen, before[k]);
    if (2 * here > std::ssize(seen)) continue;
    std::ptrdiff_t most = here;
    for (const Vector2& place : seen) {
      const std::ptrdiff_t there = votes(seen, place);
      const bool elsewhere = (place - state.landmarks[k]).norm() >= kSamePlace;
      if (there < most || !elsewhere) continue;
      if (there == most && (!others(k, state.landmarks[k]) || others(k, place))) continue;
      most = there;
      state.landmarks[k] = place;
    }
  }
}

RobustFit descend_robustly(RecordingSystem& system, const RecordingProblem& problem,
                           RecordingState state, Eigen::VectorXd coefficients,
                           const RobustDescentOptions& options) {
  RobustDescent descent(system, problem, {std::move(state), std::move(coefficients), {}, 0.0});
  descent.heed();
  descent.narrow(options.gate, options.most_left_out);
  descent.harden();
  return descent.take();
}

RobustFit look_again(RecordingSystem& system, const RecordingProblem& problem, RobustFit fit) {
  RobustDescent descent(system, problem, std::move(fit));
  descent.look_again();
  return descent.take();
}

}  // namespace trussmap::estimation
