// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The map.toml by which a bag of ours becomes a recording again.
#pragma once

#include "trussmap/log_files.hpp"

#include <string>
#include <utility>
#include <vector>

namespace trussmap::logs {

struct BagMapParts {
  /// Columns of the drive, their joints, and whether they steer.
  struct Wheel {
    std::string column;
    std::string joint;
    bool steers = false;
  };
  std::vector<Wheel> wheels;
  std::vector<std::pair<std::string, std::string>> ranges;      ///< topic, landmark
  std::vector<std::pair<std::string, std::string>> covariates;  ///< name, topic
  bool yaws = false;  ///< whether all transforms are turned by a yaw that was read
};

/// `bag` has its topics. The survey, which no message holds, stands in the map itself.
[[nodiscard]] std::string bag_map(const Bag& bag, const BagMapParts& parts,
                                  const DrivenRecording& recording, const Model& model,
                                  const BagOptions& options);

}  // namespace trussmap::logs
