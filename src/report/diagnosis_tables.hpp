// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What the pages of diagnose and discover say alike.
#pragma once

#include "report/diagnosis_page.hpp"

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
// The questions of the first screen.
inline constexpr const char* kHowLarge = "How large?";
inline constexpr const char* kHowSure = "How sure?";
inline constexpr const char* kWhatElse = "What else could it be?";
inline constexpr const char* kNext = "What to do next?";
inline constexpr const char* kCause = "Where does it come from?";
inline constexpr const char* kSeen = "What is ruled out?";
inline constexpr const char* kBeside = "What else is there?";

// Its figures.
inline constexpr const char* kLegsEnd =
    "legs (landmark to landmark) that no fit has seen end so far off";
inline constexpr const char* kLegsEnded =
    "legs (landmark to landmark) that no fit has seen ended so far off";
inline constexpr const char* kLegsEndNow = "the same with the model found";

/// One effect: "hard iron – the compass reads up to 2.9° too much or too little"; several: "hard
/// iron (±2.9°) and wheelbase (2 %)".
[[nodiscard]] std::string named_with_sizes(const std::vector<FittedEffect>& effects);

/// "Hard iron: the compass reads up to 2.9° too much or too little (±2.91°, standard error 0.03°)."
[[nodiscard]] std::string sized_in_words(const FittedEffect& effect);

/// Advice, "what is lacking: why it matters; what to drive", with the drive first.
[[nodiscard]] std::string advised_drive(const std::string& advice);

/// How likely chance is, in a sentence.
[[nodiscard]] std::string sure_text(double p, std::size_t tests);

[[nodiscard]] std::string capitalised(std::string text);

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
