// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "map/arrival_gate.hpp"

#include "statistics/median.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::map {
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
  // Of few, most may be wrong landmarks.
  constexpr std::size_t kFewest = 8;
  scale_ = 1.0;
  if (last_.size() < kFewest) return;
  const double middle = statistics::median({last_.begin(), last_.end()});
  scale_ = std::sqrt(std::max(1.0, middle / kChi2Median));
}

}  // namespace trussmap::map
