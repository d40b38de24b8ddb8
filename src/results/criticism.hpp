// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What compare, diagnose, discover and fit find.
#pragma once

#include "results/common.hpp"
#include "trussmap/session.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::results {

/// What a command says beside a report.
template <typename Report>
struct Reported {
  const Report* report = nullptr;
  const std::vector<std::string>* notes = nullptr;
  std::optional<Tolerance> tolerance = std::nullopt;
};
template <typename Report>
inline constexpr auto kDescribed<Reported<Report>> = described(
    keys_of("report", &Reported<Report>::report),
    field("tolerance", &Reported<Report>::tolerance).if_any(),
    field(
        "notes",
        [](const Reported<Report>& one) -> const std::vector<std::string>& { return *one.notes; },
        kOwnNotes));

// ----------------------------------------
// compare.

template <>
inline constexpr auto kDescribed<LegMisfit> = described(
    field("from", &LegMisfit::from, "landmark"), field("to", &LegMisfit::to, "landmark"),
    field("t", &LegMisfit::t, "s, at its end"), field("chi2", &LegMisfit::chi2, "of its segments"),
    field("dof", &LegMisfit::dof, "values among them").at_least(0.0),
    field("stretch_error", &LegMisfit::stretch_error, "(s - s0)/s0, signed: + is measured too long")
        .or_null(),
    field("orientation_error_rad", &LegMisfit::orientation_error, "signed").or_null());

template <>
inline constexpr auto kDescribed<RouteMisfit> = described(
    field("from", &RouteMisfit::from, "landmark"), field("to", &RouteMisfit::to, "landmark"),
    field("traversals", &RouteMisfit::traversals, "drives along it").at_least(0.0),
    field("chi2", &RouteMisfit::chi2, "sum"),
    field("force_per_m", &RouteMisfit::force,
          "in the bar, along it: gradient of chi2/2; + is tension"),
    field("stretch_error", &RouteMisfit::stretch_error, "mean, signed").or_null(),
    field("orientation_error_rad", &RouteMisfit::orientation_error, "mean, signed").or_null());

template <>
inline constexpr auto kDescribed<LandmarkMisfit> =
    described(field("landmark", &LandmarkMisfit::landmark, "its name"),
              field("sightings", &LandmarkMisfit::sightings, "of it").at_least(0.0),
              field("chi2", &LandmarkMisfit::chi2, "of its sightings and survey"));

template <>
inline constexpr auto kDescribed<Trend> = described(
    field("residual", &Trend::kind, "stretch, orientation, turn, compass, sighting"),
    field("against", &Trend::against, "the variable; all: a constant"),
    field("channel", through(&Trend::effect, &Effect::channel), kWhatChannel),
    field("shape", through(&Trend::effect, shape_texts), kWhatShape),
    field("coefficients", through(&Trend::effect, &Effect::coefficients),
          "of the trend as an effect"),
    field("score", &Trend::score, "chi2 that it explains"),
    field("dof", &Trend::dof, "of it").at_least(0.0), share("p_value", &Trend::p_value, "alone"),
    share("p_adjusted", &Trend::p_adjusted, "Holm's, over all trends"),
    field("size_rms", &Trend::size, "over rows or events, in the channel's unit"));

template <>
inline constexpr auto kDescribed<SourceCalibration> =
    described(field("source", &SourceCalibration::source, "of the model's [noise]"),
              field("factor", &SourceCalibration::factor,
                    "by which its stated standard deviation is too small"),
              field("sd", &SourceCalibration::sd, "of the factor").or_null(),
              field("redundancy", &SourceCalibration::redundancy, "measurements of it left over"));

template <>
inline constexpr auto kDescribed<Outlier> =
    described(field("what", &Outlier::what, "the measurement, in words"),
              field("statistic", &Outlier::statistic, "chi2"),
              field("dof", &Outlier::dof, "of it").at_least(0.0),
              share("p_adjusted", &Outlier::p_adjusted, "Bonferroni's, over all measurements"));

