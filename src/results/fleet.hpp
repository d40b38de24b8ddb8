// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What fleet report and contrast write.
#pragma once

#include "results/common.hpp"
#include "trussmap/fleet.hpp"

#include <optional>

namespace trussmap::results {

/// Nothing of a robot of a single day.
template <auto kMember>
[[nodiscard]] std::optional<double> slope_of(const FleetRobot& one) {
  return one.has_slope ? std::optional(one.*kMember) : std::nullopt;
}
template <>
inline constexpr auto kDescribed<FleetRobot> =
    described(field("robot", &FleetRobot::robot, "its name"),
              field("days", &FleetRobot::days, "of it").at_least(0.0),
              field("value", &FleetRobot::value, "its own"),
              field("sd", &FleetRobot::sd, "its standard error"),
              field("shrunken", &FleetRobot::shrunken, "towards the mean"),
              field("sd_shrunken", &FleetRobot::shrunken_sd, "its standard error"),
              field("differs", &FleetRobot::differs, "from the others, significantly"),
              share("p_differs", &FleetRobot::p_differs, "adjusted"),
              field("drifts", &FleetRobot::drifts, "significantly"),
              field("slope_per_day", slope_of<&FleetRobot::slope>, "its own"),
              field("sd_slope_per_day", slope_of<&FleetRobot::slope_sd>, "its standard error"),
              share("p_drifts", &FleetRobot::p_drifts, "adjusted"));

template <>
inline constexpr auto kDescribed<FleetGroup> =
    described(field("value", &FleetGroup::value, "of the key"),
              field("robots", &FleetGroup::robots, "with it").at_least(0.0),
              field("mean", &FleetGroup::mean, "theirs"),
              field("sd", &FleetGroup::sd, "its standard error").or_null(),
              share("p_value", &FleetGroup::p_value, "that they are as the others"));

template <>
inline constexpr auto kDescribed<FleetKey> =
    described(field("key", &FleetKey::key, "of the metadata"),
              share("p_adjusted", &FleetKey::p_adjusted, "over the keys"),
              field("groups", &FleetKey::groups, "robots with the same value"),
              field("same_as", &FleetKey::same_as, "keys that divide the robots the same way"));

template <>
inline constexpr auto kDescribed<FleetCoefficient> = described(
    field("shape", &FleetCoefficient::shape, "its formula"),
    field("robots", &FleetCoefficient::robots, "that have it").at_least(0.0),
    field("mean", &FleetCoefficient::mean, "over the robots"),
    field("sd", &FleetCoefficient::sd, "its standard error").or_null(),
    share("p_common", &FleetCoefficient::p_common, "that the mean is 0"),
    field("common", &FleetCoefficient::common, "significant"),
    field("tau", &FleetCoefficient::tau, "spread between robots that do not differ"),
    share("p_tau", &FleetCoefficient::p_tau, "that there is none"),
    field("Q", &FleetCoefficient::Q, "Cochran's"),
    field("Q_dof", &FleetCoefficient::Q_dof, "of it").at_least(0.0),
    field("slope_per_day", &FleetCoefficient::slope, "mean of all robots").or_null(),
    field("sd_slope_per_day", &FleetCoefficient::slope_sd, "its standard error").or_null(),
    share("p_slope", &FleetCoefficient::p_slope, "that it is 0"),
    field("all_drift", &FleetCoefficient::all_drift, "significant"),
    field("goes_with", &FleetCoefficient::goes_with, "keys of the metadata that set robots apart"),
    field("each", &FleetCoefficient::members, "the robots, each with its own estimate"));

template <>
inline constexpr auto kDescribed<FleetLookAlike> =
    described(field("effect", &FleetLookAlike::effect, "its name"),
              field("cosine", &FleetLookAlike::cosine, "of both traces"));

template <>
inline constexpr auto kDescribed<FleetFinding> = described(
    field("effect", &FleetFinding::effect, "name, as in the catalogue, or of a formula"),
    field("channel", &FleetFinding::channel, kWhatChannel),
    field("of_model", &FleetFinding::of_model, "the models have it"),
    share("p_adjusted", &FleetFinding::p_adjusted, "over all that was tried"),
    field("coefficients", &FleetFinding::coefficients, "one per shape"),
    field("indistinguishable_from", &FleetFinding::look_alikes, "what would leave the same trace"));

template <>
inline constexpr auto kDescribed<PooledTest> =
    described(field("effect", &PooledTest::effect, "name, as in the catalogue, or of a formula"),
              field("channel", &PooledTest::channel, kWhatChannel),
              field("shape", &PooledTest::shape, kWhatShape),
              field("score", &PooledTest::score, "chi2 that adding it would take away"),
              field("dof", &PooledTest::dof, "of it").at_least(0.0),
              share("p_value", &PooledTest::p_value, "alone"),
              field("coefficients", &PooledTest::coefficients, "over all robots").or_null(),
              field("sd", &PooledTest::sd, "standard errors").or_null());

template <>
inline constexpr auto kDescribed<FleetReport> = described(
    field("robots", &FleetReport::robots, "how many"),
    field("days", &FleetReport::days, "of all robots"), field("chi2", &FleetReport::chi2, "sum"),
    field("dof", &FleetReport::dof, "sum"), share("level", &FleetReport::level, "of significance"),
    field("keys", &FleetReport::keys, "of the metadata, that were tested"),
    field("findings", &FleetReport::findings, "the models' own effects, then what is found"),
    field("pooled_tests", &FleetReport::tests, "of every candidate alone"),
    field("heldout_rms_m", &FleetReport::held_out_rms, "by robot"),
    field("notes", &FleetReport::notes, "in words"));

// ----------------------------------------
// What contrast writes.

template <>
inline constexpr auto kDescribed<RunFigure> = described(
    field("value", &RunFigure::value, "in the figure's unit"),
    field(
        "sd", [](const RunFigure& one) { return unless_zero(one.sd); }, "its standard error"),
    field(
        "dof", [](const RunFigure& one) { return unless_zero(one.dof); }, "of an error"));

template <>
inline constexpr auto kDescribed<FigureChange> = described(
    field("name", &FigureChange::name, "of the figure"),
    field("unit", &FigureChange::unit, "its; empty: a number"),
    field("before", &FigureChange::before, "null: that run does not tell it"),
    field("now", &FigureChange::now, "likewise"),
    field("p_value", &FigureChange::p_value, "that chance alone makes them differ so far"),
    field("changed", &FigureChange::changed, "at the level, over all figures (Holm)"));

template <>
inline constexpr auto kDescribed<RunContrast> =
    described(field("verdict_before", &RunContrast::before, "of the run before"),
              field("verdict_now", &RunContrast::now, "of the run now"),
              share("level", &RunContrast::level, "of significance"),
              field("figures", &RunContrast::figures, "that either run tells"));

}  // namespace trussmap::results
