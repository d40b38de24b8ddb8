// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/true_motion.hpp"

#include "geometry/index.hpp"
#include "simulation/driving_checks.hpp"
#include "simulation/further_columns.hpp"
#include "simulation/leg_shape.hpp"
#include "trussmap/simulation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <span>
#include <utility>

namespace trussmap {
namespace {

constexpr int kPasses = 60;
constexpr double kEase = 0.8;  // of its tightest bend: how sharply a robot bends a leg

using std::numbers::pi;

/// The path so far, to which segments are added.
class Path {
 public:
  Path(const Mesh& mesh, const DrivingStyle& style, std::uint64_t seed, const PathBias& bias,
       const DrivingManner& manner)
      : mesh_(mesh),
        style_(style),
        bias_(bias),
        manner_(manner),
        random_(random_stream(seed, Stream::path)) {
    warm_at_ = uniform(0.0, 2.0 * pi);
  }

  void start_at(int landmark) {
    pose_ = {0.0, 0.0, 0.0};
    set_position(stop_near(landmark) - sensor());
    motion_.start = pose_;
    change_surroundings();
    if (style_.first_rest > 0.0) rest(style_.first_rest);
    stop(landmark);
  }

  /// Drives from the landmark where the robot stands to another; `spin_first` turns it round twice
  /// to the left and twice to the right before.
  void go(int landmark, bool spin_first) {
    if (chance(style_.rest_share)) rest(uniform(style_.shortest_rest, style_.longest_rest));
    if (spin_first) {
      turn_round(4.0 * pi);
      turn_round(-4.0 * pi);
    }
    const Vector2 target = stop_near(landmark);
    const double speed = uniform(style_.slowest, style_.fastest);
    const bool has_corner = chance(style_.corner_share);
    const double side = uniform(-1.0, 1.0);
    course_ = draw_course();
    if (has_corner) {
      const Vector2 way = target - pose_.position();
      drive(pose_.position() + 0.5 * way + side * style_.corner_reach * quarter_turn(way), speed);
    }
    arriving_ = true;
    drive(target, speed);
    arriving_ = false;
    stop(landmark);
    if (style_.overrun > 0.0) drive_on(style_.overrun, speed);
    change_surroundings();
  }

  [[nodiscard]] TrueMotion take() {
    if (style_.last_rest > 0.0) rest(style_.last_rest);
    return std::move(motion_);
  }

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

  /// The next stop's sensor as seen from the axle, in the axes of a robot of heading 0.
  [[nodiscard]] Vector2 sensor() const {
    const std::size_t stop = motion_.stops.size();
    return stop < bias_.sensor.size() ? bias_.sensor[stop] : Vector2::Zero();
  }

  /// Where the robot's next leg leads in its own axes: of length 1.
  Vector2 draw_course() {
    if (manner_.backwards > 0.0 && chance(manner_.backwards)) return {-1.0, 0.0};
    if (manner_.aside == 0.0) return {1.0, 0.0};
    const double aside = uniform(-manner_.aside, manner_.aside);
    return {std::cos(aside), std::sin(aside)};
  }

  /// How many rows the next segment has: as many as are wanted, or as an earlier path's.
  int rows_of_segment(int wanted) {
    const std::size_t segment = motion_.segments.size();
    motion_.segments.push_back(segment < bias_.segments.size() ? bias_.segments[segment] : wanted);
    return motion_.segments.back();
  }

  [[nodiscard]] double jump_of(std::size_t row) const {
    return row < bias_.jump.size() ? bias_.jump[row] : 0.0;
  }

  [[nodiscard]] double slip_of(std::size_t row) const {
    return row < bias_.slip.size() ? bias_.slip[row] : 0.0;
  }

  /// Where so much way on the course takes the robot whose axis ahead is this on average, and the
  /// slip of the row with it.
  [[nodiscard]] Vector2 step_of(double way, const Vector2& ahead, std::size_t row) const {
    const Vector2 step = way * ahead;
    Vector2 moved = course_.x() * step;
    if (course_.y() != 0.0) moved += course_.y() * quarter_turn(step);
    if (!bias_.slip.empty()) moved += slip_of(row) * course_.x() * quarter_turn(step);
    return moved;
  }

  void set_position(const Vector2& position) {
    pose_.x = position.x();
    pose_.y = position.y();
  }

  /// Time at the end of a number of rows, in whole nanoseconds so that 3 x 0.1 s is not
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
  void add_row(Activity activity, double speed, double turn_rate, double jump = 0.0) {
    const double t = time_after(motion_.rows.size() + 1);
    surroundings_.temperature_C = temperature(t);
    const double slip_speed = slip_of(motion_.rows.size()) * speed;
    motion_.rows.push_back({t, style_.row_duration, speed, turn_rate, activity, pose_,
                            surroundings_, slip_speed, jump});
  }

  /// A row of driving on the course, m and m/s, between two headings.
  void drive_row(double way, double speed, double first, double last) {
    set_position(pose_.position() + step_of(way, unit_step(first, last), motion_.rows.size()));
    pose_.heading = last;
    add_row(Activity::drive, speed * course_.x(), (last - first) / style_.row_duration);
    motion_.rows.back().sideways = speed * course_.y();
  }

