// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/true_motion.hpp"

#include "geometry/index.hpp"
#include "simulation/driving_checks.hpp"
#include "simulation/further_columns.hpp"
#include "simulation/leg_shape.hpp"
#include "simulation/motion_so_far.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <span>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap::simulation {
namespace {

constexpr int kPasses = 60;
constexpr double kEase = 0.8;  // of its tightest bend: how sharply a robot bends a leg

using std::numbers::pi;

/// What is drawn for a path, in the order in which it is driven.
class PathDraws {
 public:
  PathDraws(const DrivingStyle& style, const DrivingManner& manner, std::uint64_t seed)
      : style_(style), manner_(manner), random_(random_stream(seed, Stream::path)) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
  double turn_rate() { return uniform(style_.slowest_turn, style_.fastest_turn); }

  /// How far off a landmark the robot stops, m.
  Vector2 standing() {
    const double dx = normal_(random_);
    const double dy = normal_(random_);
    return style_.standing * Vector2(dx, dy);
  }

  /// Where the robot's next leg leads in its own axes: of length 1.
  Vector2 course() {
    if (manner_.backwards > 0.0 && chance(manner_.backwards)) return {-1.0, 0.0};
    if (manner_.aside == 0.0) return {1.0, 0.0};
    const double aside = uniform(-manner_.aside, manner_.aside);
    return {std::cos(aside), std::sin(aside)};
  }

  /// A bend that leaves the leg, so long [m], a leg: not so large that it leads back to where it
  /// began, nor sharper than the robot's tightest.
  LegShape shape(const std::vector<double>& profile, double leg) {
    LegShape shape;
    const double sharpest = kEase * leg / manner_.turning_radius;
    do {
      const double bow = style_.bend * normal_(random_);
      const double sweep = style_.bend * normal_(random_);
      const double ess = style_.bend * normal_(random_);
      const double least = std::max(sharpest_bend({bow, sweep, ess}), sharpest);
      const double share = manner_.turning_radius > 0.0 ? sharpest / least : 1.0;
      shape = leg_shape({share * bow, share * sweep, share * ess}, profile,
                        manner_.bends_by_way ? Bends::by_way : Bends::in_time);
    } while (shape.end.norm() < 0.5);
    return shape;
  }

  Surroundings next(Surroundings now) {
    constexpr std::array<double, 4> kLoads = {0.0, 5.0, 12.0, 20.0};
    const bool reload = chance(style_.load_change_share);
    const auto load = static_cast<std::size_t>(uniform(0.0, kLoads.size()));
    const bool press_switch = chance(style_.lights_change_share);
    if (reload) now.payload_kg = kLoads[std::min(load, kLoads.size() - 1)];
    if (press_switch) now.lights = 1.0 - now.lights;
    return now;
  }

