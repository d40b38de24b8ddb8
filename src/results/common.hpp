// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What several commands' results have in common.
#pragma once

#include "results/described.hpp"
#include "trussmap/calibrate.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/noise_fit.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/wording.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::results {

/// What is meaningless or not known at 0.
[[nodiscard]] inline std::optional<double> unless_zero(double value) {
  return value > 0.0 ? std::optional(value) : std::nullopt;
}

inline constexpr const char* kOwnNotes = "what the command did with the data on its own";

inline constexpr const char* kWhatChannel = "what it acts on: wheels, turn, compass, ...";
inline constexpr const char* kWhatShape = "its formulas, one per coefficient";
inline constexpr const char* kWhatBudget =
    "what of dead reckoning's error by the wheels comes from which noise";
inline constexpr const char* kInWords = "the same in a sentence";

[[nodiscard]] inline std::vector<std::string> shape_texts(const Effect& effect) {
  return texts_of(effect.shape);
}

template <>
inline constexpr auto kDescribed<Effect> =
    described(field("effect", &Effect::name, "name, as in the catalogue, or of a formula"),
              field("channel", &Effect::channel, kWhatChannel),
              field("shape", shape_texts, kWhatShape))
        .named("effect");

/// An effect with its size.
struct SizedEffect {
  const Effect* effect = nullptr;
};
template <>
inline constexpr auto kDescribed<SizedEffect> =
    described(keys_of("effect", &SizedEffect::effect),
              field("coefficients", through(&SizedEffect::effect, &Effect::coefficients)));

/// Likewise, with the standard error of its only coefficient.
struct ConstantEffect {
  const Effect* effect = nullptr;
  double sd = 0.0;
};
template <>
inline constexpr auto kDescribed<ConstantEffect> =
    described(keys_of("effect", &ConstantEffect::effect),
              field("coefficients", through(&ConstantEffect::effect, &Effect::coefficients)),
              field("sd", [](const ConstantEffect& one) { return std::vector{one.sd}; }));

template <>
inline constexpr auto kDescribed<HeldOutMetrics> =
    described(field("arrival_rms_m", &HeldOutMetrics::arrival_rms,
                    "root mean square distance between where the model says a leg ends and where "
                    "its landmark is"),
              field("stretch_error", &HeldOutMetrics::stretch_error,
                    "mean of |s - s0|/s0 over legs of length s"),
              field("orientation_error_rad", &HeldOutMetrics::orientation_error,
                    "mean of |theta - theta0| over their orientations"))
        .named("errors_of_legs");

template <>
inline constexpr auto kDescribed<HeldOut> =
    described(field(
                  "legs", [](const HeldOut& one) { return one.legs.size(); },
                  "legs that no fit has seen"),
              keys_of("metrics", [](const HeldOut& one) -> const HeldOutMetrics& { return one; }),
              field("expected_rms_m", &HeldOut::expected_rms,
                    "what arrival_rms_m would be if the model were right and its noise as large "
                    "as it states"))
        .named("heldout");

template <>
inline constexpr auto kDescribed<LookAlike> =
    described(keys_of("effect", &LookAlike::effect),
              field("cosine", &LookAlike::cosine,
                    "of both traces, after projection on map and poses"),
              field("chi2_behind", &LookAlike::behind,
                    "by which it explains less; from 12 on all measurements together tell it "
                    "apart, however alike it is"))
        .named("look_alike");

/// What stays as it was, in words.
[[nodiscard]] inline std::vector<std::string> not_fitted_in_words(const EffectEstimate& estimate) {
  std::vector<std::string> lines;
  for (const UnfittedCoefficient& one : estimate.not_fitted) {
    lines.push_back(in_words(estimate, one));
  }
  return lines;
}

template <>
inline constexpr auto kDescribed<EffectEstimate> =
    described(keys_of("effect", &EffectEstimate::effect),
              field("coefficients", through(&EffectEstimate::effect, &Effect::coefficients)),
              field("sd", &EffectEstimate::sd, "standard errors").or_null(),
              field(
                  "in_words",
                  [](const EffectEstimate& one) { return in_words(one.effect, one.sd); }, kInWords),
              field("not_fitted", not_fitted_in_words,
                    "coefficients that these recordings cannot show, and why"))
        .named("estimate");

template <>
inline constexpr auto kDescribed<UsedSightings> =
    described(field("used", &UsedSightings::used, "sightings that the model is judged by"),
              field("all", &UsedSightings::all, "sightings of the recordings"),
              field("every_s", &UsedSightings::every, "of which one frame is used; 0: all are")
                  .at_least(0.0))
        .named("sightings_used");

template <>
inline constexpr auto kDescribed<Tolerance> =
    described(field("m", &Tolerance::most, "that --tolerance asks for"),
              field("arrival_rms_m", &Tolerance::arrival_rms,
                    "how far off held-out legs end, root mean square"),
              field("legs", &Tolerance::legs, "held out"),
              field("passed", &Tolerance::passed, "whether they end within it"))
        .named("tolerance", "absent where none is asked for");

