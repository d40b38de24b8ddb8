// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/score_test.hpp"

#include "linalg/dense.hpp"
#include "parallel/parallel_for.hpp"
#include "recording/variable_names.hpp"
#include "statistics/distributions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

namespace trussmap::criticism {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Eigen::Index kBatch = 2'500'000;  // numbers in the columns that are worked on at once
constexpr double kQuick = 1.0;              // s of driving at a time
constexpr double kShows = 0.05;             // p

void take_out(const Eigen::MatrixXd& present, Eigen::MatrixXd& M) {
  if (present.cols() > 0) M.noalias() -= present * (present.transpose() * M);
}

Eigen::MatrixXd free_of(const Eigen::MatrixXd& present, Eigen::MatrixXd M) {
  take_out(present, M);
  return M;
}

/// Whether its shapes speak of what a second's middle says nothing about.
bool changes_within_a_second(const Effect& effect) {
  return std::any_of(effect.shape.begin(), effect.shape.end(), [](const Shape& shape) {
    return std::any_of(shape.variables().begin(), shape.variables().end(),
                       [](const std::string& name) {
                         return recording::is_event(name) || name == "acceleration";
                       });
  });
}

}  // namespace

ScoreTest::ScoreTest(const fitting::FitState& fit)
    : fit_(fit),
      clean_(std::make_shared<fitting::NoiseFree>(fit.recordings, fit.model, fit.problem,
                                                  fit.columns.border, fitting::offsets_of(fit),
                                                  fit.adjustment.state)),
      system_(std::make_shared<estimation::RecordingSystem>(fit.problem, fit.columns.border)),
      clean_system_(
          std::make_shared<estimation::RecordingSystem>(clean_->problem, clean_->border)) {
  const std::vector<double> weights =
      estimation::weights_without(fit.adjustment.left_out, fit.problem.measurements.size());
  for (estimation::RecordingSystem* system : {system_.get(), clean_system_.get()}) {
    system->set_weights(weights);
    system->linearise(system == system_.get() ? fit.adjustment.state : clean_->state,
                      fit.adjustment.coefficients);
    system->factorise();
  }
  builders_ = std::make_shared<Builders>(
      Builders{fitting::ColumnBuilder(clean_->context, clean_->problem, clean_->border,
                                      fitting::offsets_of(fit), clean_->state, weights),
               std::nullopt});
  // Rows are not asked for again: of a week's drive they are a million.
  clean_->problem.segments = {};
  clean_->problem.gyro_weights = {};
  residuals_ = free_of_map(system_->residuals());
  present_ = Eigen::MatrixXd(residuals_.size(), 0);
  condition_on(clean_system_->border());
  if (fit.adjustment.dof > 0) {
    dispersion_ = std::max(1.0, residuals_.squaredNorm() / fit.adjustment.dof);
  }
}

Eigen::MatrixXd ScoreTest::free_of_map(const Eigen::MatrixXd& M) const {
  return clean_system_->free_of_nodes(M);
}

Eigen::MatrixXd ScoreTest::projected(const Eigen::MatrixXd& M) const {
  return free_of(present_, free_of_map(M));
}

bool ScoreTest::is_present(const Effect& effect) const {
  const Eigen::MatrixXd M = columns(effect);
  const Eigen::MatrixXd left = free_of_map(M);
  return left.squaredNorm() > fitting::kLeastShare * M.squaredNorm() &&
         free_of(present_, left).squaredNorm() <= fitting::kLeastShare * left.squaredNorm();
}

void ScoreTest::condition_on(const Eigen::MatrixXd& columns) {
  if (columns.cols() == 0) return;
  Eigen::MatrixXd left = projected(columns);
  // Columns of any unit: only their directions count, and those that have none left go.
  Eigen::Index kept = 0;
  for (Eigen::Index k = 0; k < left.cols(); ++k) {
    const double before = columns.col(k).squaredNorm();
    if (left.col(k).squaredNorm() <= fitting::kLeastShare * before) continue;
    left.col(kept++) = left.col(k).normalized();
  }
  if (kept == 0) return;
  const Eigen::MatrixXd basis = linalg::orthonormal_basis(left.leftCols(kept));
  const Eigen::Index rank = basis.cols();
  const Eigen::Index had = present_.cols();
  present_.conservativeResize(Eigen::NoChange, had + rank);
  present_.rightCols(rank) = basis;
  residuals_ -= present_.rightCols(rank) * (present_.rightCols(rank).transpose() * residuals_);
}

