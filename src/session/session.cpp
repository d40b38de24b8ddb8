// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/session.hpp"

#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
namespace {

const Stage kReading{"reading", 0.5};
const Stage kLooking{"looking for what is missing", 50};

void begin(const NextStage& next) {
  if (next) next();
}

/// Times to leave out have to be times of the drive: a wrong unit must not be ignored in silence.
void check_excluded(const std::vector<DrivenRecording>& recordings, const FitOptions& fit) {
  for (std::size_t k = 0; k < fit.excluded.size() && k < recordings.size(); ++k) {
    const MotionRows& drive = recordings[k].drive;
    if (drive.rows() == 0) continue;
    for (const TimeSpan& one : fit.excluded[k]) {
      if (one.from < drive.t.back() && one.to > drive.start()) continue;
      throw std::invalid_argument(fmt::format(
          "exclude: {} lasts from {:g} s to {:g} s, and {:g} to {:g} s is no part of it",
          recordings[k].name, drive.start(), drive.t.back(), one.from, one.to));
    }
  }
}

}  // namespace

std::vector<Stage> compare_stages() {
  return {{"reading", 1}, {"fitting the map", 4}, {"comparing", 40}};
}

std::vector<Stage> fit_stages(bool noise) {
  std::vector<Stage> stages{kReading,
                            {"fitting without effects", 2.5},
                            {"fitting the effects", 5},
                            {"predicting held-out legs", 8}};
  if (noise) stages.insert(stages.begin() + 1, {"estimating the noise", 8});
  return stages;
}

std::vector<Stage> diagnose_stages() {
  return {kReading, {"fitting the map", 2.5}, kLooking};
}

std::vector<Stage> discover_stages() {
  return {
      kReading, {"fitting the model given", 2.5}, kLooking, {"fitting an effect", 20}, kLooking};
}

CompareOptions compare_options(const SessionOptions& options) {
  return {options.fit, options.legs, options.level};
}

DiagnoseOptions diagnose_options(const SessionOptions& options) {
  DiagnoseOptions how;
  how.fit = options.fit;
  how.legs = options.legs;
  how.level = options.level;
  how.estimate_noise = options.estimate_noise;
  return how;
}

Session open_session(std::vector<DrivenRecording> recordings, Model model,
                     const SessionOptions& options) {
  check_excluded(recordings, options.fit);
  PreparedRecordings rows =
      prepare_recordings(std::move(recordings), model, options.fit, options.every);
  return {std::move(rows), std::move(model), options};
}

ComparisonReport compare(const Session& session, const NextStage& next) {
  ComparisonReport report;
  CompareOptions how = compare_options(session.options);
  how.fit.fit_effects = false;
  begin(next);
  report.fit = fit_model(session.rows.recordings, session.model, how.fit);
  begin(next);
  report.found = compare(session.rows, report.fit, how);
  report.noise_budget = noise_budget(session.rows.recordings, session.model);
  return report;
}

FitReport fit(const Session& session, bool noise, const NextStage& next) {
  const std::vector<DrivenRecording>& recordings = session.rows.recordings;
  FitReport report;
  FitOptions how = session.options.fit;
  Model model = session.model;
  if (noise) {
    begin(next);
    report.noise = fit_model_and_noise(recordings, model, how).noise;
    model.noise = report.noise->noise;
  }
  Model without = model;
  without.effects.clear();
  begin(next);
  how.fit_effects = false;
  const ModelFit before = fit_model(recordings, without, how);
  how.fit_effects = true;
  begin(next);
  const ModelFit after = fit_model(recordings, model, how);
  begin(next);
  report.gain = gain_of_effects(recordings, before, after, session.options.legs);
  report.constants = with_velocity_variances(robot_constants(session.model, report.gain.with),
                                             recordings, report.gain.with.model);
  return report;
}

DiagnosisReport diagnose(Session& session, const NextStage& next) {
  const DiagnoseOptions how = diagnose_options(session.options);
  DiagnosisReport report;
  begin(next);
  report.fit = fit_model(session.rows.recordings, session.model, how.fit);
  begin(next);
  report.found = diagnose(session.rows, report.fit, how);
  const std::vector<DrivenRecording>& recordings = session.rows.recordings;
  report.noise_budget = noise_budget(
      recordings, report.found.under ? report.found.under->fit.model : report.fit.model);
  report.constants = with_velocity_variances(robot_constants(report.found, report.fit.model),
                                             recordings, report.fit.model);
  return report;
}

DiscoveryReport discover(Session& session,
                         const std::function<void(const DiscoveryStage&)>& progress) {
  DiscoverOptions how;
  how.diagnosis = diagnose_options(session.options);
  how.most_effects = session.options.most_effects;
  how.progress = progress;
  DiscoveryReport report;
  report.found = discover(session.rows, session.model, how);
  report.noise_budget = noise_budget(session.rows.recordings, report.found.found.model);
  report.constants = with_velocity_variances(robot_constants(report.found, session.model),
                                             session.rows.recordings, report.found.found.model);
  return report;
}

}  // namespace trussmap
