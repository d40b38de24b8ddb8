// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/summarised_sessions.hpp"

#include "geometry/index.hpp"
#include "text/number_text.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

namespace trussmap::estimation {
namespace {

void append_to(Eigen::VectorXd& all, const Eigen::VectorXd& values) {
  all.conservativeResize(all.size() + values.size());
  all.tail(values.size()) = values;
}

}  // namespace

std::optional<double> SummarisedSessions::orientation(int landmark) const {
  const auto at = sum_.orientation.find(landmark);
  if (at == sum_.orientation.end()) return std::nullopt;
  return sum_.x[at->second];
}

/// By two places, or by one and a direction.
void SummarisedSessions::require_tied(const SessionRows& rows,
                                      const std::vector<KnownPlace>& known) const {
  const RecordingProblem& problem = rows.problem;
  const auto is_known = [&](const std::string& landmark, bool with_heading) {
    const auto tells = [&](const KnownPlace& one) {
      return one.landmark == landmark && !(with_heading && std::isnan(one.heading));
    };
    return std::ranges::any_of(sum_.known, tells) || std::ranges::any_of(known, tells);
  };
  std::set<std::string> places;
  bool direction = false;
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    const Measurement& one = problem.measurements[k];
    if (!rows.weights.empty() && rows.weights[k] == 0.0) continue;
    if (gives_pose(one)) return;
    if (reads_compass(one)) direction = true;
    if (is_yaw(one)) {
      const std::string& landmark = problem.landmark_of(one.to);
      direction = direction || has_orientation(landmark) || is_known(landmark, true);
    }
    if (is_position(one)) places.insert(describe(problem, one));
    if (!is_sighting(one)) continue;
    const std::string& landmark = problem.landmarks[idx(one.to)];
    if (has(landmark) || is_known(landmark, false)) places.insert("landmark " + landmark);
  }
  if (places.empty()) {
    throw SolveError(problem.sessions.front() +
                     " stands apart: no landmark ties it to the sessions before");
  }
  if (places.size() > 1 || direction) return;
  throw SolveError(
      trussmap::text::joined(problem.sessions.front(), " can turn about ", *places.begin(),
                             ", by which alone it is tied to the sessions before; sight another "
                             "landmark of theirs"));
}

/// Gives what the session brings its place in x.
SummarisedSessions::Member SummarisedSessions::joined(SessionRows rows) {
  Member member{SessionSummary(std::move(rows)), {}, {}};
  const RecordingState& state = member.summary.taken().state;
  const RecordingProblem& problem = member.summary.problem();
  const auto append = [&](const Eigen::VectorXd& values) {
    const Eigen::Index at = sum_.x.size();
    append_to(sum_.x, values);
    append_to(sum_.origin, values);
    return at;
  };
  std::vector<int> numbers;
  for (std::size_t k = 0; k < problem.landmarks.size(); ++k) {
    const auto [found, fresh] =
        sum_.number.try_emplace(problem.landmarks[k], static_cast<int>(sum_.names.size()));
    if (fresh) {
      sum_.names.push_back(problem.landmarks[k]);
      sum_.at.push_back(append(state.landmarks[k]));
    }
    numbers.push_back(found->second);
    member.at.push_back(sum_.at[idx(found->second)]);
    member.at.push_back(sum_.at[idx(found->second)] + 1);
  }
  for (std::size_t k = 0; k < problem.oriented.size(); ++k) {
    const auto [found, fresh] = sum_.orientation.try_emplace(numbers[idx(problem.oriented[k])], 0);
    if (fresh) found->second = append(Eigen::VectorXd::Constant(1, state.orientations[k]));
    member.at.push_back(found->second);
  }
  for (int c = 0; c < sum_.coefficients; ++c) member.at.push_back(c);
  return member;
}

Eigen::VectorXd SummarisedSessions::local(const Member& member) const {
  return sum_.x(member.at);
}

void SummarisedSessions::count(const Member& member, double sign) {
  const SessionSummary::Quadratic& one = member.summary.quadratic();
  const Eigen::VectorXd pull = one.information * (one.at - sum_.origin(member.at)) - one.gradient;
  const auto n = static_cast<Eigen::Index>(member.at.size());
  for (Eigen::Index c = 0; c < n; ++c) {
    const Eigen::Index column = member.at[idx(static_cast<int>(c))];
    for (Eigen::Index r = 0; r < n; ++r) {
      sum_.information(member.at[idx(static_cast<int>(r))], column) += sign * one.information(r, c);
    }
    sum_.pull[column] += sign * pull[c];
  }
}