ScoreTest ScoreTest::lacking(std::size_t first, const std::vector<Effect>& fitted) const {
  ScoreTest result = *this;
  Eigen::VectorXd residuals = system_->residuals();
  for (const Effect& one : fitted) {
    const Eigen::MatrixXd own = columns(one);
    residuals -= own * Eigen::Map<const Eigen::VectorXd>(one.coefficients.data(), own.cols());
  }
  result.residuals_ = free_of_map(residuals);
  result.present_.resize(residuals_.size(), 0);
  const std::vector<int> unknown = estimation::unknown_coefficients(fit_.columns.border);
  Eigen::MatrixXd others(residuals_.size(), static_cast<Eigen::Index>(unknown.size()));
  Eigen::Index count = 0;
  for (std::size_t k = 0; k < unknown.size(); ++k) {
    const std::size_t effect = fit_.columns.coefficients[idx(unknown[k])].effect;
    if (effect >= first && effect < first + fitted.size()) continue;
    others.col(count++) = clean_system_->border().col(static_cast<Eigen::Index>(k));
  }
  result.condition_on(others.leftCols(count));
  return result;
}

Score ScoreTest::score_of(const Effect& effect, const std::vector<double>& largest,
                          Eigen::MatrixXd columns, Eigen::MatrixXd projected) const {
  const Eigen::Index count = projected.cols();
  const double prior_sd = facts_of(effect.channel).prior_sd;
  Score result;
  result.coefficients.assign(static_cast<std::size_t>(count), 0.0);
  result.sd.assign(static_cast<std::size_t>(count), kInfinity);
  result.minimal_detectable.assign(static_cast<std::size_t>(count), kInfinity);
  result.largest = largest;
  std::vector<Eigen::Index> seen;
  for (Eigen::Index k = 0; k < count; ++k) {
    const double most = largest[static_cast<std::size_t>(k)];
    const double square = projected.col(k).squaredNorm();
    result.share.push_back(square / std::max(columns.col(k).squaredNorm(), 1e-300));
    result.information.push_back(square);
    // What the data tell must not be less than the prior.
    const double uncertainty = most * std::sqrt(dispersion_ / std::max(square, 1e-300));
    if (most > 0.0 && result.share.back() > fitting::kLeastShare &&
        uncertainty < fitting::kLargestUncertainty * prior_sd) {
      seen.push_back(k);
    } else {
      projected.col(k).setZero();
    }
  }
  result.columns = std::move(columns);
  result.projected = std::move(projected);
  const auto dof = static_cast<Eigen::Index>(seen.size());
  if (dof == 0) return result;
  Eigen::MatrixXd M(result.projected.rows(), dof);
  Eigen::VectorXd prior(dof);
  for (Eigen::Index k = 0; k < dof; ++k) {
    const Eigen::Index column = seen[static_cast<std::size_t>(k)];
    M.col(k) = result.projected.col(column);
    const double most = largest[static_cast<std::size_t>(column)];
    prior[k] = dispersion_ * most * most / (prior_sd * prior_sd);
  }
  const Eigen::MatrixXd S = M.transpose() * M;
  const Eigen::VectorXd g = M.transpose() * residuals_;
  Eigen::MatrixXd with_prior = S;
  with_prior.diagonal() += prior;
  const linalg::DenseLdlt factor(with_prior);
  const Eigen::VectorXd estimate = -factor.solve(g);
  const Eigen::MatrixXd covariance = factor.inverse();
  result.score = std::max(0.0, -g.dot(estimate));
  // Shapes that are nearly the same count once.
  const Eigen::VectorXd scale = with_prior.diagonal().cwiseSqrt().cwiseInverse();
  const linalg::SymmetricModes modes =
      linalg::symmetric_modes(scale.asDiagonal() * S * scale.asDiagonal());
  for (Eigen::Index k = 0; k < dof; ++k) result.dof += modes.eigenvalues[k] > 1e-6 ? 1 : 0;
  result.p_value = statistics::chi2_p_value(result.score, result.dof);
  for (Eigen::Index k = 0; k < dof; ++k) {
    const auto place = static_cast<std::size_t>(seen[static_cast<std::size_t>(k)]);
    result.coefficients[place] = estimate[k];
    result.sd[place] = std::sqrt(std::max(0.0, covariance(k, k)));
    result.minimal_detectable[place] = std::sqrt(kDetectableScore / S(k, k));
  }
  return result;
}

