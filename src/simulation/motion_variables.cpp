// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/motion_variables.hpp"

#include "geometry/index.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::simulation {
namespace {

constexpr double kHalfWindow = 0.5;   // s
constexpr double kAtRest = 0.005;     // m/s of a wheel: below, a spin is none
constexpr double kWheelMoves = 1e-6;  // m in a row

/// Rests, spins and drives of a motion, as far as wheels can tell them apart.
std::vector<Activity> activities(const TrueMotion& motion, double wheelbase) {
  std::vector<Activity> result;
  for (const TrueRow& row : motion.rows) {
    const bool hardly_turns =
        row.activity == Activity::spin && 0.5 * wheelbase * std::abs(row.turn_rate) < kAtRest;
    result.push_back(hardly_turns ? Activity::rest : row.activity);
  }
  return result;
}

/// Rows of one activity without a break, and within it those near a row.
class Neighbourhoods {
 public:
  Neighbourhoods(const TrueMotion& motion, const std::vector<Activity>& doing)
      : first_(doing.size()), last_(doing.size()) {
    const auto middle = [&](std::size_t row) {
      return motion.rows[row].t - 0.5 * motion.rows[row].duration;
    };
    const auto near = [&](std::size_t a, std::size_t b) {
      return std::abs(middle(a) - middle(b)) <= kHalfWindow + 1e-9;
    };
    for (std::size_t row = 0; row < doing.size(); ++row) {
      first_[row] = row;
      while (first_[row] > 0 && doing[first_[row] - 1] == doing[row] &&
             near(first_[row] - 1, row)) {
        --first_[row];
      }
      last_[row] = row;
      while (last_[row] + 1 < doing.size() && doing[last_[row] + 1] == doing[row] &&
             near(last_[row] + 1, row)) {
        ++last_[row];
      }
    }
  }

  /// Mean over the neighbours, each as long as it lasts.
  [[nodiscard]] std::vector<double> means(const TrueMotion& motion,
                                          const std::vector<double>& values) const {
    std::vector<double> result;
    for (std::size_t row = 0; row < values.size(); ++row) {
      double sum = 0.0;
      double time = 0.0;
      for (std::size_t k = first_[row]; k <= last_[row]; ++k) {
        sum += values[k] * motion.rows[k].duration;
        time += motion.rows[k].duration;
      }
      result.push_back(sum / time);
    }
    return result;
  }

  /// How fast a value changes from the first neighbour to the last.
  [[nodiscard]] std::vector<double> changes(const TrueMotion& motion,
                                            const std::vector<double>& values) const {
    std::vector<double> result;
    for (std::size_t row = 0; row < values.size(); ++row) {
      const std::size_t a = first_[row];
      const std::size_t b = last_[row];
      const double time = motion.rows[b].t - motion.rows[a].t -
                          0.5 * (motion.rows[b].duration - motion.rows[a].duration);
      result.push_back(a == b ? 0.0 : (values[b] - values[a]) / time);
    }
    return result;
  }

 private:
  std::vector<std::size_t> first_;
  std::vector<std::size_t> last_;
};

/// 1 where an activity begins.
std::vector<double> onsets(const std::vector<Activity>& doing, Activity what) {
  std::vector<double> result(doing.size(), 0.0);
  for (std::size_t row = 0; row < doing.size(); ++row) {
    const bool before = row > 0 && doing[row - 1] == what;
    if (doing[row] == what && !before) result[row] = 1.0;
  }
  return result;
}

/// 1 where a wheel goes the other way than when it last moved; `side` is +1 for the right wheel.
std::vector<double> turnarounds(const TrueMotion& motion, double wheelbase, double side) {
  std::vector<double> result(motion.rows.size(), 0.0);
  double last = 0.0;
  for (std::size_t row = 0; row < motion.rows.size(); ++row) {
    const TrueRow& now = motion.rows[row];
    const double moved = (now.speed + side * 0.5 * wheelbase * now.turn_rate) * now.duration;
    if (std::abs(moved) < kWheelMoves) continue;
    if (moved * last < 0.0) result[row] = 1.0;
    last = moved;
  }
  return result;
}

}  // namespace

std::vector<RowRates> true_rates(const TrueMotion& motion) {
  std::vector<RowRates> rates;
  for (const TrueRow& row : motion.rows) rates.push_back({row.speed, row.turn_rate, row.sideways});
  return rates;
}

MotionVariables motion_variables(const TrueMotion& motion, const std::vector<RowRates>& rates,
                                 double wheelbase) {
  const std::vector<Activity> doing = activities(motion, wheelbase);
  const Neighbourhoods near(motion, doing);
  std::vector<double> speeds;
  std::vector<double> turn_rates;
  for (const RowRates& row : rates) {
    speeds.push_back(row.speed);
    turn_rates.push_back(row.turn_rate);
  }
  MotionVariables result;
  RowVariables& middle = result.middle;
  middle["speed"] = near.means(motion, speeds);
  middle["turn_rate"] = near.means(motion, turn_rates);
  middle["acceleration"] = near.changes(motion, middle["speed"]);
  for (std::size_t k = 0; k < doing.size(); ++k) {
    const double speed = middle["speed"][k];
    const double turn_rate = middle["turn_rate"][k];
    const double angle = std::abs(turn_rate) * motion.rows[k].duration;
    const bool drives = doing[k] == Activity::drive;
    middle["curvature"].push_back(drives && speed != 0.0 ? turn_rate / speed : 0.0);
    middle["arc_angle"].push_back(drives ? angle : 0.0);
    middle["spin_angle"].push_back(doing[k] == Activity::spin ? angle : 0.0);
  }
  middle["session"] = std::vector<double>(motion.rows.size(), 0.0);
  middle["starts"] = onsets(doing, Activity::drive);
  middle["spins"] = onsets(doing, Activity::spin);
  middle["reverses_left"] = turnarounds(motion, wheelbase, -1.0);
  middle["reverses_right"] = turnarounds(motion, wheelbase, 1.0);
  for (const TrueRow& row : motion.rows) {
    middle["payload_kg"].push_back(row.surroundings.payload_kg);
    middle["lights"].push_back(row.surroundings.lights);
    middle["temperature_C"].push_back(row.surroundings.temperature_C);
  }
  for (const Covariate& one : motion.further) middle[one.name] = one.values;

  result.instant = middle;
  double driven = 0.0;
  for (std::size_t k = 0; k < motion.rows.size(); ++k) {
    const TrueRow& row = motion.rows[k];
    const Pose& before = k == 0 ? motion.start : motion.rows[k - 1].pose;
    const double path = std::hypot(rates[k].speed, rates[k].sideways) * row.duration;
    const auto put = [&](const char* name, double half_way, double at_end) {
      middle[name].push_back(half_way);
      result.instant[name].push_back(at_end);
    };
    put("heading", wrap_angle(0.5 * (before.heading + row.pose.heading)),
        wrap_angle(row.pose.heading));
    put("x", 0.5 * (before.x + row.pose.x), row.pose.x);
    put("y", 0.5 * (before.y + row.pose.y), row.pose.y);
    put("t", row.t - 0.5 * row.duration, row.t);
    put("distance", driven + 0.5 * path, driven + path);
    driven += path;
  }
  return result;
}

}  // namespace trussmap::simulation
