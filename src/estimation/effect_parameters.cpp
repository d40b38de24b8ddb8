// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/effect_parameters.hpp"

#include "drive/row_motion.hpp"

#include <algorithm>

namespace trussmap::estimation {

std::vector<int> unknown_coefficients(const EffectParameters& border) {
  std::vector<int> unknown;
  for (std::size_t k = 0; k < border.size(); ++k) {
    if (!border[k].held) unknown.push_back(static_cast<int>(k));
  }
  return unknown;
}

Eigen::VectorXd offsets_at(const EffectParameters& border, const Eigen::VectorXd& unknown) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(border.size()));
  Eigen::Index next = 0;
  for (std::size_t k = 0; k < border.size(); ++k) {
    const double value = border[k].held ? *border[k].held : unknown[next++];
    result[static_cast<Eigen::Index>(k)] = value - border[k].reference;
  }
  return result;
}

std::vector<effects::DrivePattern> summed_patterns_of(const EffectParameters& border,
                                                      const Eigen::VectorXd& offsets,
                                                      std::size_t session) {
  std::vector<effects::DrivePattern> sum;
  for (std::size_t k = 0; k < border.size(); ++k) {
    const double times = offsets[static_cast<Eigen::Index>(k)];
    if (times == 0.0 || border[k].drives.empty()) continue;
    const std::vector<effects::DrivePattern>& rows = border[k].drives[session];
    sum.resize(std::max(sum.size(), rows.size()));
    for (std::size_t row = 0; row < rows.size(); ++row) sum[row].add(times, rows[row]);
  }
  return sum;
}

std::vector<std::vector<effects::DrivePattern>> summed_patterns(const EffectParameters& border,
                                                                const Eigen::VectorXd& offsets,
                                                                std::size_t sessions) {
  std::vector<std::vector<effects::DrivePattern>> result;
  result.reserve(sessions);
  for (std::size_t session = 0; session < sessions; ++session) {
    result.push_back(summed_patterns_of(border, offsets, session));
  }
  return result;
}

std::vector<const std::vector<effects::DrivePattern>*> drive_patterns(
    const EffectParameters& border, std::size_t session) {
  std::vector<const std::vector<effects::DrivePattern>*> result;
  result.reserve(border.size());
  for (const EffectPattern& effect : border) {
    result.push_back(effect.drives.empty() ? nullptr : &effect.drives[session]);
  }
  return result;
}

EffectPattern plain_effect(Channel channel, const std::vector<DrivenRecording>& recordings,
                           const Robot& robot) {
  EffectPattern result;
  result.name = name_of(channel);
  for (const DrivenRecording& recording : recordings) {
    const MotionRows& drive = recording.drive;
    std::vector<effects::DrivePattern>& patterns = result.drives.emplace_back();
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      patterns.push_back(
          effects::drive_pattern(channel, 1.0, drive::row_motion(drive, row, robot)));
    }
  }
  return result;
}

}  // namespace trussmap::estimation
