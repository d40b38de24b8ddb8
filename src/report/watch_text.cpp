// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <cmath>

#include <fmt/format.h>

namespace trussmap {
namespace {

/// "left wheel (cosine 0.97), wheelbase (-0.95)".
std::string look_alikes_of(const FoundEffect& found) {
  std::string text;
  for (const MonitorLookAlike& one : found.look_alikes) {
    text += fmt::format("{}{} (cosine {:.2f}, {:.0f} % of the evidence)", text.empty() ? "" : ", ",
                        one.name, one.cosine, 100.0 * one.share);
  }
  return text.empty() ? "none of the effects watched" : text;
}

/// "leg 101", "leg 98 to 103".
std::string legs_between(const FoundEffect& found) {
  if (found.earliest == found.latest) return fmt::format("leg {}", found.leg);
  return fmt::format("leg {} (between {} and {})", found.leg, found.earliest, found.latest);
}

}  // namespace

std::string watch_text(const Watch& result, double rate, TextStyle style) {
  const MonitorReport& last = result.last;
  const std::string driven =
      fmt::format("{} {} in {:.2f} h", last.legs, last.legs == 1 ? "leg" : "legs", last.hours);
  if (!result.alarm) {
    return verdict_text(Mood::good,
                        fmt::format("model held: {}, evidence of a change {} (1 gives an alarm, "
                                    "falsely {} times an hour at most)",
                                    driven, two_digits(last.evidence), two_digits(rate)),
                        style) +
           "\n";
  }
  const FoundEffect& found = result.found ? *result.found : *result.alarm->found;
  std::string text = verdict_text(Mood::bad,
                                  fmt::format("model ceased to hold: {}, since t = {:.1f} s",
                                              name_in_words(found.effect), result.since_t),
                                  style) +
                     "\n\n";
  const auto line = [&text](const char* name, const std::string& value) {
    text += shortened_words(fmt::format("  {:<11} {}\n", name, value));
  };
  line("announced", fmt::format("at the end of leg {}, t = {:.1f} s: {}", result.alarm->legs,
                                result.alarm_t, name_in_words(result.alarm->found->effect)));
  line("began", legs_between(found));
  line("size", in_words(found.effect, {found.sd}));
  line("looks like", look_alikes_of(found));
  line("watched", fmt::format("{}; {} false alarms an hour at most", driven, two_digits(rate)));
  return text;
}

}  // namespace trussmap
