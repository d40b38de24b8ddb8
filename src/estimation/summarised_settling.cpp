// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// To the minimum of the sum, and which sessions are relinearised on the way.
#include "estimation/summarised_sessions.hpp"
#include "geometry/index.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>

namespace trussmap::estimation {
namespace {

constexpr double kFresh = 1e-6;  // m, rad: a new session's move from which it is relinearised
constexpr int kMostRounds = 50;
constexpr double kTrial = 0.1;   // standard deviations that a trial moves
constexpr double kSafety = 1.5;  // a trial's direction is one of many
constexpr double kMargin = 1.5;  // over what has turned out
constexpr std::uint64_t kSeed = 1;

/// How far a session's share of x has moved, in what it knows of each number alone: in H itself a
/// turn of the whole map would count as nothing.
double size_of(const Eigen::VectorXd& move, const SessionSummary::Quadratic& one) {
  return move.cwiseAbs2().dot(one.information.diagonal().cwiseAbs());
}

double largest(const Eigen::VectorXd& values) {
  return values.size() == 0 ? 0.0 : values.cwiseAbs().maxCoeff();
}

}  // namespace

void SummarisedSessions::take_anew(Member& member, SecondDerivatives kind) {
  if (&member != &sessions_.back()) {
    ++sum_.relinearised;
    if (!member.before) {
      member.before = {member.summary.taken(), member.missed, member.trial};
    }
  }
  count(member, -1.0);
  member.summary.linearise(local(member), kind);
  count(member, 1.0);
}

/// Takes it anew, and learns from what its summary has missed.
void SummarisedSessions::take_anew(Member& member, const linalg::DenseCholesky& factor) {
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
                                     const linalg::DenseCholesky& factor) const {
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(sum_.x.size());
  gradient(member.at) = missed;
  for (const Eigen::Index at : sum_.held) gradient[at] = 0.0;
  return largest(factor.solve(gradient));
}

/// What the summary misses of the gradient where x moves by about what it is uncertain.
void SummarisedSessions::try_out(Member& member, const linalg::DenseCholesky& factor) {
  std::mt19937_64 random(kSeed);
  std::normal_distribution<double> normal;
  Eigen::VectorXd draw(sum_.x.size());
  for (double& one : draw) one = kTrial * normal(random);
  Eigen::VectorXd move = factor.solve_half(draw);
  for (const Eigen::Index at : sum_.held) move[at] = 0.0;
  const Eigen::VectorXd own = move(member.at);
  const Eigen::VectorXd there = member.summary.quadratic().at + own;
  member.trial = size_of(own, member.summary.quadratic());
  member.missed =
      member.summary.value_at(there).gradient - member.summary.predicted_gradient(there);
}

/// By how much x would change at most, by what each session's summary is thought to miss there. No
/// session counts as missing less than the mean does of a move as large: its trial may have gone in
/// a direction that suits it.
std::vector<double> SummarisedSessions::effects_of_moves(
    const linalg::DenseCholesky& factor) const {
  Eigen::MatrixXd missed =
      Eigen::MatrixXd::Zero(sum_.x.size(), static_cast<Eigen::Index>(sessions_.size()));
  for (std::size_t s = 0; s < sessions_.size(); ++s) {
    const Member& member = sessions_[s];
    if (!(member.trial > 0.0)) continue;
    missed.col(static_cast<Eigen::Index>(s))(member.at) = member.missed / member.trial;
  }
  for (const Eigen::Index at : sum_.held) missed.row(at).setZero();
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
                                                               double safety) const {
  std::vector<std::size_t> order(effects.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return effects[a] < effects[b]; });
  double left = 0.0;
  std::size_t stay = 0;
  while (stay < order.size() && left + safety * effects[order[stay]] <= options_.tolerance) {
    left += safety * effects[order[stay++]];
  }
  std::vector<std::size_t> result(order.begin() + static_cast<std::ptrdiff_t>(stay), order.end());
  std::sort(result.begin(), result.end());
  return result;
}

/// The sum's factor. Far from its minimum whole second derivatives may have none: then those of
/// Gauss and Newton stand in, first the new session's, then all.
linalg::DenseCholesky SummarisedSessions::safe_factor() {
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

/// Those of which Gauss and Newton's second derivatives stood in; whether there was one.
bool SummarisedSessions::take_wholly() {
  bool any = false;
  for (Member& member : sessions_) {
    if (member.summary.quadratic().kind == SecondDerivatives::whole) continue;
    take_anew(member, SecondDerivatives::whole);
    any = true;
  }
  return any;
}

void SummarisedSessions::settle() {
  Member& fresh = sessions_.back();
  double safety = kSafety;
  double thought = 0.0;  // effects of those just relinearised
  for (int round = 0; round < kMostRounds; ++round) {
    const Eigen::VectorXd change = step(safe_factor());
    sum_.x += change;
    if (round == 0 || largest(local(fresh) - fresh.summary.quadratic().at) > kFresh) {
      take_anew(fresh, SecondDerivatives::whole);
      thought = 0.0;
      continue;
    }
    const linalg::DenseCholesky H = safe_factor();
    if (take_wholly()) {
      thought = 0.0;
      continue;
    }
    if (fresh.trial == 0.0) try_out(fresh, H);
    // What sessions relinearised have turned out to miss says how far thoughts of the others are
    // off.
    if (thought > 0.0) safety = std::max(safety, kMargin * largest(change) / thought);
    const std::vector<double> effects = effects_of_moves(H);
    const std::vector<std::size_t> again = worth_taking_anew(effects, safety);
    if (again.empty()) return;
    thought = 0.0;
    for (const std::size_t s : again) {
      take_anew(sessions_[s], H);
      thought += effects[s];
    }
  }
  throw SolveError(fresh.summary.problem().sessions.front() +
                   " does not settle on the map of the other sessions");
}

double SummarisedSessions::exact_error() {
  Eigen::VectorXd gradient = sum_.information * (sum_.x - sum_.origin) - sum_.pull;
  for (Member& member : sessions_) {
    const Eigen::VectorXd u = local(member);
    const Eigen::VectorXd missed =
        member.summary.value_at(u).gradient - member.summary.predicted_gradient(u);
    for (std::size_t k = 0; k < member.at.size(); ++k) {
      gradient[member.at[k]] += missed[static_cast<Eigen::Index>(k)];
    }
  }
  for (const Eigen::Index at : sum_.held) gradient[at] = 0.0;
  return largest(factor().solve(gradient));
}

}  // namespace trussmap::estimation
