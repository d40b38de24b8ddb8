// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/measured_distance.hpp"

#include "estimation/kinds/independent_rows.hpp"

#include <algorithm>
#include <cmath>

namespace trussmap::calibration {
namespace {

constexpr double kFar = 10.0;  // standard deviations: what they add to a square is then 1 %

bool spans(const Loop& loop, const Noise& noise) {
  return std::hypot(loop.dx, loop.dy) > kFar * estimation::stated_or(loop.sd, noise.loop);
}

/// Whether two of the fixes are much further from each other than they may be off.
bool spans(const std::vector<Fix>& fixes, const Noise& noise) {
  return std::any_of(fixes.begin(), fixes.end(), [&](const Fix& one) {
    return std::hypot(one.x - fixes.front().x, one.y - fixes.front().y) >
           kFar * estimation::stated_or(one.sd, noise.fix);
  });
}

bool sees_ranges(const DrivenRecording& one) {
  return std::ranges::any_of(one.sightings,
                             [](const Sighting& sighting) { return !sighting.standing(); });
}

bool measures_without(const DrivenRecording& one, const estimation::ProblemOptions& options,
                      const Noise& noise) {
  return (options.survey && !one.survey.empty()) || (options.truth && !one.truth.empty()) ||
         (options.fixes && spans(one.fixes, noise)) ||
         (options.loops && std::any_of(one.loops.begin(), one.loops.end(),
                                       [&](const Loop& loop) { return spans(loop, noise); }));
}

}  // namespace

bool measures_distance(const std::vector<DrivenRecording>& recordings,
                       const estimation::ProblemOptions& options, const Noise& noise) {
  return std::ranges::any_of(recordings, sees_ranges) ||
         measures_distance_without_ranges(recordings, options, noise);
}

bool measures_distance_without_ranges(const std::vector<DrivenRecording>& recordings,
                                      const estimation::ProblemOptions& options,
                                      const Noise& noise) {
  return std::ranges::any_of(recordings, [&](const DrivenRecording& one) {
    return measures_without(one, options, noise);
  });
}

}  // namespace trussmap::calibration
