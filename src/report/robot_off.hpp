// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far off the robot is, before and after: a leg, and the longest stretch of dead reckoning that
// can be judged.
#pragma once

#include "trussmap/evidence.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::report {

/// Whether held-out legs end as far off as noise lets one expect (`floor`, m; 0: unknown), to
/// within three standard errors of a root mean square. Legs that end far nearer say that the noise
/// is too large, not that the model is good.
[[nodiscard]] bool as_good_as_noise(const HeldOut& held_out, double floor);
/// The same of the noise that they were predicted by.
[[nodiscard]] bool as_good_as_noise(const HeldOut& held_out);

/// What noise alone would leave, m: where something is missing, noise that was estimated without it
/// has taken some of it up, and what the model states is nearer.
[[nodiscard]] double noise_floor(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence);

/// A gain that most legs have no part in.
struct LocalGain {
  std::size_t legs = 0;
  std::size_t unchanged = 0;
  double worst_before = 0.0;  ///< m, of the leg that ended farthest off
  double worst_after = 0.0;   ///< m, of the same
};
/// None where half of the legs change, or where there is no gain. Both are of the same legs.
[[nodiscard]] std::optional<LocalGain> local_gain(const HeldOut& before, const HeldOut& after);
/// "9 of 10 legs unchanged, the worst 195 → 34 mm".
[[nodiscard]] std::string gain_in_words(const LocalGain& gain);

/// A sentence on a leg, one on dead reckoning, one on where the gain is. `with`: "with hard iron".
[[nodiscard]] std::vector<std::string> off_sentences(const ModelEvidence& before,
                                                     const std::string& noise = "its noise");
/// `floor`: what noise alone would leave, m; `noise`: whose, "its noise", "the noise found".
[[nodiscard]] std::vector<std::string> off_sentences(const ModelEvidence& before,
                                                     const ModelEvidence& after,
                                                     const std::string& with, double floor,
                                                     const std::string& noise = "its noise");

}  // namespace trussmap::report
