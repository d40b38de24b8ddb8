// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Results in words that a robot's owner can act on: sizes, verdicts, advice. Sentences begin small
// and end without a full stop; "+-" and " deg" are plain text.
#pragma once

#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/model.hpp"
#include "trussmap/noise_fit.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

struct BuiltMap;
struct FleetReport;
struct OneWheel;
struct Response;
struct TrendEvidence;

// Effects.

/// "the wheelbase is 2.0 +- 0.1 % larger than nominal". `effect` has coefficients;
/// `sd` as many standard errors (0 or infinite: none is given).
[[nodiscard]] std::string in_words(const Effect& effect, const std::vector<double>& sd);

/// "the left wheel is 0.96 +- 0.02 % larger than nominal; the right one and the wheelbase are as
/// the model has them".
[[nodiscard]] std::string in_words(const OneWheel& wheel);

/// A fit's effects, each as "name: in words". Where one wheel explains ratio, wheelbase and scale
/// alike (calibrate.hpp), one sentence on it in their place.
[[nodiscard]] std::vector<std::string> effects_in_words(const ModelFit& fit);

/// A name as a sentence has it: "slippery patch at x 12.3 m, y 9.8 m, radius 3.1 m" for
/// "slippery patch (x=12.345, y=9.8, r=3.1)", "turning error with turn rate" for "turn with
/// turn_rate". A user's own name stays.
[[nodiscard]] std::string name_in_words(const Effect& effect);
/// The same without what is open in the catalogue: "slippery patch".
[[nodiscard]] std::string short_name(const Effect& effect);

/// "compass x sin(heading), cos(heading)".
[[nodiscard]] std::string formula_of(const Effect& effect);

/// A warning for every effect that has no coefficients yet: what follows a model does without it.
[[nodiscard]] std::vector<std::string> unfitted_in_words(const Model& model);

/// The most that an effect does in some recordings, from its least to its largest g there: "the
/// compass reads up to 2.9 deg too much or too little".
[[nodiscard]] std::string size_in_words(const Effect& effect, double least, double most);

/// "hard iron (cos(heading)): not fitted, no measurement tells it from the map ...".
[[nodiscard]] std::string in_words(const EffectEstimate& estimate, const UnfittedCoefficient& one);

// Advice.

struct Advice {
  std::string lack;   ///< what these data lack
  std::string why;    ///< why that matters
  std::string drive;  ///< what to drive or to measure
};
[[nodiscard]] Advice advice_on(const DataLack& lack);
/// "lack: why; drive".
[[nodiscard]] std::string in_words(const Advice& advice);
[[nodiscard]] std::vector<std::string> in_words(const std::vector<DataLack>& lacks);

/// Why recordings cannot show an effect, and what helps.
[[nodiscard]] Advice advice_on(const Unobservable& unseen);

/// That a fit holds the place or threshold of an effect of the catalogue: "x, y, r are held as the
/// model has them, ..."; empty where it has none.
[[nodiscard]] std::string held_in_words(const Effect& effect);

/// What to drive to tell two effects apart, where `slow` are the covariates that vary slowly.
[[nodiscard]] std::string separating_drive(const Effect& one, const Effect& other,
                                           const std::vector<std::string>& slow);
[[nodiscard]] std::string in_words(const std::optional<NextDrive>& drive);  ///< none: empty

/// A fleet's findings, a sentence a line; the lines of a finding stand two blanks in.
[[nodiscard]] std::vector<std::string> in_words(const FleetReport& report);

// Findings beside effects.

/// "each start adds 4.0 mm of travel noise".
[[nodiscard]] std::string in_words(const NoiseTest& test);
/// What is other than stated: "wheels 1.9 times what is stated; compass errors that last for 1.9
/// s"; empty where nothing is.
[[nodiscard]] std::string in_words(const FittedNoise& noise);
/// What costs most, and what would help against it.
[[nodiscard]] std::string in_words(const NoiseBudget& budget);
/// "the left wheel said 3.1 cm too little at once, in the leg 12 -> 13 at t = 45.2 s".
[[nodiscard]] std::string in_words(const EventTest& event);