template <>
inline constexpr auto kDescribed<Comparison> = described(
    field(
        "verdict", [](const Comparison& one) { return verdict_of(one); },
        "misfit: the recordings contradict the model")
        .one_of("consistent | misfit"),
    field("chi2", &Comparison::chi2, "of the fit with the model's coefficients"),
    field("dof", &Comparison::dof, "its degrees of freedom"),
    field("coefficients_estimated", &Comparison::coefficients, "in this fit").at_least(0.0),
    share("p_value", &Comparison::p_value, "of chi2 as a whole"),
    share("level", &Comparison::level, "of significance, by which all is judged"),
    field("legs", &Comparison::legs, "of all recordings"),
    field("landmarks", &Comparison::landmarks, "of the map"),
    field("heldout", &Comparison::held_out,
          "how well the model predicts legs that it has not seen"),
    field("worst", &Comparison::worst, "all legs, worst first"),
    field("routes", &Comparison::routes, "the most strained first"),
    field("worst_landmarks", &Comparison::worst_landmarks, "worst first"),
    field("trends", &Comparison::trends, "strongest first"),
    field("noise", &Comparison::sources, "how noisy each source is, against what is stated"),
    field("outliers", &Comparison::outliers,
          "measurements that the others contradict, most significant first"),
    field(
        "advice", [](const Comparison& one) { return in_words(one.lacks); },
        "what these data lack, and what that costs"),
    field("sightings_used", &Comparison::sightings, "how many of the sightings judge the model"),
    field("warnings", &Comparison::warnings, "in words"));

template <>
inline constexpr auto kDescribed<ComparisonReport> =
    described(keys_of("found", &ComparisonReport::found),
              field("noise_budget", &ComparisonReport::noise_budget, kWhatBudget));

// ----------------------------------------
// fit.

template <>
inline constexpr auto kDescribed<EffectGain> = described(
    field("chi2", through(&EffectGain::with, &ModelFit::chi2), "with the effects fitted"),
    field("dof", through(&EffectGain::with, &ModelFit::dof), "its degrees of freedom"),
    share("p_value", through(&EffectGain::with, &ModelFit::p_value), "of chi2 as a whole"),
    field("effects", through(&EffectGain::with, &ModelFit::effects),
          "of the model, with their standard errors"),
    field("heldout", &EffectGain::held_out_with,
          "how well the fitted model predicts legs that it has not seen"),
    field("without_effects", described(field("chi2", through(&EffectGain::without, &ModelFit::chi2),
                                             "of the model without its effects"),
                                       field("dof", through(&EffectGain::without, &ModelFit::dof),
                                             "its degrees of freedom"),
                                       field("heldout", &EffectGain::held_out_without))),
    field("predicted_decrease", &EffectGain::predicted_decrease,
          "of chi2, by the score test before the fit"),
    field("warnings", through(&EffectGain::with, &ModelFit::warnings), "in words"));

template <>
inline constexpr auto kDescribed<FitReport> = described(
    keys_of("gain", &FitReport::gain), field("noise", &FitReport::noise, "with --noise").if_any(),
    keys_of("constants", &FitReport::constants));

// ----------------------------------------
// diagnose.

template <>
inline constexpr auto kDescribed<Finding> = described(
    keys_of("effect", &Finding::effect),
    field("score", &Finding::score, "chi2 that adding it would take away"),
    field("dof", &Finding::dof, "of it").at_least(0.0),
    share("p_value", &Finding::p_value, "alone"),
    share("p_adjusted", &Finding::p_adjusted, "Holm's, over all that was tried"),
    field("status", &Finding::status,
          "missing: named by these data; absent: a coefficient of any practical size would have "
          "been seen; negligible: there, and changes no leg's end by more than the noise; cannot "
          "tell: the data could not show it, or another effect shows as well")
        .one_of("missing | absent | negligible | cannot tell"),
    field("coefficients", through(&Finding::effect, &Effect::coefficients), "as estimated alone")
        .or_null(),
    field("sd", &Finding::sd, "standard errors").or_null(),
    field("smallest_detectable", &Finding::minimal_detectable,
          "coefficient of each shape alone that is seen with 90 % power at p = 0.05/200")
        .or_null(),
    field("heldout", &Finding::held_out, "predicted, with it added"),
    field("log_evidence", &Finding::evidence, "by which candidates are ordered"),
    field("tried", &Finding::tried, "members of its family").at_least(0.0),
    field("implausible", &Finding::implausible, "far larger than such effects are"),
    field("indistinguishable_from", &Finding::look_alikes, "of what is missing"));

template <>
inline constexpr auto kDescribed<NoiseTest> =
    described(field("law", &NoiseTest::law, "per metre, per second, per start, ..."),
              field("score", &NoiseTest::score, "fall of -2 log of the restricted likelihood"),
              field("dof", &NoiseTest::dof, "of it").at_least(0.0),
              share("p_adjusted", &NoiseTest::p_adjusted, "Holm's, over the laws"),
              field("size", &NoiseTest::size, "standard deviation that the law adds").or_null(),
              field("unit", &NoiseTest::unit, "of size"),
              field(
                  "in_words", [](const NoiseTest& one) { return in_words(one); }, kInWords));

