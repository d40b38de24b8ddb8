// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/gross_starts.hpp"

#include "calibration/marked_course.hpp"
#include "calibration/start_by_turns.hpp"
#include "drive/steered_motion.hpp"
#include "statistics/median.hpp"
#include "trussmap/planar.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace trussmap::calibration {
namespace {

constexpr std::size_t kMostStarts = 4;
constexpr std::size_t kFewestChords = 6;

/// A step as it is with these constants.
BodyMotion step_with(const GrossStart& tried, const BodyMotion& one, const Robot& robot) {
  const double wheelbase = robot.wheelbase;
  const double d = tried.difference;
  if (tried.steer == 0.0) {
    return {one.forward + 0.25 * d * wheelbase * one.turn, one.sideways,
            (1.0 + tried.turn) * (one.turn + d * one.forward / wheelbase)};
  }
  // As the steered wheel goes: ahead, and round the middle of the rear axle.
  const Vector2 steered = rotation(tried.steer) * Vector2(one.forward, robot.length * one.turn);
  const double turn = (1.0 + tried.turn) * steered.y() / robot.length;
  if (robot.drive == DriveKind::tricycle) return {steered.x(), 0.0, turn};
  // The travel is that of the rear axle; nearly across nothing is known of it.
  constexpr double kLeastShare = 0.1;
  const double share = std::max(steered.x() / one.forward, kLeastShare);
  return {one.forward, 0.0, one.forward == 0.0 ? 0.0 : turn / share};
}

/// The robot's poses after each step with these constants.
std::vector<Pose> poses_with(const GrossStart& tried, const std::vector<BodyMotion>& steps,
                             const Robot& robot) {
  std::vector<Pose> poses(1);
  poses.reserve(steps.size() + 1);
  for (const BodyMotion& one : steps) {
    const BodyMotion body = step_with(tried, one, robot);
    const Pose& at = poses.back();
    const Vector2 way =
        rotation(at.heading + 0.5 * body.turn) * Vector2(body.forward, body.sideways);
    poses.push_back({at.x + way.x(), at.y + way.y(), at.heading + body.turn});
  }
  return poses;
}

class Disagreement {
 public:
  Disagreement(const std::vector<DrivenRecording>& recordings, const Robot& robot) : robot_(robot) {
    constexpr std::size_t kFewestReturns = 3;
    std::size_t chords = 0;
    std::size_t returns = 0;
    for (const DrivenRecording& one : recordings) {
      courses_.push_back(course_of(one, robot));
      chords += courses_.back().chords.size();
      returns += courses_.back().returns.size();
    }
    by_chords_ = chords >= kFewestChords;
    tells_ = by_chords_ || returns >= kFewestReturns;
  }

  /// Whether there is anything to disagree with.
  [[nodiscard]] bool tells() const { return tells_; }

  /// From 0 to about 1.
  [[nodiscard]] double of(const GrossStart& tried) const {
    return by_chords_ ? of_chords(chords_with(tried)) : of_returns(returns_with(tried));
  }

  /// With the factor of the way that goes with it, where chords or returns tell it.
  [[nodiscard]] GrossStart completed(GrossStart tried) const {
    if (!tells_) return tried;
    const std::optional<double> factor =
        by_chords_ ? factor_of_chords(chords_with(tried)) : factor_of_returns(returns_with(tried));
    if (factor) tried.travel = *factor - 1.0;
    return tried;
  }

 private:
  /// What lies between two places.
  struct Way {
    Vector2 driven = Vector2::Zero();  ///< m, as the wheels have it
    Vector2 seen = Vector2::Zero();    ///< m, as the sightings have it
    double length = 0.0;  ///< m: of a chord, as known; of a return how far away the robot was
  };

  [[nodiscard]] static Way way_of(const Chord& one, const Course& course,
                                  const std::vector<Pose>& poses) {
    const Mark& from = course.marks[one.from];
    const Mark& to = course.marks[one.to];
    return {poses[to.step].position() - poses[from.step].position(),
            rotation(poses[to.step].heading) * to.offset -
                rotation(poses[from.step].heading) * from.offset,
            one.length};
  }

