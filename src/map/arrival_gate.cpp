// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/arrival_gate.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace trussmap {
namespace {

constexpr std::size_t kRemembered = 50;
constexpr double kChi2Median = 1.3862943611198906;  // 2 degrees of freedom

}  // namespace

bool ArrivalGate::lets_in(double squared_misfit) const {
  return !(squared_misfit > gate_ * gate_ * scale_ * scale_);
}

void ArrivalGate::remember(double squared_misfit) {
  last_.push_back(squared_misfit);
  if (last_.size() > kRemembered) last_.pop_front();
  std::vector<double> sorted(last_.begin(), last_.end());
  const auto middle = sorted.begin() + std::ssize(sorted) / 2;
  std::nth_element(sorted.begin(), middle, sorted.end());
  // One or two alone say nothing of the others.
  constexpr std::size_t kFewest = 3;
  scale_ = last_.size() < kFewest ? 1.0 : std::sqrt(std::max(1.0, *middle / kChi2Median));
}

}  // namespace trussmap
