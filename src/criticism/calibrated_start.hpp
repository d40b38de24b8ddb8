// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A drive's constants, and where its sensors sit, as a calibration has them: where a fit of them
// may start from.
#pragma once

#include "trussmap/fit_model.hpp"

#include <vector>

namespace trussmap::criticism {

inline constexpr double kGross = 0.05;  ///< of a factor

/// Whether g of this channel says that a sensor sits, a wheel stands or steering points far from
/// where it is stated to.
[[nodiscard]] bool is_far_place(Channel channel, double g);

/// Whether a constant is: a factor by kGross, a place far from where it is stated.
[[nodiscard]] bool is_gross(const Effect& constant);

/// The constants as a calibration of the drive has them, where it leads anywhere, as a start.
struct CalibratedStart {
  std::vector<Effect> constants;
  /// Where it does not: as turns, chords and returns have them (gross_starts.hpp), the most
  /// promising first.
  std::vector<std::vector<Effect>> likely;
  bool found = false;
  bool gross = false;       ///< one of the drive's factors is
  bool far_places = false;  ///< a sensor, or the steering, is far from where it is stated
};

/// `constants`: those that are sought, without coefficients; so they stay where nothing was found.
/// Those that few robots have (sought_constants.hpp) are left out where the calibration has none:
/// wheels are told from sensors to the left, and not from the middle.
[[nodiscard]] CalibratedStart start_of_constants(const std::vector<DrivenRecording>& recordings,
                                                 const ModelFit& given,
                                                 std::vector<Effect> constants);

}  // namespace trussmap::criticism