  void rest(double seconds) {
    const int rows = rows_of_segment(whole_rows(seconds, style_.row_duration));
    for (int k = 0; k < rows; ++k) add_row(Activity::rest, 0.0, 0.0);
  }

  void spin(double angle) {
    const double wanted_rate = uniform(style_.slowest_turn, style_.fastest_turn);
    int rows = rows_of_segment(
        angle == 0.0 ? 0 : whole_rows(std::abs(angle) / wanted_rate, style_.row_duration));
    if (rows == 0 && angle != 0.0) rows = motion_.segments.back() = 1;
    const double before = pose_.heading;
    for (int k = 1; k <= rows; ++k) {
      const double heading = before + angle * k / rows;
      const double jump = jump_of(motion_.rows.size());
      set_position(pose_.position() + jump * unit_step(pose_.heading, heading));
      pose_.heading = heading;
      add_row(Activity::spin, 0.0, angle / (rows * style_.row_duration), jump);
    }
  }

  /// Where a spin by an angle, which is next, will leave the robot by its jumps, from here.
  [[nodiscard]] Vector2 jumped(double angle) const {
    Vector2 sum = Vector2::Zero();
    const std::size_t segment = motion_.segments.size();
    const int rows = segment < bias_.segments.size() ? bias_.segments[segment] : 0;
    for (int k = 0; k < rows; ++k) {
      const double from = pose_.heading + angle * k / rows;
      sum += jump_of(motion_.rows.size() + idx(k)) * unit_step(from, from + angle / rows);
    }
    return sum;
  }

