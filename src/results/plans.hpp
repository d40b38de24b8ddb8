// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What plan says.
#pragma once

#include "results/common.hpp"
#include "trussmap/session.hpp"

#include <optional>
#include <string>
#include <vector>

namespace trussmap::results {

template <>
inline constexpr auto kDescribed<PlannedPair> = described(
    field("truth", through(&PlannedPair::truth, &Effect::name), "the effect that is there"),
    field("coefficients", through(&PlannedPair::truth, &Effect::coefficients),
          "its, as the recordings give them"),
    field("rival", through(&PlannedPair::rival, &Effect::name), "what is fitted in its place"),
    field("lambda_before", &PlannedPair::before,
          "by what chi2 grows then on average, of the recordings alone")
        .at_least(0.0),
    field("lambda", &PlannedPair::after, "with the drive").at_least(0.0),
    share("power_before", &PlannedPair::power_before,
          "chance that a diagnosis of the recordings tells them apart"),
    share("power", &PlannedPair::power, "with the drive"),
    field("beyond", &PlannedPair::beyond, "no drive on these routes tells them apart"));

template <>
inline constexpr auto kDescribed<PlannedEffect> = described(
    field("name", through(&PlannedEffect::effect, &Effect::name), "as in the catalogue"),
    field("channel", through(&PlannedEffect::effect, &Effect::channel), kWhatChannel),
    field("practical_size", &PlannedEffect::size, "largest |g|, in the channel's unit")
        .at_least(0.0),
    field("lambda", &PlannedEffect::lambda, "noncentrality of its test at that size").at_least(0.0),
    share("power", &PlannedEffect::power, "chance that the test names it"),
    field("beyond", &PlannedEffect::beyond, "no drive on these routes shows it"));

template <>
inline constexpr auto kDescribed<InstrumentWorth> = described(
    field("instrument", [](const InstrumentWorth& one) { return name_of(one.instrument); })
        .one_of("compass | gyro | range sensor | one measured distance | survey | truth"),
    field("there", &InstrumentWorth::there, "the robot has it already"),
    field("lambda_factor", &InstrumentWorth::factor,
          "of the lambda that is least for what is wished")
        .at_least(0.0)
        .or_null(),
    field("tells_beyond", &InstrumentWorth::tells, "of what no drive tells, how much it would")
        .at_least(0.0));

template <>
inline constexpr auto kDescribed<Waypoint> = described(
    field("landmark", &Waypoint::landmark, "its name"),
    field(
        "x_m", [](const Waypoint& one) { return one.place.x(); }, "map frame"),
    field(
        "y_m", [](const Waypoint& one) { return one.place.y(); }, "map frame"),
    field("heading_rad", &Waypoint::heading, "as the robot leaves; at the last as it comes"),
    field("speed_m_s", &Waypoint::speed, "on the way to it; 0 at the first").at_least(0.0),
    field("bend_rad", &Waypoint::bend, "turned on the way to it, + to the left"),
    field("turn_rad", &Waypoint::turn, "on the spot, whole turns included, + to the left"),
    field("turn_rate_rad_s", &Waypoint::turn_rate, "of that").at_least(0.0),
    field("stop_s", &Waypoint::stop, "that it stands there before").at_least(0.0),
    field("loads", &Waypoint::loads, "as plan.loads, from there on"));

/// What plan says, and what it did with the recordings.
struct PlanReport {
  const PlannedDrive* drive = nullptr;
  const std::vector<std::string>* notes = nullptr;
};
template <auto kMember>
inline constexpr auto kPlanned =
    [](const PlanReport& one) -> decltype(auto) { return std::invoke(kMember, *one.drive); };
template <>
inline constexpr auto kDescribed<PlanReport> = described(
    field("verdict",
          [](const PlanReport& one) {
            if (one.drive->plan.waypoints.empty()) return "no drive";
            return one.drive->enough ? "enough" : "short";
          })
        .one_of("enough | short | no drive"),
    field("length_m", kPlanned<&PlannedDrive::length>, "of the drive").at_least(0.0),
    field("duration_s", kPlanned<&PlannedDrive::duration>, "turning and standing included")
        .at_least(0.0),
    share("power", kPlanned<&PlannedDrive::power>, "predicted, the least of what a drive tells"),
    share("power_wished", through(&PlanReport::drive, &PlannedDrive::options, &PlanOptions::power)),
    share("level", through(&PlanReport::drive, &PlannedDrive::options, &PlanOptions::level),
          "chance that a wrong rival is preferred"),
    field("pairs", kPlanned<&PlannedDrive::pairs>, "of rivals"),
    field("effects", kPlanned<&PlannedDrive::effects>, "of an acceptance test"),
    field(
        "loads",
        [](const PlanReport& one) -> const std::vector<std::string>& {
          return one.drive->plan.loads;
        },
        "columns that the driver sets"),
    field(
        "waypoints",
        [](const PlanReport& one) -> const std::vector<Waypoint>& {
          return one.drive->plan.waypoints;
        },
        "in the order driven"),
    field("instruments", kPlanned<&PlannedDrive::worth>,
          "what each would change on the same drive, the most useful first"),
    field(
        "notes",
        [](const PlanReport& one) -> const std::vector<std::string>& { return *one.notes; },
        kOwnNotes));

}  // namespace trussmap::results
