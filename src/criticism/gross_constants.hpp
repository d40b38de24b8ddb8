// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Constants before noise. A drive whose scale, track or ratio of wheels is wrong by much leaves
// errors that any noise can be made large enough for, and a map so far from the right one that no
// score test about it means anything. So the numbers that every robot has (CatalogueRecord,
// robot_constant) are fitted first, all at once, with the noise as the model states it:
//
//   from the fit as given
//   where that leaves far too much, from where a calibration finds the drive's own constants
//   where none leads anywhere, from what turns and returns to landmarks say (gross_starts.hpp)
//   first of all from a calibration, where it finds a sensor 0.3 m and more from where it is stated
//   to sit
//
// Those that the data do not surely show, by the scatter that is left, go again. They are kept
// where they explain most of the misfit and one of the drive's factors is off by 5 % and more, or a
// sensor by 0.3 m (0.2 rad), or where a handful of measurements can tell of nothing else; smaller
// ones are left to the tests of all effects. Where much is left all the same the gate is lifted
// while they are sought. One wheel of another size, or all of them, stands for a ratio, a scale and
// a turning where it explains as much. Where constants leave much one error of another kind may
// explain it (gross_cause.hpp). Without a measured distance no scale is asked for. None of this is
// done where small errors explain a gross misfit (small_causes.hpp).
#pragma once

#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"

#include <cstddef>
#include <optional>
#include <vector>

namespace trussmap::criticism {

/// The given model with gross constants.
struct GrossConstants {
  ModelFit fit;           ///< they are its last effects, the surest first
  std::size_t first = 0;  ///< the place of the first of them
};

/// Nothing where there are none. `given`: the model's fit of these recordings under stated noise.
/// `legs`: what is held out to judge them by.
[[nodiscard]] std::optional<GrossConstants> gross_constants(
    const std::vector<DrivenRecording>& recordings, const ModelFit& given, const LegOptions& legs);

/// Each as a finding that is missing, with its fitted size and what else could leave its trace.
/// `given`: the fit without them, under the same noise.
[[nodiscard]] std::vector<Finding> findings_of(const std::vector<DrivenRecording>& recordings,
                                               const ModelFit& given,
                                               const GrossConstants& constants,
                                               const LegOptions& legs);

}  // namespace trussmap::criticism
