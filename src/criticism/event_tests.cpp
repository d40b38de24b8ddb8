// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/criticism/event_tests.hpp"

#include "trussmap/criticism/comparison.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <fmt/format.h>

#include "fit_projection.hpp"
#include "single_events.hpp"

namespace trussmap {
namespace {

constexpr double kUnchecked = 1e-6;
constexpr double kLevel = 0.05;
constexpr Eigen::Index kBatch = 64;  // columns solved at a time
constexpr std::size_t kMostKept = 64;

/// Natural logarithm of the upper tail, where the tail itself is 0, too.
double log_p_value(double chi2, int dof) {
  if (dof == 0) return 0.0;
  const double p = chi2_p_value(chi2, dof);
  if (p > 1e-280) return std::log(p);
  return -0.5 * chi2 + (0.5 * dof - 1.0) * std::log(0.5 * chi2) - std::lgamma(0.5 * dof);
}

struct Found {
  double score = 0.0;
  int dof = 0;
  double log_p = 0.0;
  Eigen::VectorXd size;
};

class Scorer {
 public:
  Scorer(const ModelFit& fit, const RecordingSystem& system, const FitProjection& P)
      : fit_(fit), system_(system), P_(P), r_(P.times(system.residuals())) {}

  /// All places of all events; solves are shared.
  [[nodiscard]] std::vector<std::vector<Found>> score(
      const std::vector<SingleEvent>& events) const {
    std::vector<std::vector<Found>> result(events.size());
    std::vector<std::pair<std::size_t, std::size_t>> waiting;
    Eigen::Index columns = 0;
    for (std::size_t e = 0; e < events.size(); ++e) {
      result[e].resize(events[e].places.size());
      for (std::size_t place = 0; place < events[e].places.size(); ++place) {
        const Dummies& dummies = events[e].places[place];
        if (dummies.parts.size() == 1) {
          result[e][place] = alone(dummies);
        } else if (!dummies.parts.empty()) {
          waiting.push_back({e, place});
          columns += dummies.parts.front().rows.cols();
        }
        if (columns >= kBatch) solve(events, waiting, columns, result);
      }
    }
    solve(events, waiting, columns, result);
    return result;
  }

 private:
  [[nodiscard]] Found alone(const Dummies& dummies) const {
    const auto& [k, M] = dummies.parts.front();
    const auto here = r_.segment(system_.first_row(k), M.rows());
    return judge(M.transpose() * here, M.transpose() * P_.own_block(k) * M,
                 M.colwise().squaredNorm(), dummies.plausible);
  }

  void solve(const std::vector<SingleEvent>& events,
             std::vector<std::pair<std::size_t, std::size_t>>& waiting, Eigen::Index& columns,
             std::vector<std::vector<Found>>& result) const {
    const BlockSystem& normal = system_.normal_equations();
    Eigen::MatrixXd right = Eigen::MatrixXd::Zero(normal.unknowns(), columns);
    Eigen::Index at = 0;
    for (const auto& [e, place] : waiting) {
      const Dummies& dummies = events[e].places[place];
      const Eigen::Index count = dummies.parts.front().rows.cols();
      for (const auto& [k, M] : dummies.parts) {
        const Measurement& one = fit_.problem.measurements[k];
        const auto add = [&](int node, const RowsByNode& J) {
          const int size = node < 0 ? 0 : normal.size(node);
          if (size == 0) return;
          right.block(normal.offset(node), at, size, count) +=
              J.topLeftCorner(one.rows, size).transpose() * M;
        };
        add(one.from, P_.rows_of(k).from);
        add(one.to, P_.rows_of(k).to);
      }
      at += count;
    }
    const Eigen::MatrixXd x = system_.solve_nodes(right);
    at = 0;
    for (const auto& [e, place] : waiting) {
      const Dummies& dummies = events[e].places[place];
      const Eigen::Index count = dummies.parts.front().rows.cols();
      Eigen::VectorXd g = Eigen::VectorXd::Zero(count);
      Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(count, count);
      Eigen::MatrixXd aside = Eigen::MatrixXd::Zero(P_.set_aside().cols(), count);
      for (const auto& [k, M] : dummies.parts) {
        const int first = system_.first_row(k);
        g += M.transpose() * r_.segment(first, M.rows());
        whole += M.transpose() * M;
        aside += P_.set_aside().middleRows(first, M.rows()).transpose() * M;
      }
      const Eigen::MatrixXd S = whole -
                                right.middleCols(at, count).transpose() * x.middleCols(at, count) -
                                aside.transpose() * aside;
      result[e][place] = judge(g, S, whole.diagonal(), dummies.plausible);
      at += count;
    }
    waiting.clear();
    columns = 0;
  }