  [[nodiscard]] std::vector<Way> chords_with(const GrossStart& tried) const {
    std::vector<Way> chords;
    for (const Course& course : courses_) {
      const std::vector<Pose> poses = poses_with(tried, course.steps, robot_);
      for (const Chord& one : course.chords) chords.push_back(way_of(one, course, poses));
    }
    return chords;
  }

  /// Of the way: the median of those that give each chord its length.
  [[nodiscard]] static std::optional<double> factor_of_chords(const std::vector<Way>& chords) {
    std::vector<double> factors;
    for (const Way& one : chords) {
      const double square = one.driven.squaredNorm();
      const double missing = one.length * one.length - one.seen.squaredNorm();
      if (!(square > 0.0 && missing > 0.0)) continue;  // else there are two, or none
      const double along = one.driven.dot(one.seen);
      factors.push_back((std::sqrt(along * along + square * missing) - along) / square);
    }
    if (factors.size() < kFewestChords) return std::nullopt;
    return statistics::median(factors);
  }

  [[nodiscard]] static double of_chords(const std::vector<Way>& chords) {
    const std::optional<double> factor = factor_of_chords(chords);
    if (!factor) return 1.0;
    double sum = 0.0;
    for (const Way& one : chords) {
      const double length = (*factor * one.driven + one.seen).norm();
      sum += std::min(1.0, std::abs(length / one.length - 1.0));
    }
    return sum / static_cast<double>(chords.size());
  }

  [[nodiscard]] std::vector<Way> returns_with(const GrossStart& tried) const {
    std::vector<Way> returns;
    for (const Course& course : courses_) {
      const std::vector<Pose> poses = poses_with(tried, course.steps, robot_);
      for (const Chord& one : course.returns) {
        Way next = way_of(one, course, poses);
        const std::size_t from = course.marks[one.from].step;
        next.length = 0.0;
        for (std::size_t k = from; k <= course.marks[one.to].step; ++k) {
          next.length =
              std::max(next.length, (poses[k].position() - poses[from].position()).norm());
        }
        returns.push_back(next);
      }
    }
    return returns;
  }

  /// Of the way, by least squares of what is missed as a share of how far away the robot was.
  /// Nothing where landmarks are hardly seen from afar.
  [[nodiscard]] static std::optional<double> factor_of_returns(const std::vector<Way>& returns) {
    constexpr double kLeastSeen = 0.05;  // of how far away, rms
    constexpr double kMost = 5.0;
    double both = 0.0;
    double seen = 0.0;
    for (const Way& one : returns) {
      if (!(one.length > 0.0)) continue;
      both -= one.driven.dot(one.seen) / (one.length * one.length);
      seen += one.seen.squaredNorm() / (one.length * one.length);
    }
    if (seen < kLeastSeen * kLeastSeen * static_cast<double>(returns.size())) return std::nullopt;
    return 1.0 / std::clamp(both / seen, 1.0 / kMost, kMost);
  }

  [[nodiscard]] static double of_returns(const std::vector<Way>& returns) {
    const double factor = factor_of_returns(returns).value_or(1.0);
    double sum = 0.0;
    for (const Way& one : returns) {
      const double share = (one.driven + one.seen / factor).norm() / one.length;
      sum += one.length > 0.0 ? std::min(1.0, share) : 1.0;
    }
    return sum / static_cast<double>(returns.size());
  }

  const Robot& robot_;
  std::vector<Course> courses_;
  bool by_chords_ = false;
  bool tells_ = false;
};

/// What is tried beside a factor of turning.
enum class Beside { nothing, ratio, offset };

Beside beside_turning(const std::vector<DrivenRecording>& recordings, const Robot& robot) {
  if (drive::has_steering(robot)) return Beside::offset;
  return recordings.front().drive.of_two_wheels() ? Beside::ratio : Beside::nothing;
}

struct Rated {
  double log_turn = 0.0;  ///< of turning over what is stated
  double other = 0.0;     ///< log of right wheel over left; rad, of an offset
  double disagreement = 0.0;