/// Priors and known places.
void SummarisedSessions::count_known() {
  for (Eigen::Index c = 0; c < sum_.coefficients; ++c) {
    sum_.information(c, c) += sum_.prior[c];
    sum_.pull[c] -= sum_.prior[c] * sum_.origin[c];
  }
  const auto count = [&](Eigen::Index at, double sd, double value) {
    const double information = 1.0 / (sd * sd);
    sum_.information(at, at) += information;
    sum_.pull[at] += information * (value - sum_.origin[at]);
  };
  for (const KnownPlace& one : sum_.known) {
    const auto number = sum_.number.find(one.landmark);
    if (number == sum_.number.end()) continue;
    const Eigen::Index at = sum_.at[idx(number->second)];
    count(at, one.sd, one.place.x());
    count(at + 1, one.sd, one.place.y());
    const auto turned = sum_.orientation.find(number->second);
    if (turned == sum_.orientation.end() || std::isnan(one.heading)) continue;
    const double now = sum_.x[turned->second];
    count(turned->second, one.sd_heading, now + wrap_angle(one.heading - now));
  }
}

void SummarisedSessions::count_all() {
  sum_.information = Eigen::MatrixXd::Zero(sum_.x.size(), sum_.x.size());
  sum_.pull = Eigen::VectorXd::Zero(sum_.x.size());
  count_known();
  for (const Member& member : sessions_) count(member, 1.0);
}

/// What no step moves: what is held, and orientations of which every yaw has been left out.
std::vector<Eigen::Index> SummarisedSessions::apart() const {
  std::vector<Eigen::Index> result = sum_.held;
  for (const auto& [landmark, at] : sum_.orientation) {
    if (sum_.information(at, at) == 0.0) result.push_back(at);
  }
  return result;
}

/// Of H, with what is apart from all else.
linalg::DenseCholesky SummarisedSessions::factor() const {
  constexpr double kLeastShare = 1e-8;  // where nothing is told rounding leaves 1e-11
  Eigen::MatrixXd H = sum_.information;
  for (const Eigen::Index at : apart()) {
    H.row(at).setZero();
    H.col(at).setZero();
    H(at, at) = 1.0;
  }
  linalg::DenseCholesky result(H);
  if (!result.positive_definite() || result.least_pivot_share() < kLeastShare) {
    throw SolveError(
        "the sessions leave the map or a coefficient undetermined; sight more landmarks, or "
        "survey one");
  }
  return result;
}

Eigen::VectorXd SummarisedSessions::step(const linalg::DenseCholesky& factor) const {
  Eigen::VectorXd gradient = sum_.information * (sum_.x - sum_.origin) - sum_.pull;
  for (const Eigen::Index at : sum_.held) gradient[at] = 0.0;
  return -factor.solve(gradient);
}

/// How x changes as the map turns by 1 rad, where nothing measures a direction: about the first
/// landmark, or about the place that turning strains least.
Eigen::VectorXd SummarisedSessions::turn_of_map(bool position) const {
  const auto n = sum_.x.size();
  const Vector2 first = sum_.x.segment<2>(sum_.at.front());
  Eigen::VectorXd turn = Eigen::VectorXd::Zero(n);
  Eigen::MatrixXd shifts = Eigen::MatrixXd::Zero(n, 2);
  for (const Eigen::Index at : sum_.at) {
    turn.segment<2>(at) = quarter_turn(Vector2(sum_.x.segment<2>(at) - first));
    shifts.block<2, 2>(at, 0).setIdentity();
  }
  for (const auto& [landmark, at] : sum_.orientation) turn[at] = 1.0;
  if (!position) return turn;
  const Eigen::MatrixXd strains = sum_.information * shifts;
  const Matrix2 stiffness = shifts.transpose() * strains;
  return turn - shifts * stiffness.ldlt().solve(strains.transpose() * turn);
}

void SummarisedSessions::hold(bool position, bool direction) {
  sum_.held.clear();
  if (sum_.at.empty()) return;
  if (!position) sum_.held = {sum_.at.front(), sum_.at.front() + 1};
  if (direction) return;
  const Eigen::VectorXd turn = turn_of_map(position);
  Eigen::Index most = sum_.at.front();
  for (const Eigen::Index at : sum_.at) {
    for (const Eigen::Index place : {at, at + 1}) {
      if (std::abs(turn[place]) > std::abs(turn[most])) most = place;
    }
  }
  if (std::abs(turn[most]) > 0.0) sum_.held.push_back(most);
}

/// With the coefficients of the first session.
void SummarisedSessions::begin(const EffectParameters& border) {
  sum_ = {};
  for (const int place : unknown_coefficients(border)) {
    const double sd = border[idx(place)].prior_sd;
    append_to(sum_.prior, Eigen::VectorXd::Constant(1, 1.0 / (sd * sd)));
  }
  sum_.coefficients = static_cast<int>(sum_.prior.size());
  sum_.x = sum_.origin = Eigen::VectorXd::Zero(sum_.coefficients);
}

