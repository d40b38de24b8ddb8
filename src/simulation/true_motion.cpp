// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/simulation/true_motion.hpp"

#include "trussmap/core/index.hpp"
#include "trussmap/simulation/random_stream.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
namespace {

using std::numbers::pi;

/// Where a row of unit length leads whose heading changes evenly from `first` to `last`: five-point
/// Gauss-Legendre quadrature, exact to rounding for turns below a radian.
Vector2 unit_step(double first, double last) {
  constexpr std::array<double, 5> kNodes = {-0.9061798459386640, -0.5384693101056831, 0.0,
                                            0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 5> kWeights = {0.2369268850561891, 0.4786286704993665,
                                              0.5688888888888889, 0.4786286704993665,
                                              0.2369268850561891};
  Vector2 sum = Vector2::Zero();
  for (std::size_t k = 0; k < kNodes.size(); ++k) {
    const double heading = 0.5 * (first + last) + 0.5 * (last - first) * kNodes[k];
    sum += 0.5 * kWeights[k] * Vector2(std::cos(heading), std::sin(heading));
  }
  return sum;
}

/// Headings at the ends of a leg's rows, against the direction in which it set out to be driven.
struct LegShape {
  std::vector<double> headings;   ///< rad, one more than there are rows
  Vector2 end = Vector2::Zero();  ///< where it leads if it is 1 m long, m
};

LegShape leg_shape(const std::array<double, 3>& bends, int rows) {
  LegShape shape;
  for (int k = 0; k <= rows; ++k) {
    const double u = static_cast<double>(k) / rows;
    shape.headings.push_back(bends[0] * std::sin(2.0 * pi * u) + bends[1] * std::cos(pi * u) +
                             bends[2] * std::cos(2.0 * pi * u));
    if (k > 0) shape.end += unit_step(shape.headings[idx(k - 1)], shape.headings[idx(k)]) / rows;
  }
  return shape;
}

int whole_rows(double seconds, double row_duration) {
  return static_cast<int>(std::max(1L, std::lround(seconds / row_duration)));
}

/// The path so far, to which pieces are added.
class Path {
 public:
  Path(const Mesh& mesh, const DrivingStyle& style, std::uint64_t seed)
      : mesh_(mesh), style_(style), random_(random_stream(seed, Stream::path)) {
    warm_at_ = uniform(0.0, 2.0 * pi);
  }

  void start_at(int landmark) {
    pose_ = {0.0, 0.0, 0.0};
    set_position(stop_near(landmark));
    motion_.start = pose_;
    change_surroundings();
    stop(landmark);
  }

  /// Drives from the landmark where the robot stands to another; `spin_first` turns it round twice
  /// to the left and twice to the right before.
  void go(int landmark, bool spin_first) {
    if (chance(style_.rest_share)) rest(uniform(style_.shortest_rest, style_.longest_rest));
    if (spin_first) {
      spin(4.0 * pi);
      spin(-4.0 * pi);
    }
    const Vector2 target = stop_near(landmark);
    const double speed = uniform(style_.slowest, style_.fastest);
    const bool has_corner = chance(style_.corner_share);
    const double side = uniform(-1.0, 1.0);
    if (has_corner) {
      const Vector2 way = target - pose_.position();
      drive(pose_.position() + 0.5 * way + side * style_.corner_reach * quarter_turn(way), speed);
    }
    drive(target, speed);
    stop(landmark);
    change_surroundings();
  }

  [[nodiscard]] TrueMotion take() { return std::move(motion_); }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }

  Vector2 stop_near(int landmark) {
    const double dx = normal_(random_);
    const double dy = normal_(random_);
    return mesh_.positions[idx(landmark)] + style_.standing * Vector2(dx, dy);
  }

  void set_position(const Vector2& position) {
    pose_.x = position.x();
    pose_.y = position.y();
  }

  /// Time at the end of a number of rows, in whole nanoseconds lest 3 x 0.1 s be
  /// 0.30000000000000004.
  [[nodiscard]] double time_after(std::size_t rows) const {
    return std::round(static_cast<double>(rows) * style_.row_duration * 1e9) / 1e9;
  }

  void stop(int landmark) {
    const std::size_t rows = motion_.rows.size();
    motion_.stops.push_back({time_after(rows), landmark, rows, pose_});
  }

  void change_surroundings() {
    constexpr std::array<double, 4> kLoads = {0.0, 5.0, 12.0, 20.0};
    const bool reload = chance(style_.load_change_share);
    const auto load = static_cast<std::size_t>(uniform(0.0, kLoads.size()));
    const bool press_switch = chance(style_.lights_change_share);
    if (reload) surroundings_.payload_kg = kLoads[std::min(load, kLoads.size() - 1)];
    if (press_switch) surroundings_.lights = 1.0 - surroundings_.lights;
  }

  /// A day of the place, twenty minutes long, to the thermometer's thousandth of a degree.
  [[nodiscard]] double temperature(double t) const {
    return std::round(1e3 * (20.0 + 6.0 * std::sin(t / 200.0 + warm_at_))) / 1e3;
  }

  /// The row that ends at the present pose.
  void add_row(Activity activity, double speed, double turn_rate) {
    const double t = time_after(motion_.rows.size() + 1);
    surroundings_.temperature_C = temperature(t);
    motion_.rows.push_back(
        {t, style_.row_duration, speed, turn_rate, activity, pose_, surroundings_});
  }

  void rest(double seconds) {
    const int rows = whole_rows(seconds, style_.row_duration);
    for (int k = 0; k < rows; ++k) add_row(Activity::rest, 0.0, 0.0);
  }

  void spin(double angle) {
    const double wanted_rate = uniform(style_.slowest_turn, style_.fastest_turn);
    if (angle == 0.0) return;
    const int rows = whole_rows(std::abs(angle) / wanted_rate, style_.row_duration);
    const double before = pose_.heading;
    for (int k = 1; k <= rows; ++k) {
      pose_.heading = before + angle * k / rows;
      add_row(Activity::spin, 0.0, angle / (rows * style_.row_duration));
    }
  }

  /// A bend that leaves the leg a leg: not so large that it leads back to where it began.
  LegShape draw_shape(int rows) {
    LegShape shape;
    do {
      const double bow = style_.bend * normal_(random_);
      const double sweep = style_.bend * normal_(random_);
      const double ess = style_.bend * normal_(random_);
      shape = leg_shape({bow, sweep, ess}, rows);
    } while (shape.end.norm() < 0.5);
    return shape;
  }

  void drive(const Vector2& target, double wanted_speed) {
    const Vector2 way = target - pose_.position();
    const int rows = whole_rows(way.norm() / wanted_speed, style_.row_duration);
    const LegShape shape = draw_shape(rows);
    const double length = way.norm() / shape.end.norm();
    const double turned = direction(way) - direction(shape.end);
    spin(wrap_angle(turned + shape.headings.front() - pose_.heading));

    const double offset = pose_.heading - shape.headings.front();
    const double speed = length / (rows * style_.row_duration);
    for (int k = 1; k <= rows; ++k) {
      const double first = offset + shape.headings[idx(k - 1)];
      const double last = offset + shape.headings[idx(k)];
      set_position(pose_.position() + length / rows * unit_step(first, last));
      pose_.heading = last;
      add_row(Activity::drive, speed, (last - first) / style_.row_duration);
    }
  }

  const Mesh& mesh_;
  const DrivingStyle& style_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double warm_at_ = 0.0;  ///< phase of the temperature, rad
  Pose pose_;
  Surroundings surroundings_;
  TrueMotion motion_;
};

void require(bool holds, const std::string& what) {
  if (!holds) throw std::invalid_argument(what);
}

bool is_range(double low, double high) {
  return low > 0.0 && low <= high && std::isfinite(high);
}

bool is_share(double share) {
  return share >= 0.0 && share <= 1.0;
}

void check_style(const DrivingStyle& style) {
  require(is_range(style.row_duration, 3600.0), "a row must last above 0 s");
  require(is_range(style.slowest, style.fastest), "speeds must be above 0 m/s, slowest first");
  require(is_range(style.slowest_turn, style.fastest_turn),
          "turn rates must be above 0 rad/s, slowest first");
  require(style.bend >= 0.0 && style.bend <= 0.5, "a leg's bend must lie between 0 and 0.5 rad");
  require(style.corner_reach >= 0.0 && style.corner_reach <= 1.0,
          "a corner must lie off the leg by 0 to 1 of its length");
  require(is_share(style.corner_share) && is_share(style.rest_share) &&
              is_share(style.load_change_share) && is_share(style.lights_change_share),
          "a share must lie between 0 and 1");
  require(is_range(style.shortest_rest, style.longest_rest),
          "rests must last above 0 s, shortest first");
  require(style.full_spins >= 0, "the number of stops with full spins must not be negative");
  require(std::isfinite(style.standing) && style.standing >= 0.0,
          "how exactly the robot stands on a landmark must be 0 m or more");
}

void check_walk(const Mesh& mesh, const std::vector<int>& walk, double standing) {
  require(walk.size() >= 2, "a walk needs two landmarks");
  const double least = std::max(0.01, 20.0 * standing);
  for (std::size_t k = 0; k < walk.size(); ++k) {
    require(walk[k] >= 0 && walk[k] < mesh.landmarks(), "a walk keeps to the mesh's landmarks");
    require(k == 0 || mesh.displacement(walk[k - 1], walk[k]).norm() >= least,
            fmt::format("successive landmarks of a walk must be at least {:g} m apart", least));
  }
}

}  // namespace

TrueMotion lay_path(const Mesh& mesh, const std::vector<int>& walk, const DrivingStyle& style,
                    std::uint64_t seed) {
  check_style(style);
  check_walk(mesh, walk, style.standing);
  const std::size_t legs = walk.size() - 1;
  const auto spins_until = [&](std::size_t leg) {
    return leg * static_cast<std::size_t>(style.full_spins) / legs;
  };
  Path path(mesh, style, seed);
  path.start_at(walk.front());
  for (std::size_t k = 0; k < legs; ++k) {
    path.go(walk[k + 1], spins_until(k + 1) > spins_until(k));
  }
  return path.take();
}

}  // namespace trussmap