 private:
  const DrivingStyle& style_;
  const DrivingManner& manner_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

/// What a path is laid by.
struct PathRules {
  const DrivingStyle& style;
  const PathBias& bias;
  const DrivingManner& manner;
};

struct PlannedLeg {
  Vector2 target;               ///< m
  Vector2 sensor;               ///< what is to be there at its end, from the axle; robot axes, m
  Vector2 course;               ///< where it leads, robot axes, of length 1
  std::vector<double> profile;  ///< of its rows, shares of the mean speed
  LegShape shape;
};

/// From here to where the axle must stop for the sensor to be on the target. On arrival the robot
/// is turned against its way w by a known angle, and so its sensor lies at a known s in the way's
/// axes: w + s is the target, and what s has aside says how far beside the target the way leads.
Vector2 way_to(const Vector2& target, const PlannedLeg& leg, const Pose& here) {
  Vector2 straight = target - here.position();
  if (leg.sensor.isZero(0.0)) return straight;
  const double distance = straight.norm();
  const Vector2 s = rotation(leg.shape.headings.back() - direction(leg.shape.end)) * leg.sensor;
  const double length =
      std::abs(s.y()) < distance ? std::sqrt(distance * distance - s.y() * s.y()) - s.x() : 0.0;
  if (!(length > 0.0)) {
    throw std::invalid_argument(
        fmt::format("the sensor sits {:.3g} m from the axle, which is too far for a landmark "
                    "{:.3g} m ahead",
                    leg.sensor.norm(), distance));
  }
  const double course = direction(straight) - std::asin(s.y() / distance);
  return length * rotation(course).col(0);
}

/// What is to be turned before a leg of this shape leads there, rad: within half a turn of `about`.
double turn_to(const Vector2& way, const LegShape& shape, const Pose& here, double about = 0.0) {
  const double turned = direction(way) - direction(shape.end);
  const double turn = wrap_angle(turned + shape.headings.front() - here.heading);
  return about == 0.0 ? turn : unwrap_near(turn, about);
}

/// How many segments the next turn has, by an earlier path.
std::size_t segments_of_turn(const TrueMotion& motion, const PathRules& rules) {
  const std::vector<double>& turns = rules.bias.turns;
  const std::size_t turn = motion.turns.size();
  return turn < turns.size() ? idx(arcs_of_turn(turns[turn], rules.manner)) : 1;
}

/// Of the leg that comes after the next turn; `straight`: its length, m.
std::vector<double> profile_of_leg(double straight, double wanted_speed, const TrueMotion& motion,
                                   const PathRules& rules) {
  const double dt = rules.style.row_duration;
  const int rows = rules.bias.rows_of(motion.segments.size() + segments_of_turn(motion, rules),
                                      whole_rows(straight / wanted_speed, dt));
  return speed_profile(rows,
                       std::min(static_cast<int>(std::lround(rules.style.ramp / dt)), rows / 2));
}

/// Where the leg leads if it is 1 m long, its course and the slip of its rows considered.
Vector2 end_on_course(const PlannedLeg& leg, const TrueMotion& motion, const PathRules& rules) {
  if (rules.bias.slip.empty()) {
    if (leg.course.y() == 0.0) return leg.course.x() * leg.shape.end;
    return leg.course.x() * leg.shape.end + leg.course.y() * quarter_turn(leg.shape.end);
  }
  std::size_t first = motion.rows.size();
  for (std::size_t k = 0; k < segments_of_turn(motion, rules); ++k) {
    first += idx(rules.bias.rows_of(motion.segments.size() + k, 0));
  }
  Vector2 end = Vector2::Zero();
  for (std::size_t k = 0; k < leg.profile.size(); ++k) {
    const Vector2 ahead = unit_step(leg.shape.headings[k], leg.shape.headings[k + 1]);
    end += leg.profile[k] / static_cast<double>(leg.profile.size()) *
           rules.bias.step_of(1.0, ahead, leg.course, first + k);
  }
  return end;
}

/// Where a spin by an angle, which is next, will leave the robot by its jumps, from here.
Vector2 jumped(double angle, const MotionSoFar& so_far, const PathBias& bias) {
  const TrueMotion& motion = so_far.motion();
  Vector2 sum = Vector2::Zero();
  const int rows = bias.rows_of(motion.segments.size(), 0);
  for (int k = 0; k < rows; ++k) {
    const double from = so_far.pose().heading + angle * k / rows;
    sum += bias.jump_of(motion.rows.size() + idx(k)) * unit_step(from, from + angle / rows);
  }
  return sum;
}

/// Where the leg has to lead after a spin by about so much [rad], m.
Vector2 way_after_spin(const PlannedLeg& leg, double about, const MotionSoFar& so_far,
                       const PathBias& bias) {
  const Pose& here = so_far.pose();
  Vector2 way = way_to(leg.target, leg, here);
  for (int pass = 0; pass < kPasses && !bias.jump.empty(); ++pass) {
    const double turn = turn_to(way, leg.shape, here, about);
    way = way_to(leg.target - jumped(turn, so_far, bias), leg, here);
  }
  return way;
}

/// A turn in arcs, and where the leg has to lead after it, m.
struct TurnInArcs {
  double turn = 0.0;  ///< rad
  std::vector<int> rows;
  Vector2 way;
};

/// From here, m, by a turn in arcs, which is next.
Vector2 moved_by_arcs(double turn, const std::vector<int>& rows, const MotionSoFar& so_far,
                      const PathRules& rules) {
  Vector2 sum = Vector2::Zero();
  double heading = so_far.pose().heading;
  std::size_t at = so_far.motion().rows.size();
  for (const ArcRow& row : turning_arcs(turn, rules.manner.turning_radius, rows)) {
    sum += rules.bias.step_of(row.way, unit_step(heading, heading + row.turn), {1.0, 0.0}, at++);
    heading += row.turn;
  }
  return sum;
}

/// As way_after_spin, where the arcs, at so many rad/s, take the robot off its place.
TurnInArcs turn_in_arcs(const PlannedLeg& leg, double about, const std::vector<double>& rates,
                        const MotionSoFar& so_far, const PathRules& rules) {
  const std::vector<int>& known = rules.bias.segments;
  const std::span<const int> earlier =
      std::span(known).subspan(std::min(known.size(), so_far.motion().segments.size()));
  const auto rows_of = [&](double turn) {
    return rows_of_arcs(turn, rates, rules.style.row_duration, earlier);
  };
  TurnInArcs result{about, {}, {}};
  for (int pass = 0; pass < kPasses; ++pass) {
    const Vector2 moved = moved_by_arcs(result.turn, rows_of(result.turn), so_far, rules);
    result.way = way_to(leg.target - moved, leg, so_far.pose());
    result.turn = about + wrap_angle(turn_to(result.way, leg.shape, so_far.pose()) - about);
  }
  result.rows = rows_of(result.turn);
  return result;
}

/// The path so far, to which segments are added.
class Path {
 public:
  Path(const Mesh& mesh, const PathRules& rules, std::uint64_t seed)
      : mesh_(mesh),
        rules_(rules),
        draws_(rules.style, rules.manner, seed),
        so_far_(rules.style, rules.bias, draws_.uniform(0.0, 2.0 * pi)) {}

