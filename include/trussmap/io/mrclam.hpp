// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The UTIAS multi-robot data sets (MRCLAM: Leung, Halpern, Barfoot & Liu, 2011) as recordings.
//
//   DIR/RobotN_Odometry.dat      time, forward velocity [m/s], angular velocity [rad/s]
//   DIR/RobotN_Measurement.dat   time, barcode, range [m], bearing [rad]
//   DIR/Barcodes.dat             subject, barcode: subjects 1-5 are robots, the rest landmarks
//   DIR/Landmark_Groundtruth.dat subject, x, y, sd of x, sd of y       (optional)
//   DIR/RobotN_Groundtruth.dat   time, x, y, heading                   (optional)
//
// each plain or with .xz. A velocity holds from its row's time until the next row's. Times that
// repeat or run backwards are merged into the row before; sightings of robots, of unknown barcodes
// and outside of the drive are dropped; sightings within 5 ms of one another are one camera frame
// and get its first time. All of that is counted. Times are counted from the epoch, a whole second.
#pragma once

#include "trussmap/effects/model.hpp"
#include "trussmap/recording/recording.hpp"

#include <filesystem>

namespace trussmap {

struct MrclamRecording {
  Recording recording;
  Model model;  ///< the maker's wheelbase and noise that suits these robots

  double epoch = 0.0;           ///< s, Unix time of t = 0
  int merged_times = 0;         ///< odometry rows whose time repeats or runs backwards
  int robots_seen = 0;          ///< sightings of other robots, dropped
  int unknown_barcodes = 0;     ///< sightings of barcodes that belong to nothing, dropped
  int outside_drive = 0;        ///< sightings before or after the odometry, dropped
  int same_frame = 0;           ///< sightings whose time was set to their frame's
  int unordered_sightings = 0;  ///< sightings earlier than the one before, sorted in
};

/// True if `prefix` (DIR/RobotN) names such files.
[[nodiscard]] bool is_mrclam(const std::filesystem::path& prefix);

/// Throws InputError with file and line.
[[nodiscard]] MrclamRecording read_mrclam(const std::filesystem::path& prefix);

}  // namespace trussmap
