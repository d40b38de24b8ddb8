// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/slow_covariates.hpp"

#include <algorithm>

namespace trussmap::drive {
namespace {

constexpr int kBlocks = 10;        // of a recording, equally long
constexpr std::size_t kRows = 10;  // fewer in a block on average say nothing
constexpr double kWithin = 0.1;    // of the variance

/// Sum of squares about the mean, row by row.
struct Squares {
  double count = 0.0;
  double mean = 0.0;
  double sum = 0.0;

  void add(double value) {
    count += 1.0;
    const double off = value - mean;
    mean += off / count;
    sum += off * (value - mean);
  }
};

bool is_slow(const std::string& name, const std::vector<DrivenRecording>& recordings) {
  Squares total;
  double within = 0.0;
  for (const DrivenRecording& recording : recordings) {
    const MotionRows& drive = recording.drive;
    const Covariate* covariate = find_covariate(drive, name);
    if (covariate == nullptr || drive.rows() < kRows * kBlocks) return false;
    std::vector<Squares> blocks(kBlocks);
    const double length = drive.t.back() - drive.t.front();
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      const int block = static_cast<int>(kBlocks * (drive.t[row] - drive.t.front()) / length);
      blocks[static_cast<std::size_t>(std::min(block, kBlocks - 1))].add(covariate->values[row]);
      total.add(covariate->values[row]);
    }
    for (const Squares& block : blocks) within += block.sum;
  }
  return total.sum > 0.0 && within <= kWithin * total.sum;
}

}  // namespace

const Covariate* find_covariate(const MotionRows& drive, const std::string& name) {
  for (const Covariate& one : drive.covariates) {
    if (one.name == name) return &one;
  }
  return nullptr;
}

std::vector<std::string> slow_covariates(const std::vector<DrivenRecording>& recordings) {
  std::vector<std::string> names;
  if (recordings.empty()) return names;
  for (const Covariate& one : recordings.front().drive.covariates) {
    if (is_slow(one.name, recordings)) names.push_back(one.name);
  }
  return names;
}

}  // namespace trussmap::drive