Eigen::MatrixXd ScoreTest::landmark_rows(const Eigen::MatrixXd& nodes) const {
  const linalg::BlockSystem& normal = clean_system_->normal_equations();
  const Eigen::Index count = fit_.problem.landmark_count();
  const auto oriented = static_cast<Eigen::Index>(fit_.problem.oriented.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2 * count + oriented, nodes.cols());
  for (int k = 0; k < count; ++k) {
    if (normal.size(k) != 2) continue;
    rows.middleRows(Eigen::Index{2} * k, 2) = nodes.middleRows(normal.offset(k), 2);
  }
  for (Eigen::Index k = 0; k < oriented; ++k) {
    const int node = fit_.problem.pose_end() + static_cast<int>(k);
    rows.row(2 * count + k) = nodes.row(normal.offset(node));
  }
  return rows;
}

std::vector<Score> ScoreTest::test(const std::vector<Effect>& candidates,
                                   Resolution resolution) const {
  if (resolution == Resolution::exact) return test_with(builders_->exact, candidates);
  if (!builders_->quick) builders_->quick.emplace(builders_->exact.coarsened(kQuick));
  std::vector<Score> scores = test_with(*builders_->quick, candidates);
  if (resolution == Resolution::quick) return scores;
  std::vector<std::size_t> shown;
  std::vector<Effect> again;
  for (std::size_t k = 0; k < candidates.size(); ++k) {
    const bool shows = scores[k].dof == 0 || scores[k].p_value < kShows;
    if (!shows && !changes_within_a_second(candidates[k])) continue;
    shown.push_back(k);
    again.push_back(candidates[k]);
  }
  std::vector<Score> exact = test_with(builders_->exact, again);
  for (std::size_t k = 0; k < shown.size(); ++k) scores[shown[k]] = std::move(exact[k]);
  return scores;
}

std::vector<Score> ScoreTest::test_with(fitting::ColumnBuilder& builder,
                                        const std::vector<Effect>& candidates) const {
  const estimation::RecordingSystem& system = *clean_system_;
  const std::size_t sessions = context().recordings().size();
  std::vector<Score> scores;
  for (std::size_t first = 0; first < candidates.size();) {
    std::size_t next = first;
    for (std::size_t count = 0; next < candidates.size() && count < idx(batch()); ++next) {
      count += fitting::coefficient_count(candidates[next], sessions);
    }
    const std::span<const Effect> some = std::span(candidates).subspan(first, next - first);
    std::vector<Eigen::MatrixXd> parts = builder.columns(some);
    std::vector<Eigen::Index> begin{0};
    std::vector<std::vector<double>> largest;
    for (std::size_t k = 0; k < some.size(); ++k) {
      begin.push_back(begin.back() + parts[k].cols());
      largest.push_back(builder.largest(some[k]));
    }
    Eigen::MatrixXd M(residuals_.size(), begin.back());
    for (std::size_t k = 0; k < some.size(); ++k)
      M.middleCols(begin[k], parts[k].cols()) = parts[k];
    const Eigen::MatrixXd nodes = system.solve_nodes(system.transposed_times(M));
    system.subtract_times(nodes, M);
    scores.resize(next);
    parallel::parallel_for(some.size(), [&](std::size_t k) {
      const Eigen::Index shapes = parts[k].cols();
      Score& score = scores[first + k];
      score = score_of(some[k], largest[k], std::move(parts[k]),
                       free_of(present_, M.middleCols(begin[k], shapes)));
      score.landmarks = -landmark_rows(nodes.middleCols(begin[k], shapes));
    });
    first = next;
  }
  return scores;
}

std::shared_ptr<const estimation::FittedRows> ScoreTest::fitted_rows() const {
  if (!fitted_) fitted_ = std::make_shared<const estimation::FittedRows>(*system_);
  return fitted_;
}

void ScoreTest::forget() const {
  builders_->exact.forget();
  builders_->quick.reset();
}

Eigen::Index ScoreTest::batch() const {
  return std::clamp<Eigen::Index>(kBatch / std::max<Eigen::Index>(1, residuals_.size()), 8, 64);
}

double ScoreTest::joint_score(const std::vector<Effect>& effects) const {
  Eigen::MatrixXd M(system_->rows(), 0);
  for (const Score& one : test(effects)) {
    linalg::append_columns(M, one.projected);
  }
  if (M.cols() == 0) return 0.0;
  const Eigen::VectorXd nearest = linalg::least_squares(M, residuals_);
  return (M * nearest).squaredNorm();
}

}  // namespace trussmap::criticism