  void start_at(int landmark) {
    so_far_.start_at(stop_near(landmark) - sensor());
    so_far_.surround(rules_.style.orders.empty() ? draws_.next(so_far_.surroundings())
                                                 : rules_.style.orders.front().surroundings);
    if (rules_.style.first_rest > 0.0) so_far_.rest(rules_.style.first_rest);
    so_far_.stop(landmark);
  }

  /// Drives from the landmark where the robot stands to another; `spin_first` turns it round twice
  /// to the left and twice to the right before.
  void go(int landmark, bool spin_first) {
    const DrivingStyle& style = rules_.style;
    if (draws_.chance(style.rest_share)) {
      so_far_.rest(draws_.uniform(style.shortest_rest, style.longest_rest));
    }
    if (spin_first) {
      turn_round(4.0 * pi);
      turn_round(-4.0 * pi);
    }
    const Vector2 target = stop_near(landmark);
    const double speed = draws_.uniform(style.slowest, style.fastest);
    const bool has_corner = draws_.chance(style.corner_share);
    const double side = draws_.uniform(-1.0, 1.0);
    const Vector2 course = draws_.course();
    if (has_corner) {
      const Vector2 here = so_far_.pose().position();
      const Vector2 way = target - here;
      const Vector2 corner = here + 0.5 * way + side * style.corner_reach * quarter_turn(way);
      drive({corner, Vector2::Zero(), course, {}, {}}, speed);
    }
    drive({target, sensor(), course, {}, {}}, speed);
    so_far_.stop(landmark);
    if (style.overrun > 0.0) so_far_.drive_on(style.overrun, speed, course);
    so_far_.surround(draws_.next(so_far_.surroundings()));
  }

  /// Likewise, as ordered.
  void go(int landmark, const LegOrder& order) {
    const double temperature = so_far_.surroundings().temperature_C;
    so_far_.surround({order.surroundings.payload_kg, order.surroundings.lights, temperature});
    if (order.rest > 0.0) so_far_.rest(order.rest);
    PlannedLeg leg{stop_near(landmark), sensor(), {1.0, 0.0}, {}, {}};
    const double radius = rules_.manner.turning_radius;
    if (radius > 0.0) circle_whole_turns(order);
    const double straight = (leg.target - so_far_.pose().position()).norm();
    leg.profile = profile_of_leg(straight, order.speed, so_far_.motion(), rules_);
    leg.shape = leg_shape({0.0, -0.5 * order.bend, 0.0}, leg.profile,
                          rules_.manner.bends_by_way ? Bends::by_way : Bends::in_time);
    if (radius * sharpest_bend({0.0, 0.5 * order.bend, 0.0}) > straight) {
      throw std::invalid_argument(
          fmt::format("a leg of {:.3g} m is to bend by {:.3g} rad, sharper than the robot's "
                      "tightest bend, of radius {:.3g} m",
                      straight, order.bend, radius));
    }
    leg.shape.end = end_on_course(leg, so_far_.motion(), rules_);
    const Vector2 way = radius > 0.0 ? turn_in_arcs_to(leg, order.turn_rate)
                                     : spin_to(leg, order.turn_rate, order.turn);
    drive_shape(leg, way);
    so_far_.stop(landmark);
    if (rules_.style.overrun > 0.0) {
      so_far_.drive_on(rules_.style.overrun, order.speed, leg.course);
    }
  }

  [[nodiscard]] TrueMotion take() {
    if (rules_.style.last_rest > 0.0) so_far_.rest(rules_.style.last_rest);
    return so_far_.motion();
  }

 private:
  Vector2 stop_near(int landmark) { return mesh_.positions[idx(landmark)] + draws_.standing(); }

  /// The next stop's, as seen from the axle, in the axes of a robot of heading 0.
  [[nodiscard]] Vector2 sensor() const {
    return rules_.bias.sensor_at(so_far_.motion().stops.size());
  }

