// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/summarised_sessions.hpp"

#include "geometry/index.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

bool same_number(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

}  // namespace

std::optional<double> SummarisedSessions::orientation(int landmark) const {
  const auto at = places_.orientation.find(landmark);
  if (at == places_.orientation.end()) return std::nullopt;
  return places_.x[at->second];
}

/// By a landmark of the map, or to the map's frame.
bool SummarisedSessions::is_tied(const RecordingProblem& problem) const {
  return std::ranges::any_of(problem.landmarks, [&](const auto& one) { return has(one); }) ||
         std::ranges::any_of(problem.measurements, [](const Measurement& one) {
           return one.kind == MeasurementKind::truth || one.kind == MeasurementKind::fix;
         });
}

/// Gives what the session brings its place in x.
SummarisedSessions::Member SummarisedSessions::joined(SessionRows rows) {
  const RecordingState state = rows.state;
  Member member{SessionSummary(std::move(rows)), {}, {}, 0.0};
  const RecordingProblem& problem = member.summary.problem();
  const auto append = [&](const Eigen::VectorXd& values) {
    const Eigen::Index at = places_.x.size();
    for (Eigen::VectorXd* all : {&places_.x, &places_.origin}) {
      all->conservativeResize(at + values.size());
      all->tail(values.size()) = values;
    }
    return at;
  };
  std::vector<int> numbers;
  for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
    const auto [found, fresh] =
        places_.number.try_emplace(problem.landmarks[k], static_cast<int>(places_.names.size()));
    if (fresh) {
      places_.names.push_back(problem.landmarks[k]);
      places_.at.push_back(append(state.landmarks[k]));
    }
    numbers.push_back(found->second);
    member.at.push_back(places_.at[idx(found->second)]);
    member.at.push_back(places_.at[idx(found->second)] + 1);
  }
  for (std::size_t k = 0; k < problem.oriented.size(); ++k) {
    const auto [found, fresh] =
        places_.orientation.try_emplace(numbers[idx(problem.oriented[k])], 0);
    if (fresh) found->second = append(Eigen::VectorXd::Constant(1, state.orientations[k]));
    member.at.push_back(found->second);
  }
  for (int c = 0; c < coefficients_; ++c) member.at.push_back(c);
  return member;
}

Eigen::VectorXd SummarisedSessions::local(const Member& member) const {
  return places_.x(member.at);
}

void SummarisedSessions::count(const Member& member, double sign) {
  const SessionSummary::Quadratic& one = member.summary.quadratic();
  const Eigen::VectorXd pull =
      one.information * (one.at - places_.origin(member.at)) - one.gradient;
  const auto n = static_cast<Eigen::Index>(member.at.size());
  for (Eigen::Index c = 0; c < n; ++c) {
    const Eigen::Index column = member.at[idx(static_cast<int>(c))];
    for (Eigen::Index r = 0; r < n; ++r) {
      information_(member.at[idx(static_cast<int>(r))], column) += sign * one.information(r, c);
    }
    pull_[column] += sign * pull[c];
  }
}

/// Priors and known places.
void SummarisedSessions::count_known() {
  for (Eigen::Index c = 0; c < coefficients_; ++c) {
    information_(c, c) += prior_[c];
    pull_[c] -= prior_[c] * places_.origin[c];
  }
  const auto count = [&](Eigen::Index at, double sd, double value) {
    const double information = 1.0 / (sd * sd);
    information_(at, at) += information;
    pull_[at] += information * (value - places_.origin[at]);
  };
  for (const KnownPlace& one : places_.known) {
    const auto number = places_.number.find(one.landmark);
    if (number == places_.number.end()) continue;
    const Eigen::Index at = places_.at[idx(number->second)];
    count(at, one.sd, one.place.x());
    count(at + 1, one.sd, one.place.y());
    const auto turned = places_.orientation.find(number->second);
    if (turned == places_.orientation.end() || std::isnan(one.heading)) continue;
    const double now = places_.x[turned->second];
    count(turned->second, one.sd_heading, now + wrap_angle(one.heading - now));
  }
}

void SummarisedSessions::count_all() {
  information_ = Eigen::MatrixXd::Zero(places_.x.size(), places_.x.size());
  pull_ = Eigen::VectorXd::Zero(places_.x.size());
  count_known();
  for (const Member& member : sessions_) count(member, 1.0);
}

/// Of H, with what is held apart from all else.
DenseCholesky SummarisedSessions::factor() const {
  Eigen::MatrixXd H = information_;
  for (const Eigen::Index at : held_) {
    H.row(at).setZero();
    H.col(at).setZero();
    H(at, at) = 1.0;
  }
  DenseCholesky result(H);
  if (!result.positive_definite()) {
    throw SolveError(
        "the sessions leave the map or a coefficient undetermined; sight more landmarks, or "
        "survey one");
  }
  return result;
}

Eigen::VectorXd SummarisedSessions::step(const DenseCholesky& factor) const {
  Eigen::VectorXd gradient = information_ * (places_.x - places_.origin) - pull_;
  for (const Eigen::Index at : held_) gradient[at] = 0.0;
  return -factor.solve(gradient);
}