  /// Of what can be seen, g' S^-1 g; with a prior, as ScoreTest has it.
  [[nodiscard]] Found judge(const Eigen::VectorXd& g, const Eigen::MatrixXd& S,
                            const Eigen::VectorXd& whole, const Eigen::VectorXd& plausible) const {
    const bool prior = plausible.size() > 0;
    const double chi2 = fit_.adjustment.chi2;
    const int dof = fit_.adjustment.dof;
    const double dispersion = dof > 0 ? std::max(1.0, chi2 / dof) : 1.0;
    Found result;
    result.size = Eigen::VectorXd::Zero(g.size());
    std::vector<Eigen::Index> seen;
    for (Eigen::Index k = 0; k < g.size(); ++k) {
      bool counts = S(k, k) > (prior ? kLeastShare : kUnchecked) * whole[k] && S(k, k) > 0.0;
      if (prior) {
        counts = counts && std::sqrt(dispersion / S(k, k)) < kLargestUncertainty * plausible[k];
      }
      if (counts) seen.push_back(k);
    }
    if (seen.empty()) return result;
    const Eigen::VectorXd scale = S(seen, seen).diagonal().cwiseSqrt().cwiseInverse();
    Eigen::MatrixXd scaled = scale.asDiagonal() * S(seen, seen) * scale.asDiagonal();
    if (prior) {
      const Eigen::VectorXd sds = plausible(seen);
      scaled.diagonal() += dispersion * scale.cwiseAbs2().cwiseQuotient(sds.cwiseAbs2());
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(scaled);
    const Eigen::VectorXd along = axes.eigenvectors().transpose() * scale.cwiseProduct(g(seen));
    Eigen::VectorXd size = Eigen::VectorXd::Zero(along.size());
    for (Eigen::Index k = 0; k < along.size(); ++k) {
      if (axes.eigenvalues()[k] < kUnchecked) continue;
      ++result.dof;
      result.score += along[k] * along[k] / axes.eigenvalues()[k];
      size -= along[k] / axes.eigenvalues()[k] * axes.eigenvectors().col(k);
    }
    result.size(seen) = scale.cwiseProduct(size);
    const double left = dof > result.dof ? (chi2 - result.score) / (dof - result.dof) : 1.0;
    result.log_p = log_p_value(result.score / std::max(1.0, left), result.dof);
    return result;
  }

  const ModelFit& fit_;
  const RecordingSystem& system_;
  const FitProjection& P_;
  Eigen::VectorXd r_;
};

struct Ranked {
  EventTest test;
  double log_p = 0.0;
  const Dummies* dummies = nullptr;
};

/// Sightings that the fit leaves out, against the fit without them.
void add_left_out(const ModelFit& fit, const RecordingSystem& system, std::vector<Ranked>& ranked) {
  if (fit.adjustment.left_out.empty()) return;
  RecordingSystem whole(fit.problem, fit.columns.border);
  whole.linearise(fit.adjustment.state, fit.adjustment.coefficients);
  for (const int left_out : fit.adjustment.left_out) {
    const std::size_t k = idx(left_out);
    const Measurement& one = fit.problem.measurements[k];
    const Eigen::MatrixXd J = whole.transposed_rows(k);
    const Eigen::VectorXd r = whole.residuals().segment(whole.first_row(k), one.rows);
    const Eigen::MatrixXd R =
        Eigen::MatrixXd::Identity(one.rows, one.rows) + J.transpose() * system.solve(J);
    Ranked event;
    event.test.kind = one.kind == MeasurementKind::survey ? "landmark" : "sighting";
    event.test.name = describe(fit.problem, one);
    event.test.in_words = event.test.name + " contradicts the rest, and is left out";
    event.test.score = r.dot(R.inverse() * r);
    event.test.dof = one.rows;
    const double dispersion =
        fit.adjustment.dof > 0 ? std::max(1.0, fit.adjustment.chi2 / fit.adjustment.dof) : 1.0;
    event.log_p = log_p_value(event.test.score / dispersion, one.rows);
    event.test.measurements = {k};
    ranked.push_back(std::move(event));
  }
}

Eigen::MatrixXd dense(const Dummies& dummies, const RecordingSystem& system) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(system.rows(), dummies.parts.front().rows.cols());
  for (const auto& [k, rows] : dummies.parts) {
    M.middleRows(system.first_row(k), rows.rows()) = rows;
  }
  return M;
}

}  // namespace

std::vector<EventTest> test_events(const ModelFit& fit, const ScoreTest& tests,
                                   const Eigen::MatrixXd& aside) {
  const RecordingSystem& system = tests.system();
  const Eigen::MatrixXd apart = aside.cols() > 0 ? aside : Eigen::MatrixXd(system.rows(), 0);
  const FitProjection P(fit, fit.problem, system, apart);
  const std::vector<SingleEvent> events = single_events(fit, tests, P);
  const std::vector<std::vector<Found>> found = Scorer(fit, system, P).score(events);
  std::vector<Ranked> ranked;
  for (std::size_t e = 0; e < events.size(); ++e) {
    std::size_t best = 0;
    double tried = 0.0;
    for (std::size_t place = 0; place < found[e].size(); ++place) {
      if (found[e][place].log_p < found[e][best].log_p) best = place;
      tried += found[e][place].dof > 0 ? 1.0 : 0.0;
    }
    if (tried == 0.0) continue;
    Ranked one;
    one.test.kind = events[e].kind;
    one.test.name = events[e].name;
    one.test.in_words = events[e].words(best, found[e][best].size);
    one.test.score = found[e][best].score;
    one.test.dof = found[e][best].dof;
    one.log_p = std::min(0.0, found[e][best].log_p + std::log(tried));
    one.dummies = &events[e].places[best];
    if (one.test.kind != "session") {
      for (const DummyRows& part : one.dummies->parts) {
        one.test.measurements.push_back(part.measurement);
      }
    }
    ranked.push_back(std::move(one));
  }
  add_left_out(fit, system, ranked);
  std::vector<double> p_values;
  for (Ranked& one : ranked) {
    one.test.p_value = std::exp(one.log_p);
    p_values.push_back(one.test.p_value);
  }
  const std::vector<double> adjusted = holm(p_values);
  for (std::size_t k = 0; k < ranked.size(); ++k) ranked[k].test.p_adjusted = adjusted[k];
  // Equal to rounding is equal: then the order of the kinds decides.
  const auto key = [](const Ranked& one) { return std::round(1e6 * one.log_p); };
  std::stable_sort(ranked.begin(), ranked.end(),
                   [&](const Ranked& a, const Ranked& b) { return key(a) < key(b); });
  std::vector<EventTest> result;
  for (Ranked& one : ranked) {
    if (one.test.p_adjusted < kLevel && result.size() < kMostKept && one.dummies != nullptr) {
      one.test.projected = P.times(dense(*one.dummies, system));
    }
    result.push_back(std::move(one.test));
  }
  return result;
}

}  // namespace trussmap