template <>
inline constexpr auto kDescribed<NoiseSource> = described(
    field("source", &NoiseSource::name, "wheels, compass, range, ..., or a process"),
    field("unit", &NoiseSource::unit, "of sd"),
    field(
        "channel",
        [](const NoiseSource& one) {
          return one.lasts ? std::optional(one.process.channel) : std::nullopt;
        },
        "of a process: what it acts on")
        .if_any(),
    field(
        "process",
        [](const NoiseSource& one) {
          return one.lasts ? std::optional(one.process.process) : std::nullopt;
        },
        "of a process: its kind")
        .if_any(),
    field("stated", &NoiseSource::stated, "what the model has; 0: nothing"),
    field("sd", &NoiseSource::sd, "standard deviation as estimated"),
    field(
        "sd_error", [](const NoiseSource& one) { return unless_zero(one.sd_error); },
        "its standard error; null where it stays as stated, and in diagnose and discover"),
    field("at_limit", &NoiseSource::at_limit, "size or length went as far as is sought"),
    field(
        "length", [](const NoiseSource& one) { return unless_zero(one.process.length); },
        "of a process: over which it lasts, in the unit of what it runs over")
        .if_any(),
    field(
        "length_error",
        [](const NoiseSource& one) {
          using Error = std::optional<std::optional<double>>;
          return one.process.length > 0.0 ? Error(unless_zero(one.length_error)) : std::nullopt;
        },
        "its standard error, likewise")
        .if_any(),
    field("gain", &NoiseSource::gain, "of this source alone"),
    share(
        "p_adjusted",
        [](const NoiseSource& one) {
          return one.lasts ? std::optional(one.p_value) : std::nullopt;
        },
        "of a process: chance of as much, times the processes tried")
        .if_any());

template <>
inline constexpr auto kDescribed<FittedNoise> =
    described(field("changed", &FittedNoise::changed, "whether it is other than the model states"),
              field("gain", &FittedNoise::gain, "fall of -2 log of the restricted likelihood"),
              field("tried", &FittedNoise::tried, "processes asked of").at_least(0.0),
              field("sources", &FittedNoise::sources, "white ones, then what lasts"))
        .named("noise_estimated");

template <>
inline constexpr auto kDescribed<NoiseShare> =
    described(field("source", &NoiseShare::source, "as in noise_estimated"),
              field("share", &NoiseShare::share, "of the error's mean square"));

template <>
inline constexpr auto kDescribed<NoiseBudget> =
    described(field("horizon_s", &NoiseBudget::horizon, "0: a leg, whatever it takes"),
              field("rms_m", &NoiseBudget::rms,
                    "predicted error of dead reckoning after the horizon"),
              field("windows", &NoiseBudget::windows, "stretches that were reckoned").at_least(0.0),
              field("shares", &NoiseBudget::shares, "the largest first"),
              field(
                  "in_words", [](const NoiseBudget& one) { return in_words(one); }, kInWords))
        .named("noise_budget", kWhatBudget);

template <>
inline constexpr auto kDescribed<RobotConstant> = described(
    field("name", &RobotConstant::name,
          "left wheel, wheelbase, gyro bias, ...; another drive's wheels by their columns"),
    field("old", &RobotConstant::before, "that was in force"),
    field(
        "new",
        [](const RobotConstant& one) {
          return one.determined ? std::optional(one.after) : std::nullopt;
        },
        "null: not determined"),
    field(
        "sd",
        [](const RobotConstant& one) {
          return one.determined ? unless_zero(one.sd) : std::nullopt;
        },
        "standard error of the new one; null: not known"),
    field("unit", &RobotConstant::unit,
          "times: a factor of what the recordings were made with (of a wheel's radius, or of its "
          "travel per tick); else m, rad, s, ..."),
    field("note", &RobotConstant::note, "how it is meant"));

template <>
inline constexpr auto kDescribed<StackValue> =
    described(field("stack", &StackValue::stack, "the program"),
              field("key", &StackValue::key, "its parameter"),
              field("value", &StackValue::value, "in that program's unit"),
              field("multiplies", &StackValue::multiplies,
                    "what is there is to be multiplied by it; else it takes its place"),
              field("note", &StackValue::note, "how it is meant"));

template <>
inline constexpr auto kDescribed<RobotConstants> =
    described(field("constants", &RobotConstants::list,
                    "the robot's own numbers, to paste into its software; empty: none was found"),
              field("stacks", &RobotConstants::stacks,
                    "the same in the words of other programs' configurations"))
        .named("constants");

/// A report, and the robot's constants that were found.
template <typename Result>
struct WithConstants {
  Result report;
  const RobotConstants* constants = nullptr;
};
template <typename Result>
inline constexpr auto kDescribed<WithConstants<Result>> =
    described(keys_of("report", &WithConstants<Result>::report),
              keys_of("constants", &WithConstants<Result>::constants));

}  // namespace trussmap::results
