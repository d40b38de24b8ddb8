// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What reveal writes, and which effects a simulation has.
#pragma once

#include "results/common.hpp"
#include "trussmap/simulated_recording.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::results {

/// An effect that a simulated robot has.
struct SimulatedEffect {
  const Effect* effect = nullptr;
};
template <auto kMember>
inline constexpr auto kSimulated =
    [](const SimulatedEffect& one) { return std::invoke(kMember, *one.effect); };
template <>
inline constexpr auto kDescribed<SimulatedEffect> = described(
    field("name", kSimulated<&Effect::name>, "name, as in the catalogue, or of a formula"),
    field("channel", kSimulated<&Effect::channel>, kWhatChannel),
    field("shape", kSimulated<shape_texts>, kWhatShape),
    field("coefficients", kSimulated<&Effect::coefficients>));

[[nodiscard]] inline std::vector<SimulatedEffect> simulated_effects(
    const std::vector<Effect>& effects) {
  std::vector<SimulatedEffect> all;
  for (const Effect& one : effects) all.push_back({&one});
  return all;
}

/// What simulate says.
struct SimulationReport {
  const SimulationSettings* settings = nullptr;
  const SimulatedRecording* made = nullptr;
  std::string folder;
  std::vector<std::string> rough;
};
template <auto kMember>
inline constexpr auto kSetting =
    [](const SimulationReport& one) { return std::invoke(kMember, *one.settings); };
template <auto kList>
[[nodiscard]] std::size_t count_of(const SimulationReport& one) {
  return (one.made->drive.recording.*kList).size();
}
template <>
inline constexpr auto kDescribed<SimulationReport> = described(
    field("recording", &SimulationReport::folder, "its folder"),
    field("mesh", kSetting<&SimulationSettings::mesh>, "columns x rows"),
    field("drive", kSetting<&SimulationSettings::drive>, "the wheels"),
    field("walk", kSetting<&SimulationSettings::walk>, "how it tours"),
    field("tours", kSetting<&SimulationSettings::tours>).at_least(0.0),
    field("seed", kSetting<&SimulationSettings::seed>, "of all that is drawn"),
    field("landmarks", [](const SimulationReport& one) { return one.made->mesh.landmarks(); })
        .at_least(0.0),
    field("routes", [](const SimulationReport& one) { return one.made->mesh.routes.size(); }),
    field("legs",
          [](const SimulationReport& one) { return one.made->drive.motion.stops.size() - 1; }),
    field(
        "rows", [](const SimulationReport& one) { return one.made->drive.motion.rows.size(); },
        "of drive.csv"),
    field("sightings", count_of<&Recording::sightings>),
    field("fixes", count_of<&Recording::fixes>), field("loops", count_of<&Recording::loops>),
    field(
        "length_m", [](const SimulationReport& one) { return one.made->length(); }, "of the path"),
    field(
        "duration_s",
        [](const SimulationReport& one) { return one.made->drive.motion.rows.back().t; },
        "of the drive"),
    field(
        "compass",
        [](const SimulationReport& one) { return one.made->drive.recording.drive.has_compass(); },
        "has one"),
    field(
        "gyro",
        [](const SimulationReport& one) { return one.made->drive.recording.drive.has_gyro(); },
        "has one"),
    field("surveyed", count_of<&Recording::survey>, "landmarks"),
    field("rough", &SimulationReport::rough, "kinds of noise that the model does not state"),
    field(
        "effects",
        [](const SimulationReport& one) {
          return one.settings->hide ? std::nullopt
                                    : std::optional(simulated_effects(one.made->effects));
        },
        "not with --hide")
        .if_any());

[[nodiscard]] inline const char* outcome_of(const ScoredEffect& one) {
  switch (one.outcome) {
    case ScoredEffect::Outcome::found:
      return "found";
    case ScoredEffect::Outcome::missed:
      return "missed";
    case ScoredEffect::Outcome::false_alarm:
      break;
  }
  return "false";
}
template <auto kMember>
[[nodiscard]] std::optional<std::vector<double>> coefficients_in(const ScoredEffect& one) {
  return one.*kMember ? std::optional((one.*kMember)->coefficients) : std::nullopt;
}
template <>
inline constexpr auto kDescribed<ScoredEffect> = described(
    keys_of("effect",
            [](const ScoredEffect& one) -> const Effect& {
              return one.truth ? *one.truth : *one.estimate;
            }),
    field("outcome", outcome_of).one_of("found | missed | false"),
    field("truth", coefficients_in<&ScoredEffect::truth>,
          "coefficients; null where it does not act"),
    field("estimate", coefficients_in<&ScoredEffect::estimate>,
          "the model's; null where it has none"),
    field("sd", &ScoredEffect::sd, "standard errors by this recording").or_null(),
    field("z", &ScoredEffect::z,
          "(estimate - truth) / sd; null without an sd; places and thresholds have no part in it")
        .or_null());

template <>
inline constexpr auto kDescribed<AnswerScore> = described(
    field("found", &AnswerScore::found, "true effects that the model has").at_least(0.0),
    field("missed", &AnswerScore::missed, "those that it lacks").at_least(0.0),
    field("false", &AnswerScore::false_alarms, "its effects that do not act").at_least(0.0),
    field("effects", &AnswerScore::effects));

/// What reveal says.
struct Revealed {
  std::uint64_t seed = 0;
  const std::vector<Effect>* effects = nullptr;
  std::optional<AnswerScore> score = std::nullopt;
};
template <>
inline constexpr auto kDescribed<Revealed> =
    described(field("seed", &Revealed::seed, "it was drawn by"),
              field("effects", [](const Revealed& one) { return simulated_effects(*one.effects); }),
              field("score", &Revealed::score, "of --model").if_any());

}  // namespace trussmap::results
