// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/changing_coefficients.hpp"

#include "criticism/coefficient_course.hpp"
#include "geometry/index.hpp"
#include "linalg/dense.hpp"
#include "statistics/quadratic_forms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/LU>

namespace trussmap::criticism {
namespace {

constexpr double kForms = 2.0;  // tests per effect
constexpr int kSizes = 80;
// Sizes of a walk that are tried, and of a step that are thought possible: from the least to the
// largest, logarithm.
constexpr double kLogSizes = 9.2;

double dispersion(double chi2, double dof) {
  return std::max(1.0, chi2 / std::max(1.0, dof));
}

struct Step {
  std::size_t at = 0;  ///< first part after it
  double score = 0.0;  ///< chi^2, phi = 1
  double p_value = 1.0;
  std::vector<double> scores;  ///< per part
};

/// `about`: without the constant.
Step largest_step(const CoefficientCourse& about) {
  const Eigen::Index n = about.s.size();
  Step step;
  step.scores.assign(static_cast<std::size_t>(n), 0.0);
  std::vector<double> cosines;
  Eigen::VectorXd before;  // G b of the step before that can be seen
  double own_before = 0.0;
  Eigen::VectorXd b = Eigen::VectorXd::Ones(n);
  for (Eigen::Index k = 1; k < n; ++k) {
    b[k - 1] = 0.0;
    const Eigen::VectorXd Gb = about.G * b;
    const double own = b.dot(Gb);
    if (!(own > 1e-9 * about.G.trace())) continue;
    const double sum = b.dot(about.s);
    const double score = sum * sum / own;
    step.scores[static_cast<std::size_t>(k)] = score;
    if (own_before > 0.0) cosines.push_back(b.dot(before) / std::sqrt(own * own_before));
    before = Gb;
    own_before = own;
    if (score <= step.score) continue;
    step.score = score;
    step.at = static_cast<std::size_t>(k);
  }
  step.p_value = statistics::largest_square_p_value(
      step.score / dispersion(about.chi2 - step.score, about.dof - 1), cosines);
  return step;
}

/// A size that a walk may have.
struct WalkSize {
  double tau = 0.0;   ///< per root of an hour
  double gain = 0.0;  ///< -2 log of the restricted likelihood that it takes away
  double phi = 1.0;
};

struct Walk {
  WalkSize likeliest;
  std::vector<WalkSize> sizes;  ///< equally far apart on a logarithmic scale
  double p_value = 1.0;
};

/// What walks make of the scores, in modes: w_k^2 ~ phi + tau^2 variances_k.
struct Modes {
  Eigen::VectorXd variances;
  Eigen::VectorXd squares;

