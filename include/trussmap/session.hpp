// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// The way from recordings and a model to what compare, fit, diagnose and discover say, as the
// command and Python go it:
//
//   recordings, model --open_session--> with their wheels, prepared
//                     --compare, fit, diagnose, discover--> a report: the result, what dead
//                       reckoning owes to which noise, the robot's constants, notes
//
// Each call tells the stages that its work goes through; whoever shows them adds those of his own,
// such as a page. stop_if_asked (running.hpp) ends a call between them.
#pragma once

#include "trussmap/calibrate.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/noise_fit.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace trussmap {

/// A part of a call, and which share of its time it takes, in any unit.
struct Stage {
  std::string what;  ///< "fitting the map"
  double share = 1.0;
};

/// Reading comes first; open_session and what is before it belong to it.
[[nodiscard]] std::vector<Stage> compare_stages();
[[nodiscard]] std::vector<Stage> fit_stages(bool noise);
[[nodiscard]] std::vector<Stage> diagnose_stages();
/// As if one effect were found.
[[nodiscard]] std::vector<Stage> discover_stages();

/// What of the recordings is used, and by what they judge.
struct SessionOptions {
  FitOptions fit = gated_fit();
  LegOptions legs = {};
  /// s between frames of sightings; 0: all; none: as long as their errors last
  std::optional<double> every = {};
  double level = kSignificance;
  bool estimate_noise = true;    ///< of diagnose and discover; else what the model states
  std::size_t most_effects = 6;  ///< that discover adds
};

/// Options of the calls that a session makes.
[[nodiscard]] CompareOptions compare_options(const SessionOptions& options);
[[nodiscard]] DiagnoseOptions diagnose_options(const SessionOptions& options);

/// Recordings of one robot and what is believed of it.
struct Session {
  PreparedRecordings rows;  ///< as the model has them; of diagnose and discover, as they end
  Model model;
  SessionOptions options;
};

/// Throws as fit_model does, and std::invalid_argument where times to leave out are none of their
/// recording's.
[[nodiscard]] Session open_session(std::vector<DrivenRecording> recordings, Model model,
                                   const SessionOptions& options = {});

/// Told when the next stage after reading begins.
using NextStage = std::function<void()>;

struct ComparisonReport {
  ModelFit fit;  ///< with the coefficients that the model has
  Comparison found;
  std::vector<NoiseBudget> noise_budget;
};

/// Throws like fit_model, as those below do.
[[nodiscard]] ComparisonReport compare(const Session& session, const NextStage& next = {});

struct FitReport {
  EffectGain gain;
  std::optional<FittedNoise> noise;
  RobotConstants constants;
};

/// `noise`: estimate it, too, before the effects are fitted.
[[nodiscard]] FitReport fit(const Session& session, bool noise, const NextStage& next = {});

struct DiagnosisReport {
  ModelFit fit;
  Diagnosis found;
  std::vector<NoiseBudget> noise_budget;
  RobotConstants constants;
};

[[nodiscard]] DiagnosisReport diagnose(Session& session, const NextStage& next = {});

struct DiscoveryReport {
  Discovery found;
  std::vector<NoiseBudget> noise_budget;
  RobotConstants constants;
};

/// `progress` as DiscoverOptions has it.
[[nodiscard]] DiscoveryReport discover(
    Session& session, const std::function<void(const DiscoveryStage&)>& progress = {});

}  // namespace trussmap
