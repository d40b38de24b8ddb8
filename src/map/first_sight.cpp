// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/first_sight.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

#include <Eigen/LU>

namespace trussmap::map {

std::vector<Vector2> chain_displacements(const std::vector<Matrix2>& stiffnesses,
                                         const Vector2& imposed) {
  if (stiffnesses.empty()) throw std::invalid_argument("a chain has at least one bar");
  std::vector<TurningLeg> legs(stiffnesses.size());  // that do not turn: places do not matter
  for (std::size_t e = 0; e < legs.size(); ++e) legs[e].compliance = stiffnesses[e].inverse();
  return turning_displacements(legs, Vector2::Zero(), imposed);
}

std::vector<Vector2> turning_displacements(const std::vector<TurningLeg>& legs, const Vector2& end,
                                           const Vector2& imposed) {
  Matrix2 yields = Matrix2::Zero();
  for (const TurningLeg& leg : legs) {
    const Vector2 lever = quarter_turn(end - leg.from);
    yields += leg.compliance + leg.turning * lever * lever.transpose();
  }
  const Vector2 lambda = yields.inverse() * imposed;
  std::vector<Vector2> result(legs.size(), Vector2::Zero());
  if (!lambda.allFinite()) return result;
  Vector2 stretched = Vector2::Zero();
  double turned = 0.0;
  Vector2 about = Vector2::Zero();  // sum of phi_e p_e
  for (std::size_t e = 0; e < legs.size(); ++e) {
    const TurningLeg& leg = legs[e];
    const double phi = leg.turning * lambda.dot(quarter_turn(end - leg.from));
    stretched += leg.compliance * lambda;
    turned += phi;
    about += phi * leg.from;
    const Vector2& at = e + 1 < legs.size() ? legs[e + 1].from : end;
    result[e] = stretched + quarter_turn(turned * at - about);
  }
  result.back() = imposed;
  return result;
}

void OpenChain::reserve(int count) {
  const std::size_t size = idx(count);
  if (chain_.capacity() < size) chain_.reserve(std::max(size, 2 * chain_.capacity()));
  if (root_.size() < size) root_.resize(std::max(size, 2 * root_.size()), -1);
}

void OpenChain::restart(int landmark) {
  reserve(landmark + 1);
  chain_.assign(1, landmark);
}

void OpenChain::append(int a, int b) {
  reserve(std::max({a, b, static_cast<int>(chain_.size())}) + 1);
  if (chain_.empty() || chain_.back() != a) chain_.assign(1, a);
  chain_.push_back(b);
}

OpenChain::Closing OpenChain::closing(int a, int b) const {
  const std::vector<int> alone{a};
  const std::vector<int>& chain = chain_.empty() || chain_.back() != a ? alone : chain_;
  // Up the loops that b hangs on. A landmark of the chain other than its first hangs on nothing
  // yet, so it is met at the top or not at all; in any other case the loop begins with the first.
  const auto place = std::find(chain.rbegin(), chain.rend(), top_of(b));
  const auto begin = place == chain.rend() ? chain.begin() : std::prev(place.base());
  return {std::vector<int>(begin, chain.end()), *begin == b};
}

int OpenChain::above(int landmark) const {
  return idx(landmark) < root_.size() ? root_[idx(landmark)] : -1;
}

int OpenChain::top_of(int landmark) const {
  while (above(landmark) >= 0) landmark = above(landmark);
  return landmark;
}

void OpenChain::settle(const Closing& closing, int b) noexcept {
  const int k = closing.landmarks.front();
  for (std::size_t n = 1; n < closing.landmarks.size(); ++n) root_[idx(closing.landmarks[n])] = k;
  // Shortcuts, or the way up would grow with the map.
  const int top = top_of(b);
  for (int landmark = b; above(landmark) >= 0;) landmark = std::exchange(root_[idx(landmark)], top);
  if (!closing.closed) {
    chain_.assign(1, b);
  } else if (const auto place = std::find(chain_.rbegin(), chain_.rend(), k);
             place != chain_.rend()) {
    chain_.erase(place.base(), chain_.end());
  } else {
    chain_.assign(1, k);
  }
}

}  // namespace trussmap::map
