// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/row_variables.hpp"

#include "drive/as_read.hpp"
#include "drive/body_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace trussmap::drive {
namespace {

constexpr double kStandingSpeed = 0.005;  // m/s, of the faster wheel
constexpr double kSpinShare = 0.2;        // of the wheels' speed that the middle may have in a spin

/// First and one past the last row of the same kind within half a window of the row's middle.
struct Span {
  std::size_t first;
  std::size_t end;
};

std::vector<Span> windows(const MotionRows& drive, const std::vector<MotionKind>& kinds) {
  std::vector<Span> spans(drive.rows());
  const auto middle = [&drive](std::size_t row) {
    return drive.t[row] - 0.5 * drive.duration(row);
  };
  std::size_t first = 0;
  std::size_t end = 0;
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    if (row > 0 && kinds[row] != kinds[row - 1]) first = row;
    while (middle(row) - middle(first) > 0.5 * kRateWindow + 1e-9) ++first;
    end = std::max(end, row + 1);
    while (end < drive.rows() && kinds[end] == kinds[row] &&
           middle(end) - middle(row) <= 0.5 * kRateWindow + 1e-9) {
      ++end;
    }
    spans[row] = {first, end};
  }
  return spans;
}

/// Mean rate over each window: sums of `amount` over sums of time.
std::vector<double> smoothed_rate(const MotionRows& drive, const std::vector<Span>& spans,
                                  const std::vector<double>& amount) {
  std::vector<double> sums(drive.rows() + 1, 0.0);
  for (std::size_t row = 0; row < drive.rows(); ++row) sums[row + 1] = sums[row] + amount[row];
  std::vector<double> rates;
  rates.reserve(drive.rows());
  for (const Span& span : spans) {
    const double begin = span.first == 0 ? drive.start() : drive.t[span.first - 1];
    rates.push_back((sums[span.end] - sums[span.first]) / (drive.t[span.end - 1] - begin));
  }
  return rates;
}

/// Slope of the smoothed speed over each window, by its ends.
std::vector<double> slopes(const MotionRows& drive, const std::vector<Span>& spans,
                           const std::vector<double>& values) {
  std::vector<double> result;
  result.reserve(drive.rows());
  for (const Span& span : spans) {
    const std::size_t last = span.end - 1;
    const double time = drive.t[last] - drive.t[span.first];
    result.push_back(time > 0.0 ? (values[last] - values[span.first]) / time : 0.0);
  }
  return result;
}

std::vector<double> reversals(const std::vector<double>& travel) {
  std::vector<double> events(travel.size(), 0.0);
  double sense = 0.0;
  for (std::size_t row = 0; row < travel.size(); ++row) {
    if (std::abs(travel[row]) < kMoving) continue;
    const double now = travel[row] > 0.0 ? 1.0 : -1.0;
    if (sense != 0.0 && now != sense) events[row] = 1.0;
    sense = now;
  }
  return events;
}

std::vector<double> beginnings(const std::vector<MotionKind>& kinds, MotionKind of) {
  std::vector<double> events(kinds.size(), 0.0);
  for (std::size_t row = 0; row < kinds.size(); ++row) {
    if (kinds[row] == of && (row == 0 || kinds[row - 1] != of)) events[row] = 1.0;
  }
  return events;
}

}  // namespace

MotionKind motion_kind(const WheelTravel& travel, double duration, double sideways) {
  const auto [left, right] = travel;
  if (sideways != 0.0) {  // who moves to the side drives as who moves ahead
    const double ahead = 0.5 * (left + right);
    const double more = std::hypot(ahead, sideways) - ahead;
    return motion_kind({left + more, right + more}, duration);
  }
  const double fastest = std::max(std::abs(left), std::abs(right));
  if (fastest < kStandingSpeed * duration) return MotionKind::standing;
  if (std::abs(left + right) < kSpinShare * std::abs(right - left)) return MotionKind::spinning;
  return MotionKind::driving;
}

std::vector<MotionKind> motion_kinds(const MotionRows& drive, const Robot& robot) {
  std::vector<MotionKind> kinds;
  kinds.reserve(drive.rows());
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    kinds.push_back(motion_kind(own_travel(drive, row, robot), drive.duration(row),
                                drive.wheel_motion(row).sideways));
  }
  return kinds;
}

std::size_t row_at(const MotionRows& drive, double t) {
  const auto at = std::lower_bound(drive.t.begin(), drive.t.end(), t);
  return std::min(static_cast<std::size_t>(at - drive.t.begin()), drive.rows() - 1);
}

namespace {

/// What is turned, by the smoothed rates: of single rows' noise the size would be a bias.
void take_turning(const MotionRows& drive, const std::vector<MotionKind>& kinds,
                  RowVariables& variables) {
  const std::vector<double>& speed = variables.at("speed");
  const std::vector<double>& turn_rate = variables.at("turn_rate");
  std::vector<double>& curvature = variables["curvature"];
  std::vector<double>& arc = variables["arc_angle"];
  std::vector<double>& spin = variables["spin_angle"];
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const double angle = std::abs(turn_rate[row]) * drive.duration(row);
    const bool drives = kinds[row] == MotionKind::driving && speed[row] != 0.0;
    curvature.push_back(drives ? turn_rate[row] / speed[row] : 0.0);
    arc.push_back(kinds[row] == MotionKind::driving ? angle : 0.0);
    spin.push_back(kinds[row] == MotionKind::spinning ? angle : 0.0);
  }
}

