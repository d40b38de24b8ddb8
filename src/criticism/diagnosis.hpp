// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Which physical effect is missing?
//
//   fit of the present model --> score tests of all candidates --> winner, if any is significant
//        |                              ^                                |
//        '--> single events, noise      '------ winner taken out <-------'   a second, a third ...
//
//   p adjusted   Holm's, over all that was tried, members of families counted one by one; judged
//                against the dispersion that the candidate itself would leave, or against that of
//                the very rows that speak for it where it is clearly larger: a wrong noise law or
//                a single bad leg makes no effect (local_dispersion.hpp)
//   order        evidence: log Bayes factor, sizes equally likely on a logarithmic scale, and a
//                little more belief in the catalogue than in a free form
//   look-alike   |P_r v| / |v| >= 0.95: of the winner's own trace v, what a rival's columns can
//                show as well
//   absent       where even the smallest detectable size would raise the arrival error by less than
//                5 %
//
// Laws of noise and single events are asked of what the findings leave.
#pragma once

#include "criticism/candidates.hpp"
#include "criticism/comparison.hpp"
#include "criticism/event_tests.hpp"
#include "criticism/noise_tests.hpp"

#include <string>
#include <vector>

namespace trussmap {

enum class Status { missing, absent, negligible, cannot_tell };
[[nodiscard]] std::string_view name_of(Status status);

struct LookAlike {
  Effect effect;
  double cosine = 0.0;
};

/// Means over held-out legs, as HeldOut has them.
struct HeldOutMetrics {
  double arrival_rms = 0.0;  ///< m
  double stretch_error = 0.0;
  double orientation_error = 0.0;  ///< rad
};
[[nodiscard]] HeldOutMetrics metrics_of(const HeldOut& held_out);

struct Finding {
  Candidate candidate;  ///< its effect with the estimated coefficients
  double score = 0.0;   ///< chi^2 that adding it would take away
  int dof = 0;          ///< 0: cannot be seen at all
  double p_value = 1.0;
  double p_adjusted = 1.0;
  double evidence = 0.0;
  std::vector<double> sd;
  std::vector<double> minimal_detectable;
  Status status = Status::cannot_tell;
  HeldOutMetrics held_out;             ///< predicted, with it added
  std::vector<LookAlike> look_alikes;  ///< of those that are missing
  /// Of those that are missing: the coefficients with all that is missing added at once.
  std::vector<double> joint;
  std::vector<double> joint_sd;
  int tried = 1;  ///< members of its family
};

struct Unobservable {
  Effect effect;
  std::string why;
  std::string remedy;
};

struct Diagnosis {
  enum class Verdict { missing, nothing_missing, unexplained_misfit };
  Verdict verdict = Verdict::nothing_missing;
  std::string missing;   ///< name of the first finding, if it is missing
  double p_value = 1.0;  ///< its, adjusted; else of chi^2
  double chi2 = 0.0;
  int dof = 0;
  HeldOut held_out;               ///< of the present model
  HeldOutMetrics with_missing;    ///< predicted, with all that is missing added
  std::vector<Finding> findings;  ///< best first
  std::vector<Unobservable> unobservable;
  std::vector<NoiseTest> noise;   ///< best explanation first
  std::vector<EventTest> events;  ///< likeliest first
  std::vector<std::string> advice;
  std::string next_drive;
  std::size_t tried = 0;  ///< tests
  std::vector<std::string> warnings;
};

struct DiagnosisOptions {
  ProblemOptions problem;
  LegOptions legs;
  std::optional<double> gate;
  double level = 0.05;  ///< chance of naming an effect where none is
  std::size_t most_missing = 4;
};

/// How a diagnosis fits a model.
[[nodiscard]] ModelFitOptions fit_options(const DiagnosisOptions& options);

/// Throws like fit_model.
[[nodiscard]] Diagnosis diagnose(const std::vector<Recording>& recordings, const Model& model,
                                 const DiagnosisOptions& options = {});

/// The same at a fit that there is already.
[[nodiscard]] Diagnosis diagnose(const std::vector<Recording>& recordings, const ModelFit& fit,
                                 const DiagnosisOptions& options);

/// What to drive to tell two effects apart, where `slow` are the covariates that vary slowly over
/// the recordings (slow_covariates.hpp).
[[nodiscard]] std::string separating_drive(const Effect& one, const Effect& other,
                                           const std::vector<std::string>& slow);

/// What the data lack to show an effect.
[[nodiscard]] Unobservable why_unobservable(const Effect& effect, const ModelFit& fit,
                                            const Score& score);

}  // namespace trussmap
