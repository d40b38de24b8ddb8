// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What pages say alike: figures with their signs, and the sentences of the first screen.
#pragma once

#include "trussmap/diagnose.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/wording.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace trussmap {

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

/// The words of reports with the signs that a page has: "±" and "°".
[[nodiscard]] std::string typeset(std::string text);

[[nodiscard]] std::string capitalised(std::string text);

/// "hard iron", "hard iron and turn scrub", "a, b and c".
[[nodiscard]] std::string listed(const std::vector<std::string>& names,
                                 const std::string& last = "and");

/// "16 mm", "21 cm", "1.3 m". With `beside`, in the unit that suits the larger of the two.
[[nodiscard]] std::string distance_text(double metres, double beside = 0.0);

/// A p-value for people: "0.004", "next to 0".
[[nodiscard]] std::string chance_text(double p);

/// What a trend goes with: "heading", "everything alike".
[[nodiscard]] std::string trend_variable(const Trend& trend);

/// "hard iron: the compass reads up to 2.9° too much or too little".
[[nodiscard]] std::string effect_in_words(const EffectEvidence& effect);

/// Largest size with its standard error: "±2.913°", "0.033°".
struct SizeText {
  std::string size;
  std::string error;  ///< empty where there is none
};
[[nodiscard]] SizeText size_text_of(const EffectEvidence& effect);

/// One effect: "hard iron – the compass reads up to 2.9° too much or too little"; several: "hard
/// iron (±2.9°) and wheelbase (2 %)".
[[nodiscard]] std::string named_with_sizes(const std::vector<EffectEvidence>& effects);

/// "Hard iron: the compass reads up to 2.9° too much or too little (±2.91°, standard error 0.03°)."
[[nodiscard]] std::string sized_in_words(const EffectEvidence& effect);

/// "Without it legs end 21 cm off; with it 1.6 cm, as good as this robot's noise allows." Empty
/// without held-out legs. `it`: "it", "them".
[[nodiscard]] std::string gain_sentence(const Comparison& before, const Comparison& after,
                                        const std::string& it);

/// The drive first, then what it is for.
[[nodiscard]] std::string advised_drive(const Advice& advice);

/// How likely chance is, in a sentence.
[[nodiscard]] std::string sure_text(double p, std::size_t tests);

/// What makes an effect and what helps; empty beyond the catalogue.
[[nodiscard]] std::string cause_note(const Effect& effect);

/// "It could also be ...", or that it could not.
[[nodiscard]] std::string rivals_note(const Effect& effect, const std::vector<LookAlike>& rivals);

/// The leading law of noise and the leading single event, those that stand out.
[[nodiscard]] std::vector<std::string> others_notes(const Diagnosis& diagnosis);

}  // namespace trussmap
