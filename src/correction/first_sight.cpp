// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/correction/first_sight.hpp"

#include <algorithm>
#include <stdexcept>

#include <Eigen/LU>

namespace trussmap {

std::vector<Vector2> chain_displacements(const std::vector<Matrix2>& stiffnesses,
                                         const Vector2& imposed) {
  if (stiffnesses.empty()) throw std::invalid_argument("a chain has at least one bar");
  std::vector<Matrix2> compliances;  // S_1 ... S_n
  compliances.reserve(stiffnesses.size());
  Matrix2 sum = Matrix2::Zero();
  for (const Matrix2& B : stiffnesses) {
    sum += B.inverse();
    compliances.push_back(sum);
  }
  const Vector2 force = sum.inverse() * imposed;
  std::vector<Vector2> result;
  result.reserve(compliances.size());
  for (const Matrix2& S : compliances) result.push_back(S * force);
  result.back() = imposed;
  return result;
}

void OpenChain::restart(int landmark) {
  chain_ = {landmark};
}

void OpenChain::append(int a, int b) {
  if (chain_.empty() || chain_.back() != a) chain_ = {a};
  chain_.push_back(b);
}

OpenChain::Closing OpenChain::closing(int a, int b) const {
  const std::vector<int> alone{a};
  const std::vector<int>& chain = chain_.empty() || chain_.back() != a ? alone : chain_;
  const auto find = [&chain](int landmark) {
    return std::find(chain.begin(), chain.end(), landmark);
  };
  // From b up the loops it hangs on, until one is on the chain.
  int k = b;
  auto place = find(k);
  for (auto up = root_.find(k); place == chain.end() && up != root_.end(); up = root_.find(k)) {
    k = up->second;
    place = find(k);
  }
  if (place == chain.end()) place = chain.begin();
  return {std::vector<int>(place, chain.end()), *place == b};
}

void OpenChain::settle(const Closing& closing, int b) {
  const int k = closing.landmarks.front();
  for (std::size_t n = 1; n < closing.landmarks.size(); ++n) root_[closing.landmarks[n]] = k;
  if (!closing.closed) {
    chain_ = {b};
  } else if (const auto place = std::find(chain_.begin(), chain_.end(), k); place != chain_.end()) {
    chain_.erase(place + 1, chain_.end());
  } else {
    chain_ = {k};
  }
}

}  // namespace trussmap
