// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/event_tests.hpp"

#include "criticism/event_scores.hpp"
#include "criticism/single_events.hpp"
#include "fit/fit_projection.hpp"
#include "statistics/distributions.hpp"
#include "statistics/multiple_tests.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <Eigen/LU>

namespace trussmap::criticism {
namespace {

constexpr std::size_t kMostKept = 64;

struct Ranked {
  TestedEvent test;
  double log_p = 0.0;
  const Dummies* dummies = nullptr;
};

/// Sightings that the fit leaves out, against the fit without them.
void add_left_out(const fitting::FitState& fit, const ScoreTest& tests,
                  std::vector<Ranked>& ranked) {
  if (fit.adjustment.left_out.empty()) return;
  estimation::RecordingSystem whole(fit.problem, fit.columns.border);
  whole.linearise(fit.adjustment.state, fit.adjustment.coefficients);
  const std::shared_ptr<const estimation::FittedRows> fitted = tests.fitted_rows();
  for (const int left_out : fit.adjustment.left_out) {
    const std::size_t k = idx(left_out);
    const estimation::Measurement& one = fit.problem.measurements[k];
    const Eigen::VectorXd r = whole.residuals().segment(whole.first_row(k), one.rows);
    const Eigen::MatrixXd R =
        Eigen::MatrixXd::Identity(one.rows, one.rows) + fitted->covariance(whole, k);
    Ranked event;
    event.test.kind =
        estimation::is_surveyed_place(one) ? EventKind::landmark : EventKind::sighting;
    event.test.name = estimation::describe(fit.problem, one);
    event.test.change = EventChange::left_out;
    event.test.score = r.dot(R.inverse() * r);
    event.test.dof = one.rows;
    const double dispersion =
        fit.adjustment.dof > 0 ? std::max(1.0, fit.adjustment.chi2 / fit.adjustment.dof) : 1.0;
    event.log_p = statistics::log_chi2_p_value(event.test.score / dispersion, one.rows);
    event.test.measurements = {k};
    ranked.push_back(std::move(event));
  }
}

Eigen::MatrixXd dense(const Dummies& dummies, const estimation::RecordingSystem& system) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(system.rows(), dummies.parts.front().rows.cols());
  for (const auto& [k, rows] : dummies.parts) {
    M.middleRows(system.first_row(k), rows.rows()) = rows;
  }
  return M;
}

/// As EventChange has it: a session without compass has none of its offset.
std::vector<double> size_of(const Found& found, EventChange change) {
  std::vector<double> size(found.size.begin(), found.size.end());
  if (change == EventChange::session_off && size.size() < 4) {
    size.insert(size.begin() + 2, std::numeric_limits<double>::quiet_NaN());
  }
  return size;
}

}  // namespace

std::vector<TestedEvent> test_events(const fitting::FitState& fit, const ScoreTest& tests,
                                     const Eigen::MatrixXd& nuisance) {
  const estimation::RecordingSystem& system = tests.system();
  const Eigen::MatrixXd apart = nuisance.cols() > 0 ? nuisance : Eigen::MatrixXd(system.rows(), 0);
  const fitting::FitProjection P(fit, fit.problem, system, apart, tests.fitted_rows());
  const std::vector<SingleEvent> events = single_events(fit, tests, P);
  const std::vector<Scored> scored = score_events(fit, system, P, events);
  std::vector<Ranked> ranked;
  for (std::size_t e = 0; e < events.size(); ++e) {
    const std::vector<Found>& found = scored[e].places;
    std::size_t best = 0;
    for (std::size_t place = 1; place < found.size(); ++place) {
      if (found[place].log_p < found[best].log_p) best = place;
    }
    if (found[best].dof == 0) continue;
    Ranked one;
    one.test.kind = events[e].kind;
    one.test.name = events[e].name;
    one.test.change = events[e].places[best].change;
    one.test.when = events[e].places[best].when;
    one.test.size = size_of(found[best], one.test.change);
    one.test.score = found[best].score;
    one.test.dof = found[best].dof;
    one.log_p = std::min(0.0, found[best].log_p + std::log(scored[e].tried));
    one.dummies = &events[e].places[best];
    if (one.test.kind != EventKind::session) {
      for (const DummyRows& part : one.dummies->parts) {
        one.test.measurements.push_back(part.measurement);
      }
    }
    ranked.push_back(std::move(one));
  }
  add_left_out(fit, tests, ranked);
  std::vector<double> p_values;
  for (Ranked& one : ranked) {
    one.test.p_value = std::exp(one.log_p);
    p_values.push_back(one.test.p_value);
  }
  const std::vector<double> adjusted = statistics::holm(p_values);
  for (std::size_t k = 0; k < ranked.size(); ++k) ranked[k].test.p_adjusted = adjusted[k];
  // Equal to rounding is equal: then the order of the kinds decides.
  const auto key = [](const Ranked& one) { return std::round(1e6 * one.log_p); };
  std::stable_sort(ranked.begin(), ranked.end(),
                   [&](const Ranked& a, const Ranked& b) { return key(a) < key(b); });
  std::vector<TestedEvent> result;
  for (Ranked& one : ranked) {
    if (one.test.p_adjusted < kSignificance && result.size() < kMostKept &&
        one.dummies != nullptr) {
      one.test.projected = P.times(dense(*one.dummies, system));
    }
    result.push_back(std::move(one.test));
  }
  return result;
}

}  // namespace trussmap::criticism