  /// A bend that leaves the leg, so long [m], a leg: not so large that it leads back to where it
  /// began, nor sharper than the robot's tightest.
  LegShape draw_shape(const std::vector<double>& profile, double leg) {
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

  /// How many segments the next turn has, by an earlier path.
  [[nodiscard]] std::size_t segments_of_turn() const {
    const std::size_t turn = motion_.turns.size();
    return turn < bias_.turns.size() ? idx(arcs_of_turn(bias_.turns[turn], manner_)) : 1;
  }

  void drive(const Vector2& target, double wanted_speed) {
    const double dt = style_.row_duration;
    const Vector2 straight = target - pose_.position();
    const std::size_t segment = motion_.segments.size() + segments_of_turn();
    const int rows = segment < bias_.segments.size()
                         ? bias_.segments[segment]
                         : whole_rows(straight.norm() / wanted_speed, dt);
    const int ramp_rows = std::min(static_cast<int>(std::lround(style_.ramp / dt)), rows / 2);
    const std::vector<double> profile = speed_profile(rows, ramp_rows);
    LegShape shape = draw_shape(profile, straight.norm());
    shape.end = end_on_course(shape, profile);
    const Vector2 way =
        manner_.turning_radius > 0.0 ? turn_in_arcs(target, shape) : turn_on_spot(target, shape);
    const double length = way.norm() / shape.end.norm();

    const double offset = pose_.heading - shape.headings.front();
    const double speed = length / (rows * dt);
    rows_of_segment(rows);
    for (int k = 1; k <= rows; ++k) {
      const double share = profile[idx(k - 1)];
      drive_row(length / rows * share, speed * share, offset + shape.headings[idx(k - 1)],
                offset + shape.headings[idx(k)]);
    }
  }

  /// What is to be turned before a leg of this shape leads there, rad.
  [[nodiscard]] double turn_to(const Vector2& way, const LegShape& shape) const {
    const double turned = direction(way) - direction(shape.end);
    return wrap_angle(turned + shape.headings.front() - pose_.heading);
  }

  /// Returns where the leg has to lead then, m.
  Vector2 turn_on_spot(const Vector2& target, const LegShape& shape) {
    Vector2 way = way_to(target, shape);
    for (int pass = 0; pass < kPasses && !bias_.jump.empty(); ++pass) {
      way = way_to(target - jumped(turn_to(way, shape)), shape);
    }
    spin(turn_to(way, shape));
    return way;
  }

  /// The same where the arcs take the robot off its place. Their number is an earlier path's.
  Vector2 turn_in_arcs(const Vector2& target, const LegShape& shape) {
    const Vector2 course = std::exchange(course_, Vector2(1.0, 0.0));
    Vector2 way = way_to(target, shape);
    const std::size_t at = motion_.turns.size();
    const double about = at < bias_.turns.size() ? bias_.turns[at] : turn_to(way, shape);
    std::vector<double> rates(idx(arcs_of_turn(about, manner_)));
    for (double& rate : rates) rate = uniform(style_.slowest_turn, style_.fastest_turn);
    double turn = about;
    for (int pass = 0; pass < kPasses; ++pass) {
      way = way_to(target - moved_by_arcs(turn, rates), shape);
      turn = about + wrap_angle(turn_to(way, shape) - about);
    }
    const std::vector<int> rows = rows_of_arcs(turn, rates);
    motion_.turns.push_back(about);
    motion_.segments.insert(motion_.segments.end(), rows.begin(), rows.end());
    for (const ArcRow& row : turning_arcs(turn, manner_.turning_radius, rows)) {
      drive_row(row.way, row.way / style_.row_duration, pose_.heading, pose_.heading + row.turn);
    }
    course_ = course;
    return way;
  }

  /// Of a turn, which is next.
  [[nodiscard]] std::vector<int> rows_of_arcs(double turn, const std::vector<double>& rates) const {
    const std::size_t known = std::min(bias_.segments.size(), motion_.segments.size());
    return trussmap::rows_of_arcs(turn, rates, style_.row_duration,
                                  std::span(bias_.segments).subspan(known));
  }

  /// From here, m.
  [[nodiscard]] Vector2 moved_by_arcs(double turn, const std::vector<double>& rates) const {
    Vector2 sum = Vector2::Zero();
    double heading = pose_.heading;
    std::size_t at = motion_.rows.size();
    for (const ArcRow& row :
         turning_arcs(turn, manner_.turning_radius, rows_of_arcs(turn, rates))) {
      sum += step_of(row.way, unit_step(heading, heading + row.turn), at++);
      heading += row.turn;
    }
    return sum;
  }

  /// On the spot, or in circles.
  void turn_round(double angle) {
    if (manner_.turning_radius == 0.0) return spin(angle);
    course_ = {1.0, 0.0};
    const double rate = uniform(style_.slowest_turn, style_.fastest_turn);
    const int rows = rows_of_segment(whole_rows(std::abs(angle) / rate, style_.row_duration));
    for (const ArcRow& row : turning_arcs(angle, manner_.turning_radius, {rows})) {
      drive_row(row.way, row.way / style_.row_duration, pose_.heading, pose_.heading + row.turn);
    }
  }

  /// Where the leg leads if it is 1 m long, its course and the slip of its rows considered.
  [[nodiscard]] Vector2 end_on_course(const LegShape& shape,
                                      const std::vector<double>& profile) const {
    if (bias_.slip.empty()) {
      if (course_.y() == 0.0) return course_.x() * shape.end;
      return course_.x() * shape.end + course_.y() * quarter_turn(shape.end);
    }
    std::size_t first = motion_.rows.size();
    for (std::size_t k = 0; k < segments_of_turn(); ++k) {
      const std::size_t segment = motion_.segments.size() + k;
      if (segment < bias_.segments.size()) first += idx(bias_.segments[segment]);
    }
    Vector2 end = Vector2::Zero();
    for (std::size_t k = 0; k < profile.size(); ++k) {
      const Vector2 ahead = unit_step(shape.headings[k], shape.headings[k + 1]);
      end += profile[k] / static_cast<double>(profile.size()) * step_of(1.0, ahead, first + k);
    }
    return end;
  }

  /// From here to where the axle must stop for the sensor to be on the target: that depends on the
  /// heading of arrival, which depends on the way. Far shorter than the way, a lever converges.
  [[nodiscard]] Vector2 way_to(const Vector2& target, const LegShape& shape) const {
    Vector2 straight = target - pose_.position();
    const Vector2 ahead = arriving_ ? sensor() : Vector2::Zero();
    if (ahead.isZero(0.0)) return straight;
    Vector2 way = straight;
    for (int pass = 0; pass < kPasses; ++pass) {
      const double arrival = direction(way) - direction(shape.end) + shape.headings.back();
      way = straight - rotation(arrival) * ahead;
    }
    return way;
  }

  /// Straight on.
  void drive_on(double length, double wanted_speed) {
    const int rows = rows_of_segment(whole_rows(length / wanted_speed, style_.row_duration));
    for (int k = 0; k < rows; ++k) {
      drive_row(length / rows, length / (rows * style_.row_duration), pose_.heading, pose_.heading);
    }
  }

  const Mesh& mesh_;
  const DrivingStyle& style_;
  const PathBias& bias_;
  const DrivingManner& manner_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double warm_at_ = 0.0;         ///< phase of the temperature, rad
  bool arriving_ = false;        ///< driving to a landmark, not to a corner
  Vector2 course_ = {1.0, 0.0};  ///< where the leg leads, robot axes
  Pose pose_;
  Surroundings surroundings_;
  TrueMotion motion_;
};

}  // namespace

TrueMotion lay_path(const Mesh& mesh, const std::vector<int>& walk, const DrivingStyle& style,
                    std::uint64_t seed, const PathBias& bias, const DrivingManner& manner) {
  check_style(style);
  check_walk(mesh, walk, style.standing, manner.turning_radius);
  const std::size_t legs = walk.size() - 1;
  const auto spins_until = [&](std::size_t leg) {
    return leg * static_cast<std::size_t>(style.full_spins) / legs;
  };
  Path path(mesh, style, seed, bias, manner);
  path.start_at(walk.front());
  for (std::size_t k = 0; k < legs; ++k) {
    path.go(walk[k + 1], spins_until(k + 1) > spins_until(k));
  }
  TrueMotion motion = path.take();
  motion.further = further_columns(motion, style.covariates, seed);
  return motion;
}

}  // namespace trussmap
