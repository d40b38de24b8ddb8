// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/causal_variables.hpp"

#include <cmath>

namespace trussmap::drive {
namespace {

/// The sense of a wheel's motion after this travel.
double sense_after(double sense, double travel) {
  if (std::abs(travel) < kMoving) return sense;
  return travel > 0.0 ? 1.0 : -1.0;
}

double reversal(double before, double after) {
  return before != 0.0 && after != before ? 1.0 : 0.0;
}

}  // namespace

std::size_t CausalVariables::window(MotionKind kind, double middle) const {
  if (kind != kind_) return past_.size();
  std::size_t first = first_;
  while (first < past_.size() && middle - past_[first].middle > kRateWindow + 1e-9) ++first;
  return first;
}

CausalRow CausalVariables::next(const WheelWay& wheels, const BodyMotion& together,
                                double duration) const {
  CausalRow row;
  const double travel = together.forward;
  const double turn = together.turn;
  const double way = std::hypot(travel, together.sideways);
  row.kind = motion_kind(wheels.travel, duration, wheels.sideways);
  row.t = t_ + 0.5 * duration;
  row.t_end = t_ + duration;
  row.distance = distance_ + 0.5 * way;
  row.distance_end = distance_ + way;

  const std::size_t first = window(row.kind, row.t);
  const bool alone = first == past_.size();
  const double time = row.t_end - (alone ? t_ : past_[first].begin);
  row.speed = (travelled_ + travel - (alone ? travelled_ : past_[first].travelled)) / time;
  row.turn_rate = (turned_ + turn - (alone ? turned_ : past_[first].turned)) / time;
  if (!alone) row.acceleration = (row.speed - past_[first].speed) / (row.t - past_[first].middle);
  const bool drives = row.kind == MotionKind::driving;
  const double angle = std::abs(row.turn_rate) * duration;
  if (drives && row.speed != 0.0) row.curvature = row.turn_rate / row.speed;
  if (drives) row.arc_angle = angle;
  if (row.kind == MotionKind::spinning) row.spin_angle = angle;

  const bool begins = row.kind != kind_;
  row.starts = begins && drives ? 1.0 : 0.0;
  row.spins = begins && row.kind == MotionKind::spinning ? 1.0 : 0.0;
  row.reverses_left = reversal(sense_left_, sense_after(sense_left_, wheels.travel.left));
  row.reverses_right = reversal(sense_right_, sense_after(sense_right_, wheels.travel.right));
  return row;
}

void CausalVariables::take(const WheelWay& wheels, const BodyMotion& together, double duration) {
  const CausalRow row = next(wheels, together, duration);
  first_ = window(row.kind, row.t);
  if (2 * first_ >= past_.size()) {  // rarely moves much, and allocates nothing
    past_.erase(past_.begin(), past_.begin() + static_cast<std::ptrdiff_t>(first_));
    first_ = 0;
  }
  past_.push_back({row.kind, t_, row.t, travelled_, turned_, row.speed});
  kind_ = row.kind;
  t_ = row.t_end;
  travelled_ += together.forward;
  turned_ += together.turn;
  distance_ = row.distance_end;
  sense_left_ = sense_after(sense_left_, wheels.travel.left);
  sense_right_ = sense_after(sense_right_, wheels.travel.right);
}

}  // namespace trussmap::drive
