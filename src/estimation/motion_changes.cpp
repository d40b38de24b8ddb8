// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/motion_changes.hpp"

#include "drive/body_motion.hpp"

#include <cmath>

namespace trussmap::estimation {
namespace {

/// Rows of one kind in a row.
struct Run {
  bool spin = false;
  double turn = 0.0;   ///< rad, all of it: turns there and back are as uncertain
  double path = 0.0;   ///< m, likewise
  double begin = 0.0;  ///< s, end of the row before
};

bool matters(const Run& run, const LeastMotion& least) {
  return run.spin ? run.turn >= least.spin : run.path >= least.drive;
}

std::vector<Run> runs_of(const MotionRows& drive, const std::vector<SegmentRow>& rows,
                         const Robot& robot) {
  std::vector<Run> runs;
  double begin = 0.0;
  for (const SegmentRow& row : rows) {
    const double about_centre = std::abs(drive::wheel_travel({0.0, 0.0, row.turn}, robot).right);
    if (row.path != 0.0 || row.turn != 0.0) {
      const bool spin = about_centre > std::abs(row.path);
      if (runs.empty() || runs.back().spin != spin) runs.push_back({spin, 0.0, 0.0, begin});
      runs.back().turn += std::abs(row.turn);
      runs.back().path += std::abs(row.path);
    }
    begin = drive.t[row.row];
  }
  return runs;
}

}  // namespace

std::vector<double> motion_changes(const MotionRows& drive, const std::vector<SegmentRow>& rows,
                                   const Robot& robot, const LeastMotion& least) {
  std::vector<double> times;
  bool any = false;
  bool spin = false;
  for (const Run& run : runs_of(drive, rows, robot)) {
    if (!matters(run, least)) continue;
    if (any && run.spin != spin) times.push_back(run.begin);
    any = true;
    spin = run.spin;
  }
  return times;
}

}  // namespace trussmap::estimation