std::vector<double> wheel_travels(const MotionRows& drive, const Robot& robot,
                                  double WheelTravel::*wheel) {
  std::vector<double> travels(drive.rows());
  for (std::size_t row = 0; row < travels.size(); ++row) {
    travels[row] = own_travel(drive, row, robot).*wheel;
  }
  return travels;
}

/// Everything but the pose, in the middle of each row.
RowVariables drive_variables(const MotionRows& drive, const Robot& robot, int session) {
  const std::size_t rows = drive.rows();
  const std::vector<MotionKind> kinds = motion_kinds(drive, robot);
  const std::vector<Span> spans = windows(drive, kinds);
  RowVariables variables;
  std::vector<double>& t = variables["t"];
  std::vector<double>& distance = variables["distance"];
  double driven = 0.0;
  for (std::size_t row = 0; row < rows; ++row) {
    t.push_back(drive.t[row] - 0.5 * drive.duration(row) - drive.start());
    distance.push_back(driven + 0.5 * drive.way(row));
    driven += drive.way(row);
  }
  variables["speed"] = smoothed_rate(drive, spans, drive.forward);
  variables["turn_rate"] = smoothed_rate(drive, spans, drive.turn);
  variables["acceleration"] = slopes(drive, spans, variables["speed"]);
  take_turning(drive, kinds, variables);
  variables["session"] = std::vector<double>(rows, session);
  variables["starts"] = beginnings(kinds, MotionKind::driving);
  variables["spins"] = beginnings(kinds, MotionKind::spinning);
  variables["reverses_left"] = reversals(wheel_travels(drive, robot, &WheelTravel::left));
  variables["reverses_right"] = reversals(wheel_travels(drive, robot, &WheelTravel::right));
  for (const Covariate& covariate : drive.covariates) variables[covariate.name] = covariate.values;
  return variables;
}

}  // namespace

RowVariables row_variables(const MotionRows& drive, const Robot& robot, const Pose& start,
                           const std::vector<Pose>& path, int session) {
  if (!is_as_read(drive)) {
    return row_variables(as_read(drive, robot), robot, start, path, session);
  }
  const std::size_t rows = drive.rows();
  if (path.size() != rows) throw std::invalid_argument("a path has a pose per row of its drive");
  RowVariables variables = drive_variables(drive, robot, session);
  std::vector<double>& heading = variables["heading"];
  std::vector<double>& x = variables["x"];
  std::vector<double>& y = variables["y"];
  for (std::size_t row = 0; row < rows; ++row) {
    const Pose& before = row == 0 ? start : path[row - 1];
    heading.push_back(before.heading + 0.5 * wrap_angle(path[row].heading - before.heading));
    x.push_back(0.5 * (before.x + path[row].x));
    y.push_back(0.5 * (before.y + path[row].y));
  }
  return variables;
}

RowVariables instant_variables(const MotionRows& drive, const Robot& robot,
                               const std::vector<double>& instants, const std::vector<Pose>& poses,
                               int session) {
  if (poses.size() != instants.size()) throw std::invalid_argument("an instant has one pose");
  if (!is_as_read(drive)) {
    return instant_variables(as_read(drive, robot), robot, instants, poses, session);
  }
  const RowVariables by_row = drive_variables(drive, robot, session);
  const std::vector<MotionKind> kinds = motion_kinds(drive, robot);
  std::vector<std::size_t> rows;
  rows.reserve(instants.size());
  for (const double t : instants) rows.push_back(row_at(drive, t));
  RowVariables variables;
  for (const auto& [name, values] : by_row) {
    std::vector<double>& here = variables[name];
    here.reserve(rows.size());
    const bool rate = recording::is_rate(name);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const std::size_t row = rows[k];
      const bool meets_next =
          instants[k] >= drive.t[row] && row + 1 < drive.rows() && kinds[row] == kinds[row + 1];
      here.push_back(rate && meets_next ? 0.5 * (values[row] + values[row + 1]) : values[row]);
    }
  }
  const std::vector<double>& middle = by_row.at("distance");
  std::vector<double>& t = variables["t"];
  std::vector<double>& distance = variables["distance"];
  std::vector<double>& heading = variables["heading"];
  std::vector<double>& x = variables["x"];
  std::vector<double>& y = variables["y"];
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const std::size_t row = rows[k];
    const double length = drive.way(row);
    const double share = 1.0 - (drive.t[row] - instants[k]) / drive.duration(row);
    t[k] = instants[k] - drive.start();
    distance[k] = middle[row] + (share - 0.5) * length;
    heading.push_back(poses[k].heading);
    x.push_back(poses[k].x);
    y.push_back(poses[k].y);
  }
  return variables;
}

}  // namespace trussmap::drive