  [[nodiscard]] double deviance(double phi, double tau2) const {
    const Eigen::ArrayXd total = phi + tau2 * variances.array();
    return (total.log() + squares.array() / total).sum();
  }
};

Modes modes_of(const CoefficientCourse& about) {
  const Eigen::Index n = about.s.size();
  const linalg::SymmetricModes seen = linalg::symmetric_modes(about.G);
  const double least = 1e-9 * std::max(seen.eigenvalues.maxCoeff(), 0.0);
  Eigen::Index first = 0;
  while (first < n && seen.eigenvalues[first] <= least) ++first;
  const Eigen::Index count = n - first;
  const Eigen::VectorXd root = seen.eigenvalues.tail(count).cwiseSqrt();
  const Eigen::MatrixXd U = seen.eigenvectors.rightCols(count);
  Eigen::MatrixXd W(n, n);
  for (Eigen::Index j = 0; j < n; ++j) {
    for (Eigen::Index k = 0; k < n; ++k) {
      W(j, k) = std::min(about.parts[idx(j)].hours, about.parts[idx(k)].hours) -
                about.parts.front().hours;
    }
  }
  const Eigen::MatrixXd A = root.asDiagonal() * (U.transpose() * W * U) * root.asDiagonal();
  const linalg::SymmetricModes walk = linalg::symmetric_modes(A);
  Modes modes;
  modes.variances = walk.eigenvalues.cwiseMax(0.0);
  modes.squares =
      (walk.eigenvectors.transpose() * root.cwiseInverse().asDiagonal() * U.transpose() * about.s)
          .cwiseAbs2();
  return modes;
}

/// `about`: without the constant.
Walk likeliest_walk(const CoefficientCourse& about) {
  const Modes modes = modes_of(about);
  const double largest = modes.variances.size() > 0 ? modes.variances.maxCoeff() : 0.0;
  Walk walk;
  if (!(largest > 0.0)) return walk;
  const double rest = about.chi2 - modes.squares.sum();  // that no course explains
  const auto rest_dof = static_cast<double>(about.dof - modes.squares.size());
  const double null = dispersion(about.chi2, about.dof);
  walk.likeliest.phi = null;
  for (int k = 0; k < kSizes; ++k) {
    const double tau2 = std::exp(std::log(1e-2) + 2.0 * kLogSizes * k / (kSizes - 1)) / largest;
    double phi = null;  // of what this size leaves
    for (int round = 0; round < 20; ++round) {
      const Eigen::ArrayXd kept = phi / (phi + tau2 * modes.variances.array());
      phi = dispersion(rest + (modes.squares.array() * kept).sum(), rest_dof + kept.sum());
    }
    const double gain = modes.deviance(null, 0.0) - modes.deviance(phi, tau2) +
                        (rest_dof * std::log(null) + rest / null) -
                        (rest_dof * std::log(phi) + rest / phi);
    walk.sizes.push_back({std::sqrt(tau2), gain, phi});
    if (gain > walk.likeliest.gain) walk.likeliest = walk.sizes.back();
  }
  walk.p_value = statistics::quadratic_form_p_value(
      modes.variances.dot(modes.squares) / walk.likeliest.phi,
      std::vector<double>(modes.variances.data(), modes.variances.data() + modes.variances.size()));
  return walk;
}

/// Deviations from the fitted coefficient as the walk has them, and their covariance. `all`: with
/// the constant.
struct Deviations {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

Deviations deviations(const CoefficientCourse& all, const WalkSize& walk) {
  const Eigen::Index n = all.s.size();
  Eigen::MatrixXd P = all.G / walk.phi;
  for (Eigen::Index k = 1; k < n; ++k) {
    const double hours = std::max(all.parts[idx(k)].hours - all.parts[idx(k - 1)].hours, 1e-9);
    const double stiff = 1.0 / (walk.tau * walk.tau * hours);
    P(k, k) += stiff;
    P(k - 1, k - 1) += stiff;
    P(k, k - 1) -= stiff;
    P(k - 1, k) -= stiff;
  }
  const linalg::DenseLdlt factor(P);
  return {-factor.solve(all.s) / walk.phi, factor.inverse()};
}

/// Two values instead of one, from part `at` on the second; their covariance.
Deviations deviations(const CoefficientCourse& all, std::size_t at, double phi) {
  const Eigen::Index n = all.s.size();
  Eigen::MatrixXd sides = Eigen::MatrixXd::Zero(n, 2);
  for (Eigen::Index k = 0; k < n; ++k) sides(k, idx(k) < at ? 0 : 1) = 1.0;
  const Eigen::MatrixXd inverse = (sides.transpose() * all.G * sides).inverse();
  return {-inverse * (sides.transpose() * all.s), phi * inverse};
}

/// The mean of what several estimates say of each part, and their scatter.
class Mixture {
 public:
  explicit Mixture(Eigen::Index parts)
      : sum_(Eigen::ArrayXd::Zero(parts)), squares_(Eigen::ArrayXd::Zero(parts)) {}

  void add(double weight, const Eigen::ArrayXd& value, const Eigen::ArrayXd& variance) {
    weight_ += weight;
    sum_ += weight * value;
    squares_ += weight * (variance + value.square());
  }
  [[nodiscard]] double value(Eigen::Index part) const { return sum_[part] / weight_; }
  [[nodiscard]] double sd(Eigen::Index part) const {
    const double mean = value(part);
    return std::sqrt(std::max(0.0, squares_[part] / weight_ - mean * mean));
  }

 private:
  double weight_ = 0.0;
  Eigen::ArrayXd sum_;
  Eigen::ArrayXd squares_;
};

/// What may have happened: weights of the moments and sizes that were tried, sizes equally likely
/// on a logarithmic scale.
struct Chances {
  std::vector<double> steps;  ///< per part
  std::vector<double> walks;  ///< per size

