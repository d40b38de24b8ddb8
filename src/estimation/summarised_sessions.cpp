// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/summarised_sessions.hpp"

#include "geometry/index.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <stdexcept>
#include <utility>

namespace trussmap {
namespace {

constexpr double kFresh = 1e-6;  // m, rad: a new session's move from which it is taken anew
constexpr int kMostRounds = 50;
constexpr double kTrial = 0.1;   // standard deviations that a trial moves
constexpr double kSafety = 1.5;  // a trial's direction is one of many
constexpr double kMargin = 1.5;  // over what has turned out
constexpr std::uint64_t kSeed = 1;

bool same_number(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

/// How far a session's share of x has moved, in what it knows of each number alone: in H itself a
/// turn of the whole map would count as nothing.
double size_of(const Eigen::VectorXd& move, const SessionSummary::Quadratic& one) {
  return move.cwiseAbs2().dot(one.information.diagonal().cwiseAbs());
}

double largest(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0.0 : values.cwiseAbs().maxCoeff();
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

void SummarisedSessions::take_anew(Member& member, SecondDerivatives kind) {
  const bool counted = member.summary.quadratic().at.size() > 0;
  if (counted) count(member, -1.0);
  try {
    member.summary.linearise(local(member), kind);
  } catch (const SolveError&) {
    if (counted) count(member, 1.0);
    throw;
  }
  count(member, 1.0);
}

/// Takes it anew, and learns from what its summary has missed.
void SummarisedSessions::take_anew(Member& member, const DenseCholesky& factor) {
  constexpr double kTold = 1e-3;  // of the trial's move: below it all is rounding
  const Eigen::VectorXd u = local(member);
  const double moved = size_of(u - member.summary.quadratic().at, member.summary.quadratic());
  const Eigen::VectorXd predicted = member.summary.predicted_gradient(u);
  take_anew(member, SecondDerivatives::whole);
  if (!(moved > kTold * member.trial)) return;
  const Eigen::VectorXd missed = member.summary.quadratic().gradient - predicted;
  if (effect_of(member, missed, factor) * member.trial >
      effect_of(member, member.missed, factor) * moved) {
    member.missed = missed;
    member.trial = moved;
  }
}

/// The largest change of x by so much more of the session's gradient.
double SummarisedSessions::effect_of(const Member& member, const Eigen::VectorXd& missed,
                                     const DenseCholesky& factor) const {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(places_.x.size());
  gradient(member.at) = missed;
  for (const Eigen::Index at : held_) gradient[at] = 0.0;
  return largest(factor.solve(gradient));
}

/// What the summary misses of the gradient where x moves by about what it is uncertain.
void SummarisedSessions::try_out(Member& member, const DenseCholesky& factor) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd draw(places_.x.size());
  for (double& one : draw) one = kTrial * normal(random);
  Eigen::VectorXd move = factor.solve_half(draw);
  for (const Eigen::Index at : held_) move[at] = 0.0;
  const Eigen::VectorXd own = move(member.at);
  const Eigen::VectorXd there = member.summary.quadratic().at + own;
  member.trial = size_of(own, member.summary.quadratic());
  member.missed =
      member.summary.value_at(there).gradient - member.summary.predicted_gradient(there);
}

/// By how much x would change at most, by what each session's summary is thought to miss there. No
/// session counts as missing less than the mean does of a move as large: its trial may have gone in
/// a direction that suits it.
std::vector<double> SummarisedSessions::effects_of_moves(const DenseCholesky& factor) const {
  Eigen::MatrixXd missed =
      Eigen::MatrixXd::Zero(places_.x.size(), static_cast<Eigen::Index>(sessions_.size()));
  for (std::size_t s = 0; s < sessions_.size(); ++s) {
    const Member& member = sessions_[s];
    if (!(member.trial > 0.0)) continue;
    missed.col(static_cast<Eigen::Index>(s))(member.at) = member.missed / member.trial;
  }
  for (const Eigen::Index at : held_) missed.row(at).setZero();
  const Eigen::MatrixXd moved = factor.solve(missed);
  std::vector<double> effects;
  for (Eigen::Index s = 0; s < moved.cols(); ++s) effects.push_back(largest(moved.col(s)));
  const double mean =
      std::accumulate(effects.begin(), effects.end(), 0.0) / static_cast<double>(effects.size());
  for (std::size_t s = 0; s < sessions_.size(); ++s) {
    const SessionSummary::Quadratic& one = sessions_[s].summary.quadratic();
    effects[s] = std::max(effects[s], mean) * size_of(local(sessions_[s]) - one.at, one);
  }
  return effects;
}

/// The sessions of largest effect, so that those of the others add up to the tolerance at most.
std::vector<std::size_t> SummarisedSessions::worth_taking_anew(const std::vector<double>& effects,
                                                               double safety) {
  std::vector<std::size_t> order(effects.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return effects[a] < effects[b]; });
  expected_error_ = 0.0;
  std::size_t stay = 0;
  while (stay < order.size() &&
         expected_error_ + safety * effects[order[stay]] <= options_.tolerance) {
    expected_error_ += safety * effects[order[stay++]];
  }
  std::vector<std::size_t> result(order.begin() + static_cast<std::ptrdiff_t>(stay), order.end());
  std::sort(result.begin(), result.end());
  return result;
}

/// The sum's factor. Far from its minimum whole second derivatives may have none: then those of
/// Gauss and Newton stand in, first the new session's, then all.
DenseCholesky SummarisedSessions::safe_factor() {
  for (const bool all : {false, true}) {
    try {
      return factor();
    } catch (const SolveError&) {
      for (std::size_t s = all ? 0 : sessions_.size() - 1; s < sessions_.size(); ++s) {
        take_anew(sessions_[s], SecondDerivatives::gauss_newton);
      }
    }
  }
  return factor();
}

void SummarisedSessions::settle() {
  Member& fresh = sessions_.back();
  double safety = kSafety;
  double thought = 0.0;  // effects of those just taken anew
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::VectorXd change = step(safe_factor());
    places_.x += change;
    if (round == 0 || largest(local(fresh) - fresh.summary.quadratic().at) > kFresh) {
      take_anew(fresh, SecondDerivatives::whole);
      thought = 0.0;
      continue;
    }
    const DenseCholesky H = safe_factor();
    for (Member& member : sessions_) {
      if (member.summary.quadratic().kind == SecondDerivatives::whole) continue;
      take_anew(member, SecondDerivatives::whole);
    }
    if (fresh.trial == 0.0) try_out(fresh, H);
    // What sessions taken anew have turned out to miss says how far thoughts of the others are off.
    if (thought > 0.0) safety = std::max(safety, kMargin * largest(change) / thought);
    const std::vector<double> effects = effects_of_moves(H);
    const std::vector<std::size_t> again = worth_taking_anew(effects, safety);
    if (again.empty()) return;
    thought = 0.0;
    for (const std::size_t s : again) {
      take_anew(sessions_[s], H);
      thought += effects[s];
      if (s + 1 < sessions_.size()) ++taken_anew_;
    }
  }
  throw SolveError(fresh.summary.problem().sessions.front() +
                   " does not settle on the map of the other sessions");
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
  return largest(factor().solve(gradient));
}

}  // namespace trussmap