template <>
inline constexpr auto kDescribed<EventTest> = described(
    field("kind", &EventTest::kind, "what it is").one_of("leg | landmark | sighting | session"),
    field("name", &EventTest::name, "its name, with the time"),
    field("score", &EventTest::score, "chi2"), field("dof", &EventTest::dof, "of it").at_least(0.0),
    share("p_adjusted", &EventTest::p_adjusted, "Holm's, over all events"),
    field(
        "in_words", [](const EventTest& one) { return in_words(one); }, kInWords));

template <>
inline constexpr auto kDescribed<Unobservable> = described(
    keys_of("effect", &Unobservable::effect),
    field(
        "why", [](const Unobservable& one) { return advice_on(one).why; },
        "these data cannot show it"),
    field(
        "remedy", [](const Unobservable& one) { return advice_on(one).drive; }, "what would"));

template <>
inline constexpr auto kDescribed<ExplainingEffect> =
    described(keys_of("effect", &ExplainingEffect::effect),
              field("coefficients", through(&ExplainingEffect::effect, &Effect::coefficients),
                    "with the others of the set"),
              field("sd", &ExplainingEffect::sd, "standard errors").or_null(),
              field("otherwise", &ExplainingEffect::otherwise,
                    "names of look-alikes that explain about as much in its place"));

template <>
inline constexpr auto kDescribed<EffectSet> = described(
    field("effects", &EffectSet::effects, "that explain the recordings together"),
    field("log_evidence_behind", &EffectSet::behind, "the best set").at_least(0.0),
    share("probability", &EffectSet::probability,
          "that it, or a set that only adds to it, is the explanation"),
    field("chi2_decrease", &EffectSet::chi2_decrease,
          "that adding them takes away, to first order"),
    field("named", &EffectSet::named, "whether it is what the candidates say is missing"));

template <>
inline constexpr auto kDescribed<EffectChance> = described(
    keys_of("effect", &EffectChance::effect),
    field("otherwise", &EffectChance::otherwise, "names of look-alikes, which count as it"),
    share("probability", &EffectChance::probability,
          "that it, or one that looks like it, is part of the explanation"));

template <>
inline constexpr auto kDescribed<CoursePart> = described(
    field("recording", &CoursePart::session, "place among the recordings, from 0 on"),
    field("from_t", &CoursePart::from, "s"), field("until_t", &CoursePart::until, "s"),
    field("value", &CoursePart::value, "of the coefficient; a factor where there are several"),
    field("sd", &CoursePart::sd, "its standard error"));

/// A value of a change that is a step; none of a walk.
template <auto kMember>
[[nodiscard]] auto of_step(const ChangingCoefficient& change) {
  return change.form == ChangingCoefficient::Form::step ? std::optional(change.*kMember)
                                                        : std::nullopt;
}

template <>
inline constexpr auto kDescribed<ChangingCoefficient> = described(
    keys_of("effect", &ChangingCoefficient::effect),
    field(
        "form",
        [](const ChangingCoefficient& one) {
          return one.form == ChangingCoefficient::Form::step ? "step" : "walk";
        },
        "what explains more of the change: one step, or a walk at random")
        .one_of("step | walk"),
    field("fitted", &ChangingCoefficient::fitted, "the same all the time, as the model has it"),
    share("p_value", &ChangingCoefficient::p_value, "of no change, times all that was tried"),
    field("chi2_decrease", &ChangingCoefficient::chi2_decrease,
          "that allowing for it takes away (a walk: of -2 log likelihood, times the dispersion "
          "left)"),
    field("recording", of_step<&ChangingCoefficient::session>, "of a step: place, from 0 on"),
    field("between", of_step<&ChangingCoefficient::between>,
          "of a step: whether it is before the first drive of that recording"),
    field("t", of_step<&ChangingCoefficient::t>, "s, of a step"),
    field("earliest_t", of_step<&ChangingCoefficient::earliest>, "s, of a step, 95 %"),
    field("latest_t", of_step<&ChangingCoefficient::latest>, "s, likewise"),
    field("before", of_step<&ChangingCoefficient::before>, "value before a step"),
    field("before_sd", of_step<&ChangingCoefficient::before_sd>, "its standard error"),
    field("after", of_step<&ChangingCoefficient::after>, "value after it"),
    field("after_sd", of_step<&ChangingCoefficient::after_sd>, "its standard error"),
    field("course", &ChangingCoefficient::course, "in order of time"),
    field("goes_with", &ChangingCoefficient::goes_with,
          "slow variables that explain all of the change, closest first"),
    field(
        "in_words", [](const ChangingCoefficient& one) { return in_words(one); }, kInWords));