/// "wheelbase changes at t = 412 s (395 to 430 s): before, the wheelbase is ...; after, ...".
[[nodiscard]] std::string in_words(const ChangingCoefficient& change);

/// "travel differs from place to place".
[[nodiscard]] std::string field_in_words(Channel channel);
/// "travel differs from place to place: sd 0.82 %, over about 4.1 m"; where rivals or a patch
/// explain it as well: "; or it is creep to the left", "; explained as well by slippery patch
/// (...)".
[[nodiscard]] std::string in_words(const FieldOfPlaces& field);

// Verdicts, as files have them.

[[nodiscard]] std::string_view name_of(Status status);   ///< "cannot tell"
[[nodiscard]] std::string_view name_of(EventKind kind);  ///< "leg"
/// The status as a table of candidates has it: what is significant by itself and yet absent is
/// "explained by the above".
[[nodiscard]] std::string_view status_in_words(const Finding& finding);
[[nodiscard]] std::string_view verdict_of(const Comparison& result);  ///< "misfit"
[[nodiscard]] std::string_view verdict_of(const Diagnosis& result);   ///< "nothing missing"
[[nodiscard]] std::string_view verdict_of(const Discovery& result);   ///< "unexplained misfit"
[[nodiscard]] std::string_view verdict_of(const BuiltMap& built);     ///< "good", "doubtful"

/// "misfit: errors are 2.3 times what the model's noise allows": the verdict, then what it rests
/// on.
[[nodiscard]] std::string verdict_in_words(const Comparison& result);
/// "good: nothing speaks against this map, certain to 0.012 m (median)", "doubtful: " and the first
/// warning.
[[nodiscard]] std::string verdict_in_words(const BuiltMap& built);
[[nodiscard]] std::string verdict_in_words(const Diagnosis& result);
[[nodiscard]] std::string verdict_in_words(const Discovery& result);

/// "judged by 104 of 976 sightings, one frame in 5 s"; empty where all are used.
[[nodiscard]] std::string in_words(const UsedSightings& sightings);

/// "the map is 1.6 % too small"; `scale`: what the map has to be multiplied by.
[[nodiscard]] std::string map_scale_in_words(double scale);

/// A finding's status and size, with all that is missing: "missing: hard iron; the compass ...".
[[nodiscard]] std::string in_words(const Finding& finding);

/// How the fit with a rival that is not told apart compares: ", its fit 3 behind"; empty where
/// neither is worse by anything that shows.
[[nodiscard]] std::string behind_in_words(const LookAlike& rival);

/// "nothing more is significant".
[[nodiscard]] std::string stop_in_words(const Discovery& result);

/// What speaks against the model: "errors are 2.3 times what the model's noise allows".
[[nodiscard]] std::string objection_in_words(const Comparison& result);
/// The same where a diagnosis may object to the noise by which the model was compared.
[[nodiscard]] std::string objection_in_words(const Diagnosis& diagnosis, const Comparison& result);

// Responses (evidence.hpp).

/// How a response is drawn: what stands at its axes, and the factors to the units that they show.
struct ResponseAxes {
  std::string variable;  ///< "heading [°]"
  double variable_factor = 1.0;
  std::string error;  ///< "compass reads too much by [°]"
  double error_factor = 1.0;
};
[[nodiscard]] ResponseAxes axes_of(const Response& response);
/// "turn against turn rate".
[[nodiscard]] std::string name_in_words(const TrendEvidence& trend);

// Figures.

/// "35 legs not used in the fit end 16.0 mm off (rms), ...".
[[nodiscard]] std::string in_words(const HeldOut& held_out);
/// "chi2 118.2, dof 116, 2 coefficients estimated".
[[nodiscard]] std::string fit_in_words(double chi2, int dof, int coefficients);

/// "2.9", "0.031", "120": two digits, and never an exponent above 1.
[[nodiscard]] std::string two_digits(double value);

}  // namespace trussmap