void SummarisedSessions::hold(bool position, bool direction) {
  held_.clear();
  if (places_.at.empty()) return;
  const Eigen::Index first = places_.at.front();
  if (!position) held_ = {first, first + 1};
  if (direction) return;
  Eigen::Index most = -1;
  double lever = 0.0;
  for (const Eigen::Index at : places_.at) {
    const Vector2 from_first = places_.x.segment<2>(at) - places_.x.segment<2>(first);
    for (const int place : {0, 1}) {
      if (std::abs(from_first[1 - place]) <= lever) continue;
      lever = std::abs(from_first[1 - place]);
      most = at + place;
    }
  }
  if (most >= 0) held_.push_back(most);
}

void SummarisedSessions::add(SessionRows rows, const std::vector<KnownPlace>& known) {
  const std::vector<int> unknown = unknown_coefficients(rows.border);
  const bool first = sessions_.empty();
  if (!first && static_cast<int>(unknown.size()) != coefficients_) {
    throw std::invalid_argument("every session has the same coefficients");
  }
  if (first) {
    coefficients_ = static_cast<int>(unknown.size());
    prior_.resize(coefficients_);
    for (int c = 0; c < coefficients_; ++c) {
      const double sd = rows.border[idx(unknown[idx(c)])].prior_sd;
      prior_[c] = 1.0 / (sd * sd);
    }
    places_.x = places_.origin = Eigen::VectorXd::Zero(coefficients_);
  }
  if (!first && !is_tied(rows.problem)) {
    throw SolveError(rows.problem.sessions.front() +
                     " stands apart: no landmark ties it to the sessions before");
  }
  const Places before = places_;
  for (const KnownPlace& one : known) {
    const bool copy =
        std::any_of(places_.known.begin(), places_.known.end(), [&](const KnownPlace& other) {
          return other.landmark == one.landmark && other.place == one.place &&
                 same_number(other.heading, one.heading);
        });
    if (!copy) places_.known.push_back(one);
  }
  taken_anew_ = 0;
  const std::size_t count = sessions_.size();
  try {
    const bool position = rows.tells_position;
    const bool direction = rows.tells_direction;
    sessions_.push_back(joined(std::move(rows)));
    if (first) hold(position, direction);
    sessions_.back().summary.linearise(local(sessions_.back()), SecondDerivatives::gauss_newton);
    count_all();
    settle();
  } catch (const SolveError&) {
    // Others that were taken anew stay so: each is what its session says, wherever it was taken.
    places_ = before;
    sessions_.erase(sessions_.begin() + static_cast<std::ptrdiff_t>(count), sessions_.end());
    count_all();
    throw;
  }
}

double SummarisedSessions::chi2() const {
  double half = 0.0;
  for (const Member& member : sessions_) {
    const SessionSummary::Quadratic& one = member.summary.quadratic();
    const Eigen::VectorXd move = local(member) - one.at;
    half += one.half_chi2 + one.gradient.dot(move) + 0.5 * move.dot(one.information * move);
  }
  double chi2 = 2.0 * half + places_.x.head(coefficients_).cwiseAbs2().dot(prior_);
  for (const KnownPlace& one : places_.known) {
    const auto number = places_.number.find(one.landmark);
    if (number == places_.number.end()) continue;
    chi2 += (position(number->second) - one.place).squaredNorm() / (one.sd * one.sd);
    const std::optional<double> turned = orientation(number->second);
    if (!turned || std::isnan(one.heading)) continue;
    const double off = wrap_angle(*turned - one.heading) / one.sd_heading;
    chi2 += off * off;
  }
  return chi2;
}

int SummarisedSessions::dof() const {
  int values = static_cast<int>(held_.size()) - static_cast<int>(places_.x.size());
  for (const Member& member : sessions_) {
    values += member.summary.measured_values() - member.summary.own_unknowns();
  }
  for (Eigen::Index c = 0; c < coefficients_; ++c) values += prior_[c] > 0.0 ? 1 : 0;
  for (const KnownPlace& one : places_.known) {
    const auto number = places_.number.find(one.landmark);
    if (number == places_.number.end()) continue;
    values += 2;
    if (places_.orientation.contains(number->second) && !std::isnan(one.heading)) ++values;
  }
  return values;
}

Eigen::MatrixXd SummarisedSessions::covariance() const {
  Eigen::MatrixXd result = factor().inverse();
  for (const Eigen::Index at : held_) result(at, at) = 0.0;
  return result;
}

std::vector<Matrix2> SummarisedSessions::landmark_covariances() const {
  const Eigen::MatrixXd all = covariance();
  std::vector<Matrix2> result;
  for (const Eigen::Index at : places_.at) result.push_back(all.block<2, 2>(at, at));
  return result;
}

Eigen::MatrixXd SummarisedSessions::coefficient_covariance() const {
  return covariance().topLeftCorner(coefficients_, coefficients_);
}

RecordingState SummarisedSessions::path(int session) {
  Member& member = sessions_[idx(session)];
  return member.summary.state_at(local(member));
}

double SummarisedSessions::exact_error() {
  Eigen::VectorXd gradient = information_ * (places_.x - places_.origin) - pull_;
  for (Member& member : sessions_) {
    const Eigen::VectorXd u = local(member);
    const Eigen::VectorXd missed =
        member.summary.value_at(u).gradient - member.summary.predicted_gradient(u);
    for (std::size_t k = 0; k < member.at.size(); ++k) {
      gradient[member.at[k]] += missed[static_cast<Eigen::Index>(k)];
    }
  }
  for (const Eigen::Index at : held_) gradient[at] = 0.0;
  return factor().solve(gradient).cwiseAbs().maxCoeff();
}

}  // namespace trussmap