  [[nodiscard]] double of_step() const { return std::reduce(steps.begin(), steps.end()); }
  [[nodiscard]] double of_walk() const { return std::reduce(walks.begin(), walks.end()); }
};

/// Whether a course is no step: what the step leaves changes, too.
bool still_changes(const CoefficientCourse& about, const Step& step) {
  Eigen::VectorXd side = Eigen::VectorXd::Ones(about.s.size());
  side.head(static_cast<Eigen::Index>(step.at)).setZero();
  const CoefficientCourse without = beside(side, about);
  return std::min(largest_step(without).p_value, likeliest_walk(without).p_value) < kChangeLevel;
}

Chances chances_of(const CoefficientCourse& about, const Step& step, const Walk& walk, double phi) {
  const double most = std::max(step.score / phi, walk.likeliest.gain);
  const bool no_step = still_changes(about, step);
  Chances chances;
  for (const double score : step.scores) {
    const double z2 = score / phi;
    // The share of all sizes that are as likely.
    const double width = z2 > 1.0 ? std::sqrt(2.0 * std::numbers::pi / z2) / kLogSizes : 0.0;
    chances.steps.push_back(no_step ? 0.0
                                    : width * std::exp(0.5 * (z2 - most)) /
                                          static_cast<double>(step.scores.size()));
  }
  for (const WalkSize& one : walk.sizes) {
    chances.walks.push_back(std::exp(0.5 * (one.gain - most)) /
                            static_cast<double>(walk.sizes.size()));
  }
  return chances;
}

constexpr double kLeastWeight = 1e-4;

/// Over all that may have happened.
Mixture mixed_course(const CoefficientCourse& all, const Walk& walk, const Chances& chances,
                     double phi) {
  const Eigen::Index n = all.s.size();
  const double least = kLeastWeight * (chances.of_step() + chances.of_walk());
  Mixture mixture(n);
  for (std::size_t at = 1; at < chances.steps.size(); ++at) {
    if (chances.steps[at] < least) continue;
    const Deviations sides = deviations(all, at, phi);
    Eigen::ArrayXd value(n);
    Eigen::ArrayXd variance(n);
    for (Eigen::Index k = 0; k < n; ++k) {
      const Eigen::Index side = idx(k) < at ? 0 : 1;
      value[k] = sides.value[side];
      variance[k] = sides.covariance(side, side);
    }
    mixture.add(chances.steps[at], value, variance);
  }
  for (std::size_t k = 0; k < walk.sizes.size(); ++k) {
    if (chances.walks[k] < least) continue;
    const Deviations walked = deviations(all, walk.sizes[k]);
    mixture.add(chances.walks[k], walked.value.array(), walked.covariance.diagonal().array());
  }
  return mixture;
}

/// From the first to the last part within 95 % of the step's likelihood, in its session.
void tell_when(const CoefficientCourse& all, const Step& step, const std::vector<double>& weights,
               ChangingCoefficient& change) {
  const double sum = std::reduce(weights.begin(), weights.end());
  std::size_t low = step.at;
  std::size_t high = step.at;
  double within = weights[step.at];
  while (within < 0.95 * sum) {
    const bool lower =
        low > 1 && (high + 1 >= weights.size() || weights[low - 1] >= weights[high + 1]);
    if (!lower && high + 1 >= weights.size()) break;
    within += lower ? weights[--low] : weights[++high];
  }
  const DrivePart& after = all.parts[step.at];
  change.session = after.session;
  change.between = step.at > 0 && all.parts[step.at - 1].session != after.session;
  const auto begin_of = [&](std::size_t part) {  // of the gap before it
    return part > 0 && all.parts[part - 1].session == all.parts[part].session
               ? all.parts[part - 1].until
               : all.parts[part].from;
  };
  change.t = 0.5 * (begin_of(step.at) + after.from);
  // It may lie within the part before or after.
  if (low > 0) --low;
  while (all.parts[low].session != after.session) ++low;
  while (all.parts[high].session != after.session) --high;
  change.earliest = all.parts[low].from;
  change.latest = all.parts[high].until;
}

bool is_left(const CoefficientCourse& about, double level) {
  return kForms * std::min(largest_step(about).p_value, likeliest_walk(about).p_value) < level;
}

std::vector<std::string> followed(const CoefficientCourse& about, const fitting::FitState& fit) {
  constexpr double kLeft = 0.05;
  std::vector<std::pair<double, std::string>> explaining;
  for (auto& [name, means] : variables_over(about, fit)) {
    const Eigen::VectorXd centred = means.array() - means.mean();
    const CoefficientCourse without = beside(centred / centred.norm(), about);
    if (without.dof == about.dof || is_left(without, kLeft)) continue;
    explaining.emplace_back(without.chi2, name);
  }
  std::sort(explaining.begin(), explaining.end());
  std::vector<std::string> names;
  names.reserve(explaining.size());
  for (auto& [chi2, name] : explaining) names.push_back(std::move(name));
  return names;
}

/// Whether its coefficients are the same in all sessions, and fitted.
bool may_change(const fitting::FitState& fit, std::size_t effect) {
  const Effect& one = fit.model.effects[effect];
  return one.coefficients.size() == one.shape.size() && effect < fit.effects.size() &&
         fit.effects[effect].not_fitted.empty();
}

void tell_step(const CoefficientCourse& all, const Step& step, const Chances& chances, double phi,
               ChangingCoefficient& change) {
  const Deviations sides = deviations(all, step.at, phi);
  change.before = change.fitted + sides.value[0];
  change.before_sd = std::sqrt(sides.covariance(0, 0));
  change.after = change.fitted + sides.value[1];
  change.after_sd = std::sqrt(sides.covariance(1, 1));
  tell_when(all, step, chances.steps, change);
}

void tell_course(const CoefficientCourse& all, const Mixture& mixture,
                 ChangingCoefficient& change) {
  for (std::size_t k = 0; k < all.parts.size(); ++k) {
    const DrivePart& part = all.parts[k];
    const auto at = static_cast<Eigen::Index>(k);
    change.course.push_back(
        {part.session, part.from, part.until, change.fitted + mixture.value(at), mixture.sd(at)});
  }
}

}  // namespace

std::vector<ChangingCoefficient> changing_coefficients(const fitting::FitState& fit,
                                                       const ScoreTest& tests, double level) {
  std::vector<ChangingCoefficient> result;
  double tried = 0.0;
  for (std::size_t e = 0; e + fit.common_errors < fit.model.effects.size(); ++e) {
    if (!may_change(fit, e)) continue;
    const Effect& effect = fit.model.effects[e];
    const std::optional<CoefficientCourse> all = course_of(e, fit, tests);
    if (!all) continue;
    tried += kForms;
    const CoefficientCourse about = about_constant(*all);
    const Step step = largest_step(about);
    const Walk walk = likeliest_walk(about);
    ChangingCoefficient change;
    change.effect = effect;
    if (effect.coefficients.size() == 1) change.fitted = effect.coefficients.front();
    change.p_value = std::min(step.p_value, walk.p_value);
    if (!(change.p_value < level)) continue;
    const double phi = dispersion(about.chi2 - step.score, about.dof - 1);
    const Chances chances = chances_of(about, step, walk, phi);
    const bool steps = chances.of_step() > chances.of_walk();
    change.form = steps ? ChangingCoefficient::Form::step : ChangingCoefficient::Form::walk;
    change.chi2_decrease = steps ? step.score : walk.likeliest.phi * walk.likeliest.gain;
    if (steps) {
      tell_step(*all, step, chances, phi, change);
    } else {
      change.per_root_hour = walk.likeliest.tau;
    }
    tell_course(*all, mixed_course(*all, walk, chances, phi), change);
    change.goes_with = followed(about, fit);
    if (steps && fit.recordings.size() > 1)
      change.session_name = fit.recordings[change.session].name;
    result.push_back(std::move(change));
  }
  for (ChangingCoefficient& one : result) one.p_value = std::min(1.0, tried * one.p_value);
  std::erase_if(result, [&](const ChangingCoefficient& one) { return !(one.p_value < level); });
  std::stable_sort(result.begin(), result.end(),
                   [](const ChangingCoefficient& a, const ChangingCoefficient& b) {
                     return a.p_value < b.p_value;
                   });
  return result;
}

}  // namespace trussmap::criticism
