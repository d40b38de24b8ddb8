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

namespace trussmap::report {

/// The words of reports with the signs that a page has: "±" and "°".
[[nodiscard]] std::string typeset(std::string text);

[[nodiscard]] std::string capitalised(std::string text);

/// "hard iron", "hard iron and turn scrub", "a, b and c".
[[nodiscard]] std::string listed(const std::vector<std::string>& names,
                                 const std::string& last = "and");

/// A sentence of each one's words (in_words).
template <class Told>
[[nodiscard]] std::vector<std::string> sentences_of(const std::vector<Told>& all) {
  std::vector<std::string> sentences;
  sentences.reserve(all.size());
  for (const Told& one : all) sentences.push_back(typeset(capitalised(in_words(one)) + "."));
  return sentences;
}

/// "16 mm", "21 cm", "1.3 m". With `beside`, in the unit that suits the larger of the two.
[[nodiscard]] std::string distance_text(double metres, double beside = 0.0);

/// "1 leg", "12 legs".
[[nodiscard]] std::string counted_legs(std::size_t legs);

/// A p-value for people: "0.004", "below 10^-12".
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

/// One effect, where that is short: "hard iron – the compass reads up to 2.9° too much or too
/// little"; several: "hard iron (±2.9°) and wheelbase (2 %)".
[[nodiscard]] std::string named_with_sizes(const std::vector<EffectEvidence>& effects);

/// "hard iron (±2.9°)".
[[nodiscard]] std::string named_with_size(const EffectEvidence& effect);

/// Whether no coefficient is clearly other than 0.
[[nodiscard]] bool is_hardly_seen(const EffectEstimate& fitted);

/// "Both wheels are 2.0 ± 0.1 % larger per kg of payload.": the fitted coefficients, with their
/// standard errors; at most, in these recordings, where they are many.
[[nodiscard]] std::string how_large(const EffectEvidence& effect);

/// "Hard iron: the compass reads up to 2.9° too much or too little (±2.91°, standard error 0.03°)."
[[nodiscard]] std::string sized_in_words(const EffectEvidence& effect);

/// "Legs end 21 cm off, 1.6 cm with it." Empty without held-out legs. `it`: "it", "them".
[[nodiscard]] std::string gain_sentence(const Comparison& before, const Comparison& after,
                                        const std::string& it);

/// The drive first, then what it is for.
[[nodiscard]] std::string advised_drive(const Advice& advice);

/// How likely chance is, in a sentence.
[[nodiscard]] std::string sure_text(double p, std::size_t tests);

/// "Hard iron: magnets and steel on the robot."; beyond the catalogue its name.
[[nodiscard]] std::string what_it_is(const Effect& effect);
/// "Against hard iron for good: calibrate the compass."; empty beyond the catalogue.
[[nodiscard]] std::string what_helps(const Effect& effect);

/// The first few effects that these recordings cannot show, and "3 more".
[[nodiscard]] std::vector<std::string> unseen_names(const Diagnosis& diagnosis);

/// A page's verdict, and by how many of the sightings it is one.
[[nodiscard]] std::string with_judged(const std::string& verdict, const UsedSightings& sightings);

/// The first three, and "17 more".
void shorten(std::vector<std::string>& names);

/// "It could also be ...", or that it could not.
[[nodiscard]] std::string rivals_note(const Effect& effect, const std::vector<LookAlike>& rivals);

/// Of a model that lacks no effect: whether its noise is wrong, or how far `off` legs end (" Legs
/// end ..."), and that a slight misfit is left.
[[nodiscard]] std::string faultless_verdict(const Diagnosis& diagnosis, const std::string& off);

/// The leading law of noise and the leading single event, those that stand out. `who_states`: where
/// the noise that was estimated can be had.
[[nodiscard]] std::vector<std::string> others_notes(
    const Diagnosis& diagnosis,
    const std::string& who_states = "fit --noise and discover write it with --out");

}  // namespace trussmap::report
