// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calibration/reference_alignment.hpp"
#include "calibration/truth_holdout.hpp"
#include "calibration/wheel_calibration.hpp"
#include "drive/well_formed.hpp"
#include "geometry/index.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace trussmap {
using namespace calibration;

namespace {

constexpr int kFewestLegs = 5;  // to judge a calibration by

/// A calibration of the wheels by a part of the recordings; none where they are too little.
std::optional<WheelCalibration> calibration_by(const std::vector<DrivenRecording>& recordings,
                                               const Model& model,
                                               const WheelCalibrationOptions& options) {
  if (recordings.empty()) return std::nullopt;
  try {
    return calibrate_wheels(recordings, model, options);
  } catch (const SolveError&) {
    return std::nullopt;
  } catch (const InputError&) {
    return std::nullopt;
  }
}

/// The held-out legs as the given model and the calibrated one predict them.
void predict(CalibrationValidation& result, const std::vector<DrivenRecording>& recordings,
             const std::vector<TruthLeg>& legs, const Model& nominal, const Model& calibrated) {
  const auto add = [&](ArrivalErrors& to, const Model& model) {
    const ArrivalErrors errors = arrival_errors(recordings, legs, model);
    to.distances.insert(to.distances.end(), errors.distances.begin(), errors.distances.end());
  };
  add(result.nominal, nominal);
  add(result.calibrated, calibrated);
}

CalibrationValidation by_blocks(const std::vector<DrivenRecording>& recordings,
                                const std::vector<TruthLeg>& legs, const Model& model,
                                WheelCalibrationOptions how) {
  CalibrationValidation result;
  if (std::none_of(legs.begin(), legs.end(), [](const TruthLeg& leg) { return leg.held_out; })) {
    return result;
  }
  const TrainingSegments training_segments = without_held_out(recordings, legs);
  how.sessions = training_segments.sessions;
  const auto other = calibration_by(training_segments.recordings, model, how);
  if (!other) return result;
  predict(result, aligned(recordings, other->truth), legs, model, other->model);
  result.scheme = HoldoutScheme::blocks;
  return result;
}

/// The alignment found on other recordings, for one whose own clock is unknown.
TruthAlignment mean_alignment(const TruthAlignment& others, double start) {
  TruthAlignment result = others;
  result.clocks.clear();
  TruthClock clock;
  clock.start = start;
  for (const auto& [session, theirs] : others.clocks) {
    clock.late += theirs.late / static_cast<double>(others.clocks.size());
  }
  result.clocks[0] = clock;
  return result;
}

CalibrationValidation by_recordings(const std::vector<DrivenRecording>& recordings,
                                    const std::vector<TruthLeg>& legs, const Model& model,
                                    const WheelCalibrationOptions& how) {
  CalibrationValidation result;
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    std::vector<TruthLeg> own;
    for (const TruthLeg& leg : legs) {
      if (idx(leg.session) == k) own.push_back({0, leg.from, leg.to, true});
    }
    if (own.empty()) continue;
    std::vector<DrivenRecording> others = recordings;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const auto other = calibration_by(others, model, how);
    if (!other) continue;
    const TruthAlignment alignment = mean_alignment(other->truth, recordings[k].drive.start());
    predict(result, aligned({recordings[k]}, alignment), own, model, other->model);
    result.scheme = HoldoutScheme::recordings;
  }
  return result;
}

}  // namespace

double ArrivalErrors::rms() const {
  double sum = 0.0;
  for (const double one : distances) sum += one * one;
  return distances.empty() ? 0.0 : std::sqrt(sum / legs());
}

CalibrationGain CalibrationValidation::gain() const {
  if (legs() == 0) return CalibrationGain::unknown;
  const double n = legs();
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t k = 0; k < nominal.distances.size(); ++k) {
    const double gain = std::pow(nominal.distances[k], 2) - std::pow(calibrated.distances[k], 2);
    sum += gain;
    squares += gain * gain;
  }
  const double mean = sum / n;
  const double sd = n > 1.0 ? std::sqrt(std::max(0.0, squares / n - mean * mean) / (n - 1.0)) : 0.0;
  if (legs() < kFewestLegs || std::abs(mean) < 2.0 * sd) return CalibrationGain::uncertain;
  return mean > 0.0 ? CalibrationGain::better : CalibrationGain::worse;
}

CalibrationValidation validate_calibration(const std::vector<DrivenRecording>& recordings,
                                           const Model& model, const CalibrationOptions& options) {
  drive::require_well_formed(recordings, model.robot);
  if (!options.truth || !(options.holdout > 0.0)) return {};
  WheelCalibrationOptions how = calibration_options(options);
  how.noise = false;
  const std::vector<TruthLeg> legs = truth_legs(recordings, options.holdout, options.leg);
  const auto held_out =
      std::count_if(legs.begin(), legs.end(), [](const TruthLeg& leg) { return leg.held_out; });
  std::set<int> sessions;
  for (const TruthLeg& leg : legs) sessions.insert(leg.session);
  if (held_out < kFewestLegs && sessions.size() > 1) {
    CalibrationValidation result = by_recordings(recordings, legs, model, how);
    if (result.legs() > 0) return result;
  }
  return by_blocks(recordings, legs, model, how);
}

}  // namespace trussmap