template <>
inline constexpr auto kDescribed<FieldOfPlaces> = described(
    field("channel", &FieldOfPlaces::channel, "that differs from place to place"),
    field(
        "unit", [](const FieldOfPlaces& one) { return std::string(facts_of(one.channel).unit); },
        "of size, mean and sd; empty: a share"),
    field("size", &FieldOfPlaces::size, "sd over the way that was driven"),
    field("length_m", &FieldOfPlaces::length,
          "so far apart places have a correlation of 0.14 left, the likeliest"),
    share("p_value", &FieldOfPlaces::p_value, "of no field, times the channels asked"),
    field("chi2_decrease", &FieldOfPlaces::chi2_decrease,
          "that it takes away: the gain in -2 log likelihood, times the dispersion left"),
    share("told", &FieldOfPlaces::told, "of its variance along the way, by these recordings"),
    field("rivals", &FieldOfPlaces::rivals, "channels, a field of which would explain it as well"),
    field("patches", &FieldOfPlaces::patches,
          "candidates at a place that explain it as well: then it is these, and no field"),
    field("x_m", &FieldOfPlaces::x, "centre of the first cell"),
    field("y_m", &FieldOfPlaces::y, "likewise"), field("cell_m", &FieldOfPlaces::cell, "its side"),
    field("columns", &FieldOfPlaces::columns, "cells along x").at_least(1.0),
    field("rows", &FieldOfPlaces::rows, "cells along y").at_least(1.0),
    field("mean", &FieldOfPlaces::mean,
          "of each cell, less the mean over the way; row by row, least y first; null where the "
          "robot never was")
        .or_null(),
    field("sd", &FieldOfPlaces::sd, "their standard errors").or_null(),
    field(
        "in_words", [](const FieldOfPlaces& one) { return in_words(one); }, kInWords));

/// The noise that a diagnosis goes by; nullptr where none was estimated.
[[nodiscard]] inline const FittedNoise* noise_of(const Diagnosis& result) {
  return result.under ? &result.under->noise : nullptr;
}

template <>
inline constexpr auto kDescribed<Diagnosis> = described(
    field(
        "verdict", [](const Diagnosis& one) { return verdict_of(one); },
        "what these data say of the model")
        .one_of("missing | nothing missing | unexplained misfit"),
    field("missing", &Diagnosis::missing,
          "the first candidate's name, where it is missing; else empty"),
    share("p_value", &Diagnosis::p_value, "its, adjusted; else of chi2"),
    share("level", &Diagnosis::level, "of significance, by which all is judged"),
    field("chi2", &Diagnosis::chi2, "of the model given"),
    field("dof", &Diagnosis::dof, "its degrees of freedom"),
    field("coefficients_estimated", &Diagnosis::coefficients, "in this fit").at_least(0.0),
    field("heldout", &Diagnosis::held_out, "how well the model predicts legs that it has not seen"),
    field("tried", &Diagnosis::tried, "tests"),
    field("candidates", &Diagnosis::findings, "best first"),
    field("explanations", through(&Diagnosis::explanations, &Explanations::sets),
          "all sets of effects within 6 units of log evidence of the best (odds of 400 to 1), best "
          "first; none where nothing is missing"),
    field("effect_probabilities", through(&Diagnosis::explanations, &Explanations::effects),
          "of being part of the explanation, likeliest first, from 0.01 on"),
    share("probability_otherwise", through(&Diagnosis::explanations, &Explanations::none_of_these),
          "of all sets that are not listed"),
    field("changing", &Diagnosis::changing,
          "effects of the model, and missing ones, whose coefficients change, surest first"),
    field("places", &Diagnosis::places,
          "channels that differ from place to place, as maps of cells, surest first"),
    field("noise", &Diagnosis::noise,
          "laws that explain what errors there are beyond what the model states, best first"),
    field("noise_estimated", noise_of, "by which all is judged; null with --stated-noise"),
    field("outliers", &Diagnosis::events, "single events, likeliest first"),
    field(
        "advice", [](const Diagnosis& one) { return in_words(one.lacks); },
        "what these data lack, and what that costs"),
    field(
        "next_drive", [](const Diagnosis& one) { return in_words(one.next_drive); },
        "what to drive to tell the rivals apart"),
    field("unobservable", &Diagnosis::unobservable, "what these data cannot show, and why"),
    field("sightings_used", &Diagnosis::sightings, "how many of the sightings judge the model"),
    field("warnings", &Diagnosis::warnings, "in words"));

