// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// What pages draw of results: gathered by further score tests and fits, which cost about as much as
// a comparison of each model.
//
// A response is a channel's error along a variable, bin by bin, as the residuals of a fit have it:
// the picture that shows an effect, with the curve that a formula draws through it.
//
//   g  |      +     +          +   estimate of a bin with its standard error
//      |   +  ~~~~~~~~  +      ~   the effect's own curve
//      |~~~              ~~~
//      +-------------------->  variable
#pragma once

#include "trussmap/discover.hpp"

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace trussmap {

struct ResponseBin {
  double at = 0.0;   ///< mean of the variable over the rows in the bin
  double low = 0.0;  ///< the bin
  double high = 0.0;
  double estimate = 0.0;  ///< of g, in the channel's unit
  double sd = 0.0;
};

/// The variable that stands for the distance from an effect's place, m.
inline constexpr const char* kPlace = "place";

/// A channel's error along a variable, bin by bin, and the curve of an effect through it.
struct Response {
  Channel channel = Channel::travel;
  std::string unit;      ///< of g; "" = none
  std::string variable;  ///< heading (0 to 2 pi), speed, payload_kg, kPlace ...
  std::vector<ResponseBin> bins;
  std::vector<Vector2> curve;  ///< (variable, g) of the effect; empty where it is no curve
  /// Of each rival asked of, with its coefficients: (variable, g).
  std::vector<std::vector<Vector2>> rivals;
};

/// Least and largest g of an effect over all rows in which the robot moves.
struct EffectRange {
  double least = 0.0;
  double most = 0.0;
};

/// Dead reckoning over so long, from one smoothed pose to the next.
struct ReckonedError {
  double horizon = 0.0;  ///< s
  double rms = 0.0;      ///< m, of the position
};

struct ModelEvidence {
  Comparison comparison;
  FittedMap map;
  std::vector<ReckonedError> reckoned = {};  ///< horizons with windows enough, ascending
};

/// A variable with the channel whose error goes with it most.
struct TrendEvidence {
  Trend trend;
  Response response;
};

/// An effect as fitted, and what the recordings show of it beside the model's others. Where a fit
/// has it, by partial residuals about that fit (Larsen & McCleary 1972), else by a fit without it.
struct EffectEvidence {
  EffectEstimate estimate;
  Response response;  ///< no bins where there is nothing to draw
  EffectRange range = {};
  std::vector<Effect> rivals = {};  ///< of which the response has curves
};

/// What a finding does in the recordings.
struct FindingSize {
  EffectRange range;       ///< of g, at the estimated coefficients
  double seen_from = 0.0;  ///< largest |g| of the minimal detectable size; 0: no size would be seen
};

struct ComparisonEvidence {
  ModelEvidence model;
  std::vector<TrendEvidence> trends;  ///< one per variable, the most telling first
};

struct FitEvidence {
  ModelEvidence without;
  ModelEvidence with;
  std::vector<EffectEvidence> effects;
  std::string noise = {};  ///< in words, where it was estimated and is other than stated
  /// Of the effects' coefficients, in their order; 0 beside one that was not estimated; empty where
  /// there are fewer than two.
  Eigen::MatrixXd correlation = {};
};

struct DiagnosisEvidence {
  ModelEvidence given;
  std::optional<ModelEvidence> with;    ///< with what is missing added and fitted, where it can be
  std::vector<EffectEvidence> effects;  ///< what is missing, as found_by()
  std::vector<TrendEvidence> trends;    ///< of the model as given
  std::vector<FindingSize> sizes;       ///< one per finding
  std::optional<HeldOut> as_stated = {};  ///< the model's legs by the noise that it states, where
                                          ///< `given` goes by another
};

struct DiscoveryEvidence {
  ModelEvidence given;
  std::vector<ModelEvidence> between;  ///< of the steps between the first and the last
  ModelEvidence found;
  std::vector<EffectEvidence> effects;                ///< that were added and stayed
  std::vector<std::vector<LookAlike>> look_alikes;    ///< of each of them
  std::vector<std::optional<NextDrive>> next_drives;  ///< to tell each of them from its rivals
  std::vector<TrendEvidence> trends;                  ///< of the model found
  std::vector<FindingSize> sizes;                     ///< one per finding of its last diagnosis
};

/// `fit` is the one compared.
[[nodiscard]] ComparisonEvidence evidence_of(const ModelFit& fit, const Comparison& comparison);

[[nodiscard]] FitEvidence evidence_of(const std::vector<DrivenRecording>& recordings,
                                      const EffectGain& gain, const CompareOptions& options);

/// `fit` is the one diagnosed, with these options. Throws like fit_model.
[[nodiscard]] DiagnosisEvidence evidence_of(const std::vector<DrivenRecording>& recordings,
                                            const ModelFit& fit, const Diagnosis& diagnosis,
                                            const DiagnoseOptions& options);

/// Throws like fit_model.
[[nodiscard]] DiscoveryEvidence evidence_of(const std::vector<DrivenRecording>& recordings,
                                            const Discovery& discovery,
                                            const DiagnoseOptions& options);

}  // namespace trussmap
