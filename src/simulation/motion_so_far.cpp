// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "simulation/motion_so_far.hpp"

#include "geometry/index.hpp"
#include "simulation/leg_shape.hpp"

#include <cmath>

namespace trussmap::simulation {
namespace {

/// A day of the place, twenty minutes long, to the thermometer's thousandth of a degree.
double temperature(double t, double warm_at) {
  return std::round(1e3 * (20.0 + 6.0 * std::sin(t / 200.0 + warm_at))) / 1e3;
}

}  // namespace

void MotionSoFar::start_at(const Vector2& position) {
  pose_ = {position.x(), position.y(), style_.first_heading};
  motion_.start = pose_;
}

void MotionSoFar::stop(int landmark) {
  const std::size_t rows = motion_.rows.size();
  motion_.stops.push_back({time_after(rows), landmark, rows, pose_});
}

void MotionSoFar::rest(double seconds) {
  const int rows = rows_of_segment(whole_rows(seconds, style_.row_duration));
  for (int k = 0; k < rows; ++k) add_row(Activity::rest, 0.0, 0.0);
}

void MotionSoFar::spin(double angle, double wanted_rate) {
  int rows = rows_of_segment(
      angle == 0.0 ? 0 : whole_rows(std::abs(angle) / wanted_rate, style_.row_duration));
  if (rows == 0 && angle != 0.0) rows = motion_.segments.back() = 1;
  const double before = pose_.heading;
  for (int k = 1; k <= rows; ++k) {
    const double heading = before + angle * k / rows;
    const double jump = bias_.jump_of(motion_.rows.size());
    move(jump * unit_step(pose_.heading, heading));
    pose_.heading = heading;
    add_row(Activity::spin, 0.0, angle / (rows * style_.row_duration), jump);
  }
}

void MotionSoFar::turn_in_arcs(double about, double turn, double radius,
                               const std::vector<int>& rows) {
  motion_.turns.push_back(about);
  motion_.segments.insert(motion_.segments.end(), rows.begin(), rows.end());
  drive_arcs(turn, radius, rows);
}

void MotionSoFar::circle(double angle, double radius, double rate) {
  drive_arcs(angle, radius,
             {rows_of_segment(whole_rows(std::abs(angle) / rate, style_.row_duration))});
}

void MotionSoFar::drive_on(double length, double wanted_speed, const Vector2& course) {
  const int rows = rows_of_segment(whole_rows(length / wanted_speed, style_.row_duration));
  for (int k = 0; k < rows; ++k) {
    drive_row(length / rows, length / (rows * style_.row_duration), pose_.heading, course);
  }
}

void MotionSoFar::drive(double length, const Vector2& course, const std::vector<double>& profile,
                        const std::vector<double>& headings) {
  const int rows = rows_of_segment(static_cast<int>(profile.size()));
  const double speed = length / (rows * style_.row_duration);
  pose_.heading = headings.front();
  for (int k = 0; k < rows; ++k) {
    const double share = profile[idx(k)];
    drive_row(length / rows * share, speed * share, headings[idx(k + 1)], course);
  }
}

/// In whole nanoseconds so that 3 x 0.1 s is not 0.30000000000000004.
double MotionSoFar::time_after(std::size_t rows) const {
  return std::round(static_cast<double>(rows) * style_.row_duration * 1e9) / 1e9;
}

/// Begins a segment: of as many rows as are wanted, or as an earlier path's.
int MotionSoFar::rows_of_segment(int wanted) {
  motion_.segments.push_back(bias_.rows_of(motion_.segments.size(), wanted));
  return motion_.segments.back();
}

/// The row that ends at the present pose.
void MotionSoFar::add_row(Activity activity, double speed, double turn_rate, double jump) {
  const double t = time_after(motion_.rows.size() + 1);
  surroundings_.temperature_C = temperature(t, warm_at_);
  const double slip_speed = bias_.slip_of(motion_.rows.size()) * speed;
  motion_.rows.push_back(
      {t, style_.row_duration, speed, turn_rate, activity, pose_, surroundings_, slip_speed, jump});
}

/// A row of driving, m and m/s, to the heading at its end.
void MotionSoFar::drive_row(double way, double speed, double last, const Vector2& course) {
  const double first = pose_.heading;
  move(bias_.step_of(way, unit_step(first, last), course, motion_.rows.size()));
  pose_.heading = last;
  add_row(Activity::drive, speed * course.x(), (last - first) / style_.row_duration);
  motion_.rows.back().sideways = speed * course.y();
}

void MotionSoFar::drive_arcs(double turn, double radius, const std::vector<int>& rows) {
  for (const ArcRow& row : turning_arcs(turn, radius, rows)) {
    drive_row(row.way, row.way / style_.row_duration, pose_.heading + row.turn, {1.0, 0.0});
  }
}

void MotionSoFar::move(const Vector2& step) {
  const Vector2 position = pose_.position() + step;
  pose_.x = position.x();
  pose_.y = position.y();
}

}  // namespace trussmap::simulation