/// Sessions come with copies of one survey: the same numbers count once.
void SummarisedSessions::know(const std::vector<KnownPlace>& known) {
  for (KnownPlace one : known) {
    const auto is_same_place = [&](const KnownPlace& other) {
      return other.landmark == one.landmark && other.place == one.place;
    };
    const auto has_same_heading = [&](const KnownPlace& other) {
      return is_same_place(other) && other.heading == one.heading;
    };
    if (std::ranges::any_of(sum_.known, is_same_place)) {
      if (std::isnan(one.heading) || std::ranges::any_of(sum_.known, has_same_heading)) continue;
      one.sd = std::numeric_limits<double>::infinity();
    }
    sum_.known.push_back(one);
  }
}

void SummarisedSessions::take_in(SessionRows rows, const std::vector<KnownPlace>& known) {
  const bool first = sessions_.empty();
  const bool position = rows.tells_position;
  const bool direction = rows.tells_direction;
  if (first) begin(rows.border);
  know(known);
  sum_.relinearised = 0;
  sessions_.push_back(joined(std::move(rows)));
  sessions_.back().summary.linearise(local(sessions_.back()), SecondDerivatives::gauss_newton);
  count_all();
  if (first) hold(position, direction);
  settle();
}

/// To what there was before a session that cannot be taken in.
void SummarisedSessions::go_back(Sum before, std::size_t sessions) {
  sessions_.erase(sessions_.begin() + static_cast<std::ptrdiff_t>(sessions), sessions_.end());
  for (Member& member : sessions_) {
    if (!member.before) continue;
    member.summary.restore(std::move(member.before->taken));
    member.missed = std::move(member.before->missed);
    member.trial = member.before->trial;
    member.before.reset();
  }
  sum_ = std::move(before);
}

void SummarisedSessions::add(SessionRows rows, const std::vector<KnownPlace>& known) {
  if (!sessions_.empty()) {
    if (static_cast<int>(unknown_coefficients(rows.border).size()) != sum_.coefficients) {
      throw std::invalid_argument("every session has the same coefficients");
    }
    require_tied(rows, known);
  }
  Sum before = sum_;
  const std::size_t count = sessions_.size();
  try {
    take_in(std::move(rows), known);
  } catch (...) {
    go_back(std::move(before), count);
    throw;
  }
  for (Member& member : sessions_) member.before.reset();
}

double SummarisedSessions::chi2() const {
  double half = 0.0;
  for (const Member& member : sessions_) {
    const SessionSummary::Quadratic& one = member.summary.quadratic();
    const Eigen::VectorXd move = local(member) - one.at;
    half += one.half_chi2 + one.gradient.dot(move) + 0.5 * move.dot(one.information * move);
  }
  double chi2 = 2.0 * half + sum_.x.head(sum_.coefficients).cwiseAbs2().dot(sum_.prior);
  for (const KnownPlace& one : sum_.known) {
    const auto number = sum_.number.find(one.landmark);
    if (number == sum_.number.end()) continue;
    chi2 += (position(number->second) - one.place).squaredNorm() / (one.sd * one.sd);
    const std::optional<double> turned = orientation(number->second);
    if (!turned || std::isnan(one.heading)) continue;
    const double off = wrap_angle(*turned - one.heading) / one.sd_heading;
    chi2 += off * off;
  }
  return chi2;
}

int SummarisedSessions::dof() const {
  int values = static_cast<int>(sum_.held.size()) - static_cast<int>(sum_.x.size());
  for (const Member& member : sessions_) {
    values += member.summary.measured_values() - member.summary.own_unknowns();
  }
  for (Eigen::Index c = 0; c < sum_.coefficients; ++c) values += sum_.prior[c] > 0.0 ? 1 : 0;
  for (const KnownPlace& one : sum_.known) {
    const auto number = sum_.number.find(one.landmark);
    if (number == sum_.number.end()) continue;
    if (std::isfinite(one.sd)) values += 2;
    if (sum_.orientation.contains(number->second) && !std::isnan(one.heading)) ++values;
  }
  return values;
}

Eigen::MatrixXd SummarisedSessions::covariance() const {
  Eigen::MatrixXd result = factor().inverse();
  for (const Eigen::Index at : apart()) result(at, at) = 0.0;
  return result;
}

std::vector<Matrix2> SummarisedSessions::landmark_covariances() const {
  const Eigen::MatrixXd all = covariance();
  std::vector<Matrix2> result;
  for (const Eigen::Index at : sum_.at) result.push_back(all.block<2, 2>(at, at));
  return result;
}

Eigen::MatrixXd SummarisedSessions::coefficient_covariance() const {
  return covariance().topLeftCorner(sum_.coefficients, sum_.coefficients);
}

}  // namespace trussmap::estimation
