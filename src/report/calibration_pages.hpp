// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The pages of calibrations: squares with a tape measure, one path driven often, drives with truth.
#pragma once

#include "report/page.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct SquareCalibration {
  std::vector<SquareRound> rounds;
  double side = 4.0;      ///< m
  Estimate wheelbase;     ///< m: to use from now on
  Estimate left_factor;   ///< likewise
  Estimate right_factor;  ///< likewise
  std::vector<std::string> doubts;
};

struct NoiseCalibration {
  EndErrors errors;
  NoiseEstimate estimate;
  NoiseFit fit;
  double path = 0.0;  ///< m, its length
  std::vector<std::string> doubts;
};

struct TruthCalibration {
  WheelCalibration wheels;
  ArrivalErrors nominal;     ///< of held-out legs
  ArrivalErrors calibrated;  ///< of the same
  std::string verdict;       ///< one sentence
};

}  // namespace trussmap
