// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "logs/source_agreement.hpp"

#include "logs/calendar.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::logs {
namespace {

constexpr double kAgreementWindow = 1.0;  // s
constexpr double kLongestStep = 1.0;      // s: between messages farther apart nobody knows the path
constexpr std::size_t kSomeSteps = 4;
constexpr double kJump = 5.0;  // times all other steps: the pose was set anew
constexpr std::size_t kFewestWindows = 10;
constexpr double kLeastWay = 2.0;    // m
constexpr double kLeastTurns = 1.0;  // rad
constexpr double kMostTimes = 1.1;
constexpr double kUnlike = 0.5;  // likeness below which two do not go together
constexpr double kAlike = 0.9;

bool is_off(double times) {
  return times > kMostTimes || times < 1.0 / kMostTimes;
}

}  // namespace

void MotionAgreement::Products::add(double one, double other) {
  aa += one * one;
  bb += other * other;
  ab += one * other;
}

double MotionAgreement::Products::times() const {
  return std::copysign(std::sqrt(aa / bb), ab);
}

double MotionAgreement::Products::likeness() const {
  return ab / std::sqrt(aa * bb);
}

void MotionAgreement::add_window(const PlanarStep& a, const PlanarStep& b) {
  ++windows_;
  way_a_ += std::hypot(a.ahead, a.left);
  way_b_ += std::hypot(b.ahead, b.left);
  turns_a_ += std::abs(a.turn);
  turns_b_ += std::abs(b.turn);
  ahead_.add(a.ahead, b.ahead);
  turn_.add(a.turn, b.turn);
  left_as_ahead_.add(a.left, b.ahead);
}

std::vector<std::string> MotionAgreement::contradictions(const std::string& a,
                                                         const std::string& b) const {
  std::vector<std::string> said;
  if (windows_ < kFewestWindows) return said;
  const auto judge = [&](const Products& sums, const char* does, const char* axis) {
    if (!sums.both_move()) return;
    const double likeness = sums.likeness();
    if (std::abs(likeness) < kUnlike) {
      said.push_back(fmt::format(
          "{} and {} {} differently (likeness {:.2f} of 1): one of them is of something else, or "
          "of another {}",
          a, b, does, likeness, axis));
    } else if (is_off(sums.times())) {
      const double times = sums.times();
      said.push_back(fmt::format(
          "{} {}s {:.3g} times as much as {} (likeness {:.2f}): {} is wrong in one of them, "
          "expected about 1",
          a, does, times, b, likeness, times < 0.0 ? "a sign" : "a unit or a constant"));
    }
  };
  if (std::max(way_a_, way_b_) > kLeastWay) {
    const bool ahead_unlike = !ahead_.both_move() || std::abs(ahead_.likeness()) < kUnlike;
    if (ahead_unlike && left_as_ahead_.both_move() &&
        std::abs(left_as_ahead_.likeness()) > kAlike) {
      said.push_back(fmt::format(
          "{} moves to the {} where {} moves ahead (likeness {:.2f}): its axes x and y are "
          "exchanged, expected x ahead",
          a, left_as_ahead_.ab > 0.0 ? "left" : "right", b, std::abs(left_as_ahead_.likeness())));
    } else {
      judge(ahead_, "move", "axis");
    }
  }
  // Of one that turns and one that does not a turn's likeness says as little as of two that do not.
  if (turns_a_ > kLeastTurns || turns_b_ > kLeastTurns) {
    if (turns_a_ > kLeastTurns && turns_b_ > kLeastTurns) {
      judge(turn_, "turn", "axis");
    } else if (std::max(turns_a_, turns_b_) > kMostTimes * kMostTimes * kLeastTurns) {
      said.push_back(
          fmt::format("{} turns by {:.3g} rad in all, {} by {:.3g} rad: one of them is "
                      "of another axis or unit, expected about the same",
                      a, turns_a_, b, turns_b_));
    }
  }
  return said;
}

void TwistBesidePose::close_window() {
  const Window& w = window_;
  if (w.steps < kSomeSteps || w.longest <= kJump * (w.way - w.longest)) {
    agreement_.add_window(w.twist, w.pose);
    const auto square = [](double x, double y) { return x * x + y * y; };
    moved_ += square(w.pose.ahead, w.pose.left);
    missed_ += square(w.pose.ahead - w.twist.ahead, w.pose.left - w.twist.left);
    missed_turned_ +=
        square(w.pose.ahead - w.turned_twist.ahead, w.pose.left - w.turned_twist.left);
  }
  window_ = {};
}

void TwistBesidePose::add(std::int64_t t, const FieldTwist& twist, const FieldPose& pose) {
  const Message now{t, twist, pose.position.x(), pose.position.y(), pose.yaw()};
  const double dt =
      before_ ? static_cast<double>(t - before_->t) / static_cast<double>(kNanosecondsPerSecond)
              : 0.0;
  if (before_ && dt <= 0.0) return;  // late, or twice
  if (!before_ || dt > kLongestStep) {
    window_ = {};
    before_ = now;
    return;
  }
  const double turn = wrap_angle(now.heading - before_->heading);
  const double middle = before_->heading + 0.5 * turn;
  const double c = std::cos(middle);
  const double s = std::sin(middle);
  const double dx = now.x - before_->x;
  const double dy = now.y - before_->y;
  const double ahead = 0.5 * dt * (before_->twist.ahead + twist.ahead);
  const double left = 0.5 * dt * (before_->twist.left + twist.left);
  window_.pose += {c * dx + s * dy, c * dy - s * dx, turn};
  window_.twist += {ahead, left, 0.5 * dt * (before_->twist.turn + twist.turn)};
  window_.turned_twist += {c * ahead + s * left, c * left - s * ahead, 0.0};
  window_.duration += dt;
  const double step = std::hypot(dx, dy);
  ++window_.steps;
  window_.way += step;
  window_.longest = std::max(window_.longest, step);
  before_ = now;
  if (window_.duration >= kAgreementWindow) close_window();
}

std::vector<std::string> TwistBesidePose::contradictions(const std::string& path) const {
  const std::string twist = "the twist of " + path;
  const std::string pose = "the pose beside it";
  std::vector<std::string> said = agreement_.contradictions(twist, pose);
  constexpr double kSmall = 0.01;  // of the squares
  constexpr double kLarge = 0.1;
  if (moved_ > 0.0 && missed_ > kLarge * moved_ && missed_turned_ < kSmall * moved_) {
    const auto percent = [&](double squares) { return 100.0 * std::sqrt(squares / moved_); };
    said.insert(said.begin(),
                fmt::format("{} is in the axes of the odometry's frame, not in the robot's: so it "
                            "misses {} by {:.2g} % of the way, else by {:.2g} %; expected x ahead "
                            "(child_frame_id)",
                            twist, pose, percent(missed_turned_), percent(missed_)));
  }
  return said;
}

}  // namespace trussmap::logs
