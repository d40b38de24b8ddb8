// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Diagnose, add, fit, and again, while that is justified.
//
//   diagnose --> winner and its look-alikes, each fitted --> the best of them is added
//      ^                                                          |
//      '---- earlier effects: places and thresholds sought anew, <'
//            backward elimination of those that are no longer significant
//
// Among look-alikes chi^2 decides where it can, else the error of held-out legs, else the order of
// the diagnosis. Every step's held-out figures are over the same legs.
#pragma once

#include "trussmap/diagnose.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// One model on the way.
struct DiscoveryStep {
  std::optional<Effect> added;  ///< none: the model given
  /// Added together with it: alone they cannot be fitted, or hide each other.
  std::vector<Effect> together = {};
  std::vector<std::string> dropped;
  double chi2 = 0.0;
  int dof = 0;
  std::size_t left_out = 0;  ///< sightings, fixes and loops that contradict all others
  HeldOut held_out;
  /// Dead reckoning, over 10 s and 30 s from one smoothed pose to the next; rms, m. Absent where
  /// the recordings have no 20 such stretches.
  std::optional<double> reckoned_10 = std::nullopt;
  std::optional<double> reckoned_30 = std::nullopt;
  double predicted_decrease = 0.0;  ///< of chi^2, by the diagnosis before the fit
  HeldOutMetrics predicted;         ///< held-out figures that it predicted
  std::vector<LookAlike> look_alikes;
};

enum class StopReason {
  nothing_significant,
  limit_reached,     ///< of the number of effects
  cannot_be_fitted,  ///< `effect` beside what the model has
  predicts_worse,    ///< `effect` fits these legs, but predicts others worse
  told_to            ///< DiscoverOptions::go_on
};

struct Stopped {
  StopReason reason = StopReason::nothing_significant;
  std::string effect;
  std::size_t limit = 0;  ///< effects, where that was reached
};

struct Discovery {
  std::vector<DiscoveryStep> steps;  ///< the first is the model given
  ModelFit given;
  ModelFit found;
  Stopped stopped;
  bool consistent = true;   ///< the model found, by the rule of compare.hpp
  UsedSightings sightings;  ///< of prepared recordings
  Diagnosis first;          ///< of the model given
  Diagnosis last;           ///< of the model found
};

/// A part of the work that begins.
struct DiscoveryStage {
  enum class Kind { fitting_given, searching, fitting_effect };
  Kind kind = Kind::fitting_given;
  std::string effect;  ///< that is being fitted
};

struct DiscoverOptions {
  DiagnoseOptions diagnosis;
  std::size_t most_effects = 6;
  std::function<void(const DiscoveryStage&)> progress = {};
  /// Asked of each model on the way, before it is diagnosed, whether to go on from it.
  std::function<bool(const ModelFit&)> go_on = {};
};

/// What was found as constants to paste. `before`: the model given.
[[nodiscard]] RobotConstants robot_constants(const Discovery& discovery, const Model& before);

/// Throws like fit_model.
[[nodiscard]] Discovery discover(const std::vector<DrivenRecording>& recordings, const Model& model,
                                 const DiscoverOptions& options = {});
[[nodiscard]] inline Discovery discover(const std::vector<Recording>& recordings,
                                        const Model& model, const DiscoverOptions& options = {}) {
  return discover(with_wheels(recordings, model.robot), model, options);
}

/// The same of recordings as the model given has them. Which of their sightings are independent is
/// asked again of each model on the way, and of the one found: where others are, the search begins
/// anew with these, so that a ladder's lines are all of the same rows. `recordings` are those on
/// return, as the model found has them.
[[nodiscard]] Discovery discover(PreparedRecordings& recordings, const Model& model,
                                 const DiscoverOptions& options = {});

}  // namespace trussmap
