// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What watch writes.
#pragma once

#include "results/common.hpp"
#include "trussmap/monitor.hpp"

#include <optional>

namespace trussmap::results {

template <>
inline constexpr auto kDescribed<MonitorLookAlike> = described(
    field("effect", &MonitorLookAlike::name, "its name"),
    field("cosine", &MonitorLookAlike::cosine, "between what both add to the innovations"),
    share("share", &MonitorLookAlike::share, "of the evidence"));

template <>
inline constexpr auto kDescribed<FoundEffect> =
    described(
        keys_of("sized",
                [](const FoundEffect& one) {
                  return ConstantEffect{&one.effect, one.sd};
                }),
        share("share", &FoundEffect::share, "of the evidence"),
        field("leg", &FoundEffect::leg, "the first leg with it, the likeliest one").at_least(1.0),
        field("earliest_leg", &FoundEffect::earliest,
              "it began between these two, as far as 90 % of the evidence goes")
            .at_least(1.0),
        field("latest_leg", &FoundEffect::latest, "likewise").at_least(1.0),
        field("indistinguishable_from", &FoundEffect::look_alikes, "effects that look the same"))
        .named("watch_found");

template <>
inline constexpr auto kDescribed<WatchedLeg> =
    described(field("leg", &WatchedLeg::leg, "its number, from 1").at_least(1.0),
              field("t", &WatchedLeg::t, "s, at its end"),
              field("end", &WatchedLeg::end, "the landmark; empty by a fix or a truth row"),
              field("evidence", &WatchedLeg::evidence, "of a change, after it").at_least(0.0));

/// The first alarm, as it was given.
struct FirstAlarm {
  const MonitorReport* report = nullptr;
  double t = 0.0;  ///< s
};
template <>
inline constexpr auto kDescribed<FirstAlarm> = described(
    field("leg", through(&FirstAlarm::report, &MonitorReport::legs), "at the end of which it came")
        .at_least(1.0),
    field("t", &FirstAlarm::t, "s"),
    field("found", [](const FirstAlarm& one) { return *one.report->found; }));

/// What watch says.
struct WatchReport {
  const Watch* watch = nullptr;
  double false_alarms_per_hour = 0.0;
};
template <auto kMember>
inline constexpr auto kWatched =
    [](const WatchReport& one) -> decltype(auto) { return std::invoke(kMember, *one.watch); };
template <auto kMember>
inline constexpr auto kLast = through(&WatchReport::watch, &Watch::last, kMember);

template <>
inline constexpr auto kDescribed<WatchReport> = described(
    field("verdict",
          [](const WatchReport& one) { return one.watch->alarm ? "alarm" : "model held"; })
        .one_of("model held | alarm"),
    field("legs", kLast<&MonitorReport::legs>, "watched").at_least(0.0),
    field("hours", kLast<&MonitorReport::hours>, "of driving").at_least(0.0),
    field("evidence", kLast<&MonitorReport::evidence>,
          "of a change, after the last leg; 1 gives an alarm")
        .at_least(0.0),
    field("false_alarms_per_hour", &WatchReport::false_alarms_per_hour,
          "at most, whenever one looks"),
    field(
        "alarm",
        [](const WatchReport& one) {
          return one.watch->alarm
                     ? std::optional(FirstAlarm{&*one.watch->alarm, one.watch->alarm_t})
                     : std::nullopt;
        },
        "the first one, as it was given")
        .if_any(),
    field(
        "since_t",
        [](const WatchReport& one) {
          return one.watch->alarm ? std::optional(one.watch->since_t) : std::nullopt;
        },
        "s, where the first leg with the effect begins")
        .if_any(),
    field("found", kWatched<&Watch::found>,
          "what most of the evidence is for 50 legs after the alarm, or at the end; absent without "
          "an alarm")
        .if_any(),
    field("passed_over", kWatched<&Watch::passed_over>, "sightings by a range or a bearing alone")
        .at_least(0.0),
    field("each_leg", kWatched<&Watch::legs>, "the evidence after each leg"));

}  // namespace trussmap::results
