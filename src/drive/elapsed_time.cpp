// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/elapsed_time.hpp"

namespace trussmap::drive {

std::vector<double> elapsed_shifts(const std::vector<DrivenRecording>& recordings) {
  std::vector<double> shifts;
  double before = 0.0;
  for (const DrivenRecording& one : recordings) {
    const MotionRows& drive = one.drive;
    if (drive.rows() == 0) {
      shifts.push_back(before);
      continue;
    }
    shifts.push_back(before - drive.start());
    before += drive.t.back() - drive.start();
  }
  return shifts;
}

}  // namespace trussmap::drive
