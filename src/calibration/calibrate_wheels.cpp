// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The whole of a calibration: from which constants least squares start, and what is left out.
#include "calibration/contradicting_rows.hpp"
#include "calibration/sensor_places.hpp"
#include "calibration/sought_constants.hpp"
#include "calibration/wheel_calibration.hpp"
#include "drive/well_formed.hpp"
#include "effects/steering.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>
#include <vector>

namespace trussmap {
using namespace calibration;

namespace {

/// A start, and what it leads to under the stated noise.
struct Led {
  std::vector<double> start;
  WheelCalibration found;
};

/// Of the starts the one that leads to the least chi^2; the first that leads to a possible one is
/// good enough.
std::optional<Led> leading(const std::vector<std::vector<double>>& starts,
                           const std::vector<DrivenRecording>& recordings, const Model& model,
                           WheelCalibrationOptions options) {
  constexpr double kPossible = 10.0;  // chi^2/dof
  options.noise = false;
  std::optional<Led> best;
  for (const std::vector<double>& start : starts) {
    try {
      WheelCalibration found = calibrated_from(start, recordings, model, options);
      if (!found.settled || (best && found.chi2 >= best->found.chi2)) continue;
      best = Led{start, std::move(found)};
      if (best->found.chi2 < kPossible * std::max(1, best->found.dof)) break;
    } catch (const SolveError&) {
      continue;
    }
  }
  return best;
}

/// From the stated constants, but where they are wrong by a factor.
WheelCalibration calibrated(const std::vector<DrivenRecording>& recordings, const Model& model,
                            const WheelCalibrationOptions& options) {
  const std::vector<std::vector<double>> starts = likely_starts(recordings, model, options);
  std::optional<Led> led;
  if (starts.size() > 1) led = leading(starts, recordings, model, options);
  if (led && !options.noise) return std::move(led->found);
  return calibrated_from(led ? led->start : in_force(model), recordings, model, options);
}

/// By all measurements that there are.
WheelCalibration calibrated_by_all(const std::vector<DrivenRecording>& recordings,
                                   const Model& model, const WheelCalibrationOptions& options) {
  if (place_of_gain(model.robot)) return calibrate_steered(recordings, model, options);
  return calibrated(recordings, model, options);
}

/// Truth is never left out: were it wrong, nothing would be right.
bool has_doubtful_rows(const DrivenRecording& one) {
  return !one.sightings.empty() || !one.fixes.empty() || !one.loops.empty();
}

/// By all but the few rows that the others contradict; none where there are no such rows, or the
/// rest does not fit far better. `options` have a gate.
std::optional<WheelCalibration> calibrated_by_the_rest(
    const std::vector<DrivenRecording>& recordings, const Model& model,
    const WheelCalibrationOptions& options, const std::optional<WheelCalibration>& by_all) {
  const std::vector<LeftOutRow> rows = contradicting_rows(recordings, model, options, by_all);
  if (rows.empty()) return std::nullopt;
  WheelCalibrationOptions without = options;
  without.gate = std::nullopt;
  try {
    WheelCalibration rest = calibrated_by_all(without_rows(recordings, rows), model, without);
    if (!explains_more(rest, by_all)) return std::nullopt;
    for (const LeftOutRow& one : rows) rest.left_out.push_back(one.text);
    return rest;
  } catch (const SolveError&) {
    return std::nullopt;
  }
}

}  // namespace

}  // namespace trussmap

namespace trussmap::calibration {

WheelCalibrationOptions calibration_options(const CalibrationOptions& options) {
  WheelCalibrationOptions result;
  result.problem.survey = options.survey;
  result.problem.truth = options.truth;
  result.problem.fixes = options.fixes;
  result.noise = options.noise;
  if (options.gate > 0.0) result.gate = options.gate * options.gate;
  return result;
}

}  // namespace trussmap::calibration

namespace trussmap {

WheelCalibration calibrate_wheels(const std::vector<DrivenRecording>& recordings,
                                  const Model& model, const CalibrationOptions& options) {
  drive::require_well_formed(recordings, model.robot);
  return calibrate_wheels(recordings, model, calibration_options(options));
}

}  // namespace trussmap

namespace trussmap::calibration {

WheelCalibration calibrate_wheels(const std::vector<DrivenRecording>& recordings,
                                  const Model& given, const WheelCalibrationOptions& options) {
  const Model model = with_places_in_robot(given);
  WheelCalibrationOptions without = options;
  without.gate = std::nullopt;
  if (!options.gate || std::ranges::none_of(recordings, has_doubtful_rows)) {
    return calibrated_by_all(recordings, model, without);
  }
  std::optional<WheelCalibration> by_all;
  std::exception_ptr why;
  try {
    by_all = calibrated_by_all(recordings, model, without);
    if (!is_contradicted(*by_all)) return *std::move(by_all);
  } catch (const SolveError&) {
    why = std::current_exception();
  }
  if (auto rest = calibrated_by_the_rest(recordings, model, options, by_all)) {
    return *std::move(rest);
  }
  if (!by_all) std::rethrow_exception(why);
  return *std::move(by_all);
}

}  // namespace trussmap::calibration
