// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What can have been done wrong with the columns of a drive with other wheels than two.
//
//   one column negated; those of one side; all travels
//   two columns exchanged; of three, all three in a circle; of four, both pairs
//   a steering angle in degrees, positive to the right, or both
//
// What makes no difference to the drive is left out: two wheels of one side exchanged.
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::check {

struct OtherDriveMistake {
  const char* kind = "";             ///< one of check_kinds()
  std::vector<std::size_t> order{};  ///< the k-th column is recorded as this one
  std::vector<double> factor{};      ///< by which the k-th has to be multiplied

  /// The columns that it changes.
  [[nodiscard]] std::vector<std::size_t> columns() const;
};

/// Simple ones first.
[[nodiscard]] std::vector<OtherDriveMistake> other_drive_mistakes(const Robot& robot);

/// "the sign of fl changed": how a finding says what is tried.
[[nodiscard]] std::string in_words(const OtherDriveMistake& mistake, const Robot& robot);
/// "change the sign of fl".
[[nodiscard]] std::string remedy_of(const OtherDriveMistake& mistake, const Robot& robot);

/// The drive as it would be without the mistake; nothing where that has an impossible row, or would
/// be the same.
[[nodiscard]] std::optional<MotionRows> drive_without(const OtherDriveMistake& mistake,
                                                      const MotionRows& drive, const Robot& robot);

}  // namespace trussmap::check
