// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What noise is made of: the white sources of a model, and processes that last.
#pragma once

#include "fit/fit_state.hpp"

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::fitting {

struct NoiseComponent {
  std::string name;
  std::string unit;
  /// White: which of Noise it scales together; empty: a process.
  std::vector<double Noise::*> white;
  NoiseProcess process;
  double stated = 0.0;  ///< sd that was stated, 0: none

  [[nodiscard]] bool lasts() const { return white.empty(); }
};

/// Noise of single readings, by the model's keys.
struct ReadingKey {
  const char* name;
  const char* unit;
  double Noise::*member;
};
[[nodiscard]] const std::vector<ReadingKey>& reading_keys();
/// 0 of a key that is none of them.
[[nodiscard]] double reading_sd(const Noise& noise, std::string_view key);

/// Keys of the noise that measurements have; of those whose rows state none themselves.
[[nodiscard]] std::set<std::string_view> noises_in(const estimation::RecordingProblem& problem);

/// All zero.
[[nodiscard]] Noise silent_noise();
/// k of both wheels, root mean square, m^(1/2).
[[nodiscard]] double mean_wheel_noise(const Noise& noise);
/// "compass, correlated in t".
[[nodiscard]] std::string name_of_source(const NoiseProcess& process);
/// The same channel and process, whatever their sizes and lengths.
[[nodiscard]] bool is_same_source(const NoiseProcess& a, const NoiseProcess& b);

/// Of the fit's equipment: the white sources of this noise, and its processes.
[[nodiscard]] std::vector<NoiseComponent> white_components(const FitState& fit, const Noise& noise);
[[nodiscard]] std::vector<NoiseComponent> processes_of(const Noise& noise);
/// What may be missing: optional white laws and processes of this equipment, lengths to start from.
[[nodiscard]] std::vector<NoiseComponent> candidate_components(const FitState& fit,
                                                               const Noise& noise);

/// What a noise has of a component: 0 nothing.
[[nodiscard]] double size_in(const Noise& noise, const NoiseComponent& component);

/// Noise with a component's sd (and length).
void take_into(Noise& noise, const NoiseComponent& component, double sd, double length);

}  // namespace trussmap::fitting
