// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// How large the noise is, which part of it lasts, and what it costs: estimated from the recordings
// that a model was fitted to.
//
//   ModelFit --fit_noise--> FittedNoise: the same model's noise, with sizes and lengths as found
//
//   noise = the white sources of the model, each with a size of its own
//         + processes (channel x process), of which the data show one after the other
//
// Restricted likelihood (Patterson & Thompson 1971): -2 log R = log|S| + log|X' S^-1 X| + least
// chi^2, S the covariance of all measurements, X all unknowns. A white size stays as stated unless
// the likelihood is against it; a process is taken in where it raises the likelihood by more than
// chance does for any of those tried (p < level, Bonferroni).
//
// A missing effect looks like noise that lasts. Where one is suspected, ask with it in the model.
#pragma once

#include "trussmap/fit_model.hpp"

#include <string>
#include <vector>

namespace trussmap {

struct NoiseFitOptions {
  double level = 0.02;  ///< chance of naming any process where there is none
  std::size_t most_processes = 4;
  bool errors = true;  ///< standard errors of sizes and lengths, else 0
};

/// One source of noise.
struct NoiseSource {
  std::string name;  ///< "wheels", "compass", "range", ...; of a process "compass, correlated in t"
  bool lasts = false;    ///< a process, else one of the white sources
  NoiseProcess process;  ///< where it is one
  std::string unit;      ///< of sd
  double stated = 0.0;   ///< what the model had; 0: nothing
  double sd = 0.0;       ///< wheels: k of both, root mean square, m^(1/2)
  double sd_error = 0.0;
  double length_error = 0.0;
  bool at_limit = false;  ///< size or length went as far as is sought: it may lie beyond
  bool no_noise = false;  ///< the size did, upwards: what is so large is an error, and not noise
  double gain = 0.0;      ///< fall of -2 log R by it; of a white source by its new size
  double p_value = 1.0;   ///< of a process: chance of as much, times the processes tried
};

struct FittedNoise {
  Noise noise;
  std::vector<NoiseSource> sources;  ///< white ones that the data determine, then processes
  double gain = 0.0;                 ///< fall of -2 log R from the model's noise
  int tried = 0;                     ///< processes
  /// Whether anything is other than stated.
  [[nodiscard]] bool changed() const { return gain > 0.0; }
};

/// Processes that the model has already are estimated anew.
[[nodiscard]] FittedNoise fit_noise(const ModelFit& fit, const NoiseFitOptions& options = {});

/// Model and noise in turn, until the likelihood rises no more. Throws as fit_model does.
struct FitWithNoise {
  ModelFit fit;       ///< under the noise found
  FittedNoise noise;  ///< its `gain` is that from the model's noise
};
[[nodiscard]] FitWithNoise fit_model_and_noise(const std::vector<DrivenRecording>& recordings,
                                               const Model& model, const FitOptions& fit = {},
                                               const NoiseFitOptions& options = {});
[[nodiscard]] inline FitWithNoise fit_model_and_noise(const std::vector<Recording>& recordings,
                                                      const Model& model,
                                                      const FitOptions& fit = {},
                                                      const NoiseFitOptions& options = {}) {
  return fit_model_and_noise(with_wheels(recordings, model.robot), model, fit, options);
}

// ----------------------------------------
// What of dead reckoning's error comes from which noise.

struct NoiseShare {
  std::string source;  ///< as NoiseSource::name
  double share = 0.0;  ///< of the error's mean square
};

struct NoiseBudget {
  double horizon = 0.0;  ///< s; 0: a leg, whatever it takes
  double rms = 0.0;      ///< m, predicted error of the position after the horizon
  int windows = 0;
  bool gyro = false;               ///< a robot that has one
  std::vector<NoiseShare> shares;  ///< the largest first
};

/// By the wheels alone, from a known pose, over each horizon (s), every half of it anew, or (0)
/// over each leg, from one landmark that the robot stands on to the next or from rest to rest: the
/// errors that the model's noise lets one expect, linearised along the record. Horizons that no
/// recording is as long as are left out, and legs where there are none. Throws
/// std::invalid_argument on a horizon below 0.
[[nodiscard]] std::vector<NoiseBudget> noise_budget(const std::vector<DrivenRecording>& recordings,
                                                    const Model& model,
                                                    const std::vector<double>& horizons = {
                                                        0.0, 10.0, 30.0});
[[nodiscard]] inline std::vector<NoiseBudget> noise_budget(const std::vector<Recording>& recordings,
                                                           const Model& model,
                                                           const std::vector<double>& horizons = {
                                                               0.0, 10.0, 30.0}) {
  return noise_budget(with_wheels(recordings, model.robot), model, horizons);
}

}  // namespace trussmap