  [[nodiscard]] GrossStart start(Beside beside) const {
    if (beside == Beside::offset) return {std::expm1(log_turn), 0.0, other};
    return {std::expm1(log_turn), 2.0 * std::tanh(0.5 * other), 0.0};
  }
};

constexpr double kTurnStep = 0.04;  // of the grid, in log_turn
constexpr double kOtherStep = 0.03;

/// The grid, best first.
std::vector<Rated> rated_grid(const Disagreement& disagreement, Beside beside) {
  constexpr int kTurns = 42;  // either way: a factor of 5.4
  constexpr int kRatios = 54;
  constexpr int kOffsets = 12;
  const int others = beside == Beside::ratio ? kRatios : beside == Beside::offset ? kOffsets : 0;
  std::vector<Rated> grid;
  for (int a = -kTurns; a <= kTurns; ++a) {
    for (int b = -others; b <= others; ++b) {
      Rated one{kTurnStep * a, kOtherStep * b};
      one.disagreement = disagreement.of(one.start(beside));
      grid.push_back(one);
    }
  }
  std::stable_sort(grid.begin(), grid.end(),
                   [](const Rated& a, const Rated& b) { return a.disagreement < b.disagreement; });
  return grid;
}

/// Downhill between the points of the grid, by ever shorter steps: after a long drive a valley is
/// narrower than the grid.
Rated descended(const Disagreement& disagreement, Rated at, Beside beside) {
  constexpr int kHalvings = 5;
  constexpr int kMostSteps = 8;  // of one length
  double share = 0.5;
  for (int halving = 0; halving < kHalvings; ++halving, share *= 0.5) {
    for (int step = 0; step < kMostSteps; ++step) {
      const Rated before = at;
      for (const int turn : {-1, 0, 1}) {
        for (const int other : {-1, 0, 1}) {
          if ((turn == 0 && other == 0) || (other != 0 && beside == Beside::nothing)) continue;
          Rated next{before.log_turn + turn * share * kTurnStep,
                     before.other + other * share * kOtherStep};
          next.disagreement = disagreement.of(next.start(beside));
          if (next.disagreement < at.disagreement) at = next;
        }
      }
      if (at.disagreement == before.disagreement) break;
    }
  }
  return at;
}

/// The best of their neighbourhoods, best first.
std::vector<Rated> valleys(const Disagreement& disagreement, Beside beside) {
  constexpr double kNear = 0.15;  // of a logarithm
  constexpr std::size_t kMostValleys = 6;
  std::vector<Rated> found;
  for (const Rated& one : rated_grid(disagreement, beside)) {
    if (found.size() == kMostValleys) break;
    const bool near = std::any_of(found.begin(), found.end(), [&one](const Rated& other) {
      return std::abs(one.log_turn - other.log_turn) < kNear &&
             std::abs(one.other - other.other) < kNear;
    });
    if (!near) found.push_back(one);
  }
  for (Rated& one : found) one = descended(disagreement, one, beside);
  std::stable_sort(found.begin(), found.end(),
                   [](const Rated& a, const Rated& b) { return a.disagreement < b.disagreement; });
  return found;
}

std::vector<GrossStart> starts_by_places(const Disagreement& disagreement, Beside beside) {
  constexpr double kMuchBetter = 0.6;
  if (!disagreement.tells()) return {};
  const double as_stated = disagreement.of({});
  std::vector<GrossStart> starts;
  for (const Rated& one : valleys(disagreement, beside)) {
    if (one.disagreement > kMuchBetter * as_stated || starts.size() == kMostStarts) break;
    if (std::abs(one.log_turn) < kNearTurn && std::abs(one.other) < kNearRatio) break;
    starts.push_back(disagreement.completed(one.start(beside)));
  }
  return starts;
}

}  // namespace

std::vector<GrossStart> gross_starts(const std::vector<DrivenRecording>& all, const Robot& robot,
                                     const estimation::ProblemOptions& options) {
  if (all.empty()) return {};
  std::vector<DrivenRecording> recordings = all;
  for (DrivenRecording& one : recordings) {
    if (!options.survey) one.survey.clear();
    if (!options.truth) one.truth.clear();
    if (!options.fixes) one.fixes.clear();
  }
  const Disagreement disagreement(recordings, robot);
  std::vector<GrossStart> starts;
  if (const std::optional<GrossStart> by_turns = start_by_turns(recordings, robot)) {
    starts.push_back(disagreement.completed(*by_turns));
  }
  for (const GrossStart& one : starts_by_places(disagreement, beside_turning(recordings, robot))) {
    starts.push_back(one);
  }
  return starts;
}

}  // namespace trussmap::calibration