template <>
inline constexpr auto kDescribed<DiagnosisReport> =
    described(keys_of("found", &DiagnosisReport::found),
              field("noise_budget", &DiagnosisReport::noise_budget, kWhatBudget),
              keys_of("constants", &DiagnosisReport::constants));

// ----------------------------------------
// discover.

/// What the diagnosis before a step foretold of it.
struct Promised {
  const DiscoveryStep* step = nullptr;
};
template <>
inline constexpr auto kDescribed<Promised> = described(
    field("chi2_decrease", through(&Promised::step, &DiscoveryStep::predicted_decrease),
          "that the diagnosis foretold"),
    field("arrival_rms_m",
          through(&Promised::step, &DiscoveryStep::predicted, &HeldOutMetrics::arrival_rms),
          "that it foretold, of held-out legs"));

[[nodiscard]] inline std::optional<SizedEffect> added_in(const DiscoveryStep& step) {
  return step.added ? std::optional(SizedEffect{&*step.added}) : std::nullopt;
}
[[nodiscard]] inline std::vector<std::string> together_in(const DiscoveryStep& step) {
  std::vector<std::string> names;
  for (const Effect& one : step.together) names.push_back(one.name);
  return names;
}

/// A value of a step that adds an effect; none of the first.
template <auto kMember>
[[nodiscard]] auto of_added(const DiscoveryStep& step) {
  return step.added ? std::optional(step.*kMember) : std::nullopt;
}

template <>
inline constexpr auto kDescribed<DiscoveryStep> = described(
    field("added", added_in, "null: the model given"),
    field("chi2", &DiscoveryStep::chi2, "of this step's model"),
    field("dof", &DiscoveryStep::dof, "its degrees of freedom"),
    field("left_out", &DiscoveryStep::left_out,
          "sightings, fixes and loops that contradict all others"),
    field("heldout", &DiscoveryStep::held_out, "over the same legs in every step"),
    field("reckoned_10_s_m", &DiscoveryStep::reckoned_10,
          "dead reckoning's error over 10 s against the fit's own path; null: fewer than 20 such "
          "stretches"),
    field("reckoned_30_s_m", &DiscoveryStep::reckoned_30, "the same over 30 s"),
    field("together", together_in,
          "effects added together with it, which cannot be fitted alone or hide each other")
        .if_any(),
    field("dropped", of_added<&DiscoveryStep::dropped>, "effects that are no longer significant")
        .if_any(),
    field("promised",
          [](const DiscoveryStep& step) {
            return step.added ? std::optional(Promised{&step}) : std::nullopt;
          })
        .if_any(),
    field("indistinguishable_from", of_added<&DiscoveryStep::look_alikes>,
          "what it could be instead")
        .if_any());

template <>
inline constexpr auto kDescribed<Discovery> = described(
    field("steps", &Discovery::steps, "models on the way, the one given first"),
    field(
        "stopped", [](const Discovery& one) { return stop_in_words(one); }, "why"),
    field(
        "verdict", [](const Discovery& one) { return verdict_of(one); }, "of the model found")
        .one_of("consistent | unexplained misfit"),
    field("effects", through(&Discovery::found, &ModelFit::effects), "of the model found"),
    field("changing", through(&Discovery::last, &Diagnosis::changing),
          "effects of the last model, and missing ones, whose coefficients change, surest first"),
    field("places", through(&Discovery::last, &Diagnosis::places),
          "channels that differ from place to place beside the last model"),
    field(
        "noise_estimated", [](const Discovery& one) { return noise_of(one.last); },
        "by which all is judged; null with --stated-noise"),
    field("sightings_used", &Discovery::sightings, "how many of the sightings judge the models"),
    field("warnings", through(&Discovery::found, &ModelFit::warnings), "in words"));

template <>
inline constexpr auto kDescribed<DiscoveryReport> =
    described(keys_of("found", &DiscoveryReport::found),
              field("noise_budget", &DiscoveryReport::noise_budget, kWhatBudget),
              keys_of("constants", &DiscoveryReport::constants));

}  // namespace trussmap::results
