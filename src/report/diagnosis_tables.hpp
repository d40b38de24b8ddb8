// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the pages of diagnose and discover say alike.
#pragma once

#include "trussmap/report/diagnosis_page.hpp"

#include <string>
#include <vector>

namespace trussmap {

inline constexpr double kStandsOut = 0.05;  ///< adjusted p-value of noise and events

/// "hard iron", "hard iron and turn scrub", "a, b and c".
[[nodiscard]] std::string listed(const std::vector<std::string>& names,
                                 const std::string& last = "and");

/// An adjusted p-value for people: "0.004", "next to 0".
[[nodiscard]] std::string chance_text(double p);

/// Largest size with its standard error: "±2.913°", "0.033°".
struct SizeText {
  std::string size;
  std::string error;  ///< empty where there is none
};
[[nodiscard]] SizeText size_text_of(const FittedEffect& effect);

/// What makes an effect and what helps; empty beyond the catalogue.
[[nodiscard]] std::string cause_note(const Effect& effect);

/// "It could also be ...", or that it could not.
[[nodiscard]] std::string rivals_note(const Effect& effect, const std::vector<LookAlike>& rivals);

/// The leading law of noise and the leading single event, those that stand out.
[[nodiscard]] std::vector<std::string> others_notes(const Diagnosis& diagnosis);

/// "would have been seen: ...", of the sizes in the tables.
[[nodiscard]] std::string seen_from_note(const DiagnosisTables& tables);

/// All that was tried, noise and single events, what cannot be seen and why, advice, warnings.
[[nodiscard]] PageSection tried_section(const Diagnosis& diagnosis, const DiagnosisTables& tables);

}  // namespace trussmap