  /// On the spot, or in circles.
  void turn_round(double angle) {
    const double radius = rules_.manner.turning_radius;
    const double rate = draws_.turn_rate();
    if (radius == 0.0) return so_far_.spin(angle, rate);
    so_far_.circle(angle, radius, rate);
  }

  /// Turns to a leg, whose shape is still to be drawn, and drives it.
  void drive(PlannedLeg leg, double wanted_speed) {
    const double straight = (leg.target - so_far_.pose().position()).norm();
    leg.profile = profile_of_leg(straight, wanted_speed, so_far_.motion(), rules_);
    leg.shape = draws_.shape(leg.profile, straight);
    leg.shape.end = end_on_course(leg, so_far_.motion(), rules_);
    drive_shape(leg, rules_.manner.turning_radius > 0.0 ? turn_in_arcs_to(leg) : spin_to(leg));
  }

  /// Drives a leg to which the robot has turned.
  void drive_shape(const PlannedLeg& leg, const Vector2& way) {
    const double offset = so_far_.pose().heading - leg.shape.headings.front();
    std::vector<double> headings = leg.shape.headings;
    for (double& heading : headings) heading = offset + heading;
    so_far_.drive(way.norm() / leg.shape.end.norm(), leg.course, leg.profile, headings);
  }

  /// The whole turns that are ordered.
  void circle_whole_turns(const LegOrder& order) {
    const double turns = std::round(order.turn / (2.0 * pi));
    if (turns == 0.0) return;
    so_far_.circle(turns * 2.0 * pi, rules_.manner.turning_radius, order.turn_rate);
  }

  /// Returns where the leg has to lead then, m. `rate` [rad/s]: none: drawn.
  Vector2 spin_to(const PlannedLeg& leg, std::optional<double> rate = {}, double about = 0.0) {
    Vector2 way = way_after_spin(leg, about, so_far_, rules_.bias);
    so_far_.spin(turn_to(way, leg.shape, so_far_.pose(), about), rate ? *rate : draws_.turn_rate());
    return way;
  }

  /// The same in arcs. Their number is an earlier path's.
  Vector2 turn_in_arcs_to(const PlannedLeg& leg, std::optional<double> rate = {}) {
    const std::vector<double>& turns = rules_.bias.turns;
    const std::size_t at = so_far_.motion().turns.size();
    const Vector2 way = way_to(leg.target, leg, so_far_.pose());
    const double about = at < turns.size() ? turns[at] : turn_to(way, leg.shape, so_far_.pose());
    std::vector<double> rates(idx(arcs_of_turn(about, rules_.manner)));
    for (double& one : rates) one = rate ? *rate : draws_.turn_rate();
    const TurnInArcs arcs = turn_in_arcs(leg, about, rates, so_far_, rules_);
    so_far_.turn_in_arcs(about, arcs.turn, rules_.manner.turning_radius, arcs.rows);
    return arcs.way;
  }

  const Mesh& mesh_;
  PathRules rules_;
  PathDraws draws_;
  MotionSoFar so_far_;
};

}  // namespace

Vector2 PathBias::step_of(double way, const Vector2& ahead, const Vector2& course,
                          std::size_t row) const {
  const Vector2 step = way * ahead;
  Vector2 moved = course.x() * step;
  if (course.y() != 0.0) moved += course.y() * quarter_turn(step);
  if (!slip.empty()) moved += slip_of(row) * course.x() * quarter_turn(step);
  return moved;
}

TrueMotion lay_path(const Mesh& mesh, const std::vector<int>& walk, const DrivingStyle& style,
                    std::uint64_t seed, const PathBias& bias, const DrivingManner& manner) {
  check_style(style);
  check_walk(mesh, walk, style.standing, manner.turning_radius);
  check_orders(style, walk.size() - 1);
  const std::size_t legs = walk.size() - 1;
  const auto spins_until = [&](std::size_t leg) {
    return leg * static_cast<std::size_t>(style.full_spins) / legs;
  };
  Path path(mesh, {style, bias, manner}, seed);
  path.start_at(walk.front());
  for (std::size_t k = 0; k < legs; ++k) {
    if (style.orders.empty()) {
      path.go(walk[k + 1], spins_until(k + 1) > spins_until(k));
    } else {
      path.go(walk[k + 1], style.orders[k]);
    }
  }
  TrueMotion motion = path.take();
  motion.further = style.orders.empty() ? further_columns(motion, style.covariates, seed)
                                        : ordered_columns(motion, style);
  return motion;
}

}  // namespace trussmap::simulation
