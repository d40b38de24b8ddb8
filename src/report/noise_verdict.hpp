// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Is the noise itself what is wrong? One rule for headlines, rows and tables.
#pragma once

#include "report/page.hpp"
#include "trussmap/evidence.hpp"

#include <string>

namespace trussmap::report {

/// Noise that is found so many times what is stated, or the other way round, is as stated: no map
/// and no forecast differs to speak of.
inline constexpr double kNoiseAsStated = 1.2;

/// Whether a source is other than stated by more than that, or is one that the model does not have.
[[nodiscard]] bool is_wrong(const NoiseSource& source);
[[nodiscard]] bool is_wrong(const FittedNoise& noise);
/// Of the noise that a diagnosis goes by.
[[nodiscard]] bool noise_is_wrong(const Diagnosis& diagnosis);

/// "wheels 5.9 mm after a metre, not 3 as stated", of all that are wrong.
[[nodiscard]] std::string found_and_stated(const FittedNoise& noise);

/// What legs were expected to end off by the noise stated, and by that found; empty where unknown.
[[nodiscard]] std::string noise_gain(const DiagnosisEvidence& evidence);

/// "wheels 3.0 ± 0.2 times and compass 2.0 ± 0.1 times": sources that are clearly
/// noisier than stated; empty where none is.
[[nodiscard]] std::string noisier_than_stated(const Comparison& comparison);

}  // namespace trussmap::report
