// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/well_formed.hpp"

#include "drive/body_motion.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace trussmap::drive {
namespace {

[[noreturn]] void refuse(const Observations& recording, const std::string& what) {
  throw std::invalid_argument("recording \"" + recording.name + "\": " + what);
}

void require_rows(const DrivenRecording& recording, const std::string& name,
                  const std::vector<double>& column) {
  if (column.size() == recording.drive.rows()) return;
  refuse(recording, text::joined("column ", name, " of the drive has ", column.size(),
                                 " rows, expected ", recording.drive.rows(), " as t has"));
}

void require_finite(const DrivenRecording& recording, const std::string& name,
                    const std::vector<double>& column) {
  for (std::size_t row = 0; row < column.size(); ++row) {
    if (std::isfinite(column[row])) continue;
    refuse(recording, text::joined("column ", name, " of the drive is not finite in row ", row,
                                   ", counted from 0"));
  }
}

void require_drive(const DrivenRecording& recording) {
  const MotionRows& drive = recording.drive;
  if (drive.rows() < 2) {
    refuse(recording, text::joined("the drive has ", drive.rows(), " rows, expected two at least"));
  }
  require_finite(recording, "t", drive.t);
  for (std::size_t row = 1; row < drive.rows(); ++row) {
    if (drive.t[row] > drive.t[row - 1]) continue;
    refuse(recording,
           text::joined("t of the drive does not increase in row ", row, ", counted from 0"));
  }
  const auto require_column = [&](const std::string& name, const std::vector<double>& column) {
    require_rows(recording, name, column);
    require_finite(recording, name, column);
  };
  if (drive.of_two_wheels()) {
    require_column("left", drive.pair.left);
    require_column("right", drive.pair.right);
  }
  require_column("forward", drive.forward);
  require_column("turn", drive.turn);
  if (drive.has_compass()) require_rows(recording, "heading", drive.heading);
  if (std::any_of(drive.heading.begin(), drive.heading.end(),
                  [](double reading) { return std::isinf(reading); })) {
    refuse(recording, "column heading of the drive is infinite in a row");
  }
  if (drive.has_gyro()) require_rows(recording, "yaw_rate", drive.yaw_rate);
  if (std::any_of(drive.yaw_rate.begin(), drive.yaw_rate.end(),
                  [](double reading) { return std::isinf(reading); })) {
    refuse(recording, "column yaw_rate of the drive is infinite in a row");
  }
  for (const Covariate& one : drive.covariates) require_column(one.name, one.values);
}

void require_wheelbase(const DrivenRecording& recording, const Robot& robot) {
  constexpr double kRounding = 1e-9;
  const MotionRows& drive = recording.drive;
  for (std::size_t row = 0; row < drive.pair.left.size() && drive.gyro.empty(); ++row) {
    const double turn = body_motion(drive.pair.at(row), robot.wheelbase).turn;
    if (std::abs(turn - drive.turn[row]) <= kRounding * (1.0 + std::abs(turn))) continue;
    refuse(recording, text::joined("its wheels turn it otherwise than two that are ",
                                   text::short_text(robot.wheelbase),
                                   " m apart, expected with_wheels with the robot of the model"));
  }
}

template <typename Rows>
void require_order(const DrivenRecording& recording, const char* name, const Rows& rows) {
  for (std::size_t k = 0; k < rows.size(); ++k) {
    if (std::isfinite(rows[k].t) && (k == 0 || rows[k].t >= rows[k - 1].t)) continue;
    refuse(recording, text::joined(name, " are not in order of time, at t = ",
                                   text::short_text(rows[k].t), " s"));
  }
}

void require_sightings(const DrivenRecording& recording) {
  const MotionRows& drive = recording.drive;
  require_order(recording, "sightings", recording.sightings);
  const double slack = clock_slack(drive);
  for (const Sighting& one : recording.sightings) {
    const auto refuse_it = [&](const std::string& why) {
      refuse(recording, text::joined("the sighting of ", one.landmark,
                                     " at t = ", text::short_text(one.t), " s ", why));
    };
    if (one.t < drive.start() - slack || one.t > drive.t.back() + slack) {
      refuse_it(text::joined("is outside the drive, expected ", text::short_text(drive.start()),
                             " to ", text::short_text(drive.t.back()), " s"));
    }
    if (std::isinf(one.range) || one.range < 0.0 || std::isinf(one.bearing)) {
      refuse_it("has a range or a bearing that is negative or infinite");
    }
    if (std::isinf(one.yaw) || std::isinf(one.dx) || std::isinf(one.dy)) {
      refuse_it("has a yaw, dx or dy that is infinite");
    }
    const bool beside = !std::isnan(one.dx) || !std::isnan(one.dy);
    if (beside && (std::isnan(one.dx + one.dy + one.yaw) || !one.standing())) {
      refuse_it("has a dx or dy without the other, without a yaw, or beside a range or bearing");
    }
  }
}

/// Absent, or one.
bool is_sd(double sd) {
  return std::isnan(sd) || (sd > 0.0 && std::isfinite(sd));
}

void require_loops(const DrivenRecording& recording) {
  const MotionRows& drive = recording.drive;
  const double slack = clock_slack(drive);
  const auto inside = [&](double t) {
    return t >= drive.start() - slack && t <= drive.t.back() + slack;
  };
  for (const Loop& loop : recording.loops) {
    const bool finite =
        std::isfinite(loop.dx) && std::isfinite(loop.dy) && std::isfinite(loop.dtheta);
    const bool sds = is_sd(loop.sd) && is_sd(loop.sd_heading);
    if (inside(loop.t) && inside(loop.t2) && loop.t != loop.t2 && finite && sds) continue;
    refuse(recording, text::joined("the loop from t = ", text::short_text(loop.t), " s to ",
                                   text::short_text(loop.t2),
                                   " s is not finite, or not between two instants of the drive"));
  }
}

void require_places(const DrivenRecording& recording) {
  require_order(recording, "truth rows", recording.truth);
  for (const TruthRow& row : recording.truth) {
    if (std::isfinite(row.x) && std::isfinite(row.y) && std::isfinite(row.heading)) continue;
    refuse(recording,
           text::joined("the truth at t = ", text::short_text(row.t), " s is not finite"));
  }
  require_order(recording, "fixes", recording.fixes);
  for (const Fix& fix : recording.fixes) {
    if (std::isfinite(fix.x) && std::isfinite(fix.y) && is_sd(fix.sd)) continue;
    refuse(recording, text::joined("the fix at t = ", text::short_text(fix.t),
                                   " s is not finite, or its sd not more than 0"));
  }
  for (const SurveyPoint& point : recording.survey) {
    const bool finite =
        std::isfinite(point.x) && std::isfinite(point.y) && !std::isinf(point.heading);
    if (finite) continue;
    refuse(recording, text::joined("the survey of ", point.landmark, " is not finite"));
  }
}

}  // namespace

double clock_slack(const DriveColumns& drive) {
  return 1e-9 + 8.0 * std::numeric_limits<double>::epsilon() * std::abs(drive.t.back());
}

void require_well_formed(const DrivenRecording& recording, const Robot& robot) {
  require_drive(recording);
  require_wheelbase(recording, robot);
  require_sightings(recording);
  require_places(recording);
  require_loops(recording);
}

void require_well_formed(const std::vector<DrivenRecording>& recordings, const Robot& robot) {
  for (const DrivenRecording& one : recordings) require_well_formed(one, robot);
}

}  // namespace trussmap::drive
