// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/robot_off.hpp"

#include "geometry/units.hpp"
#include "report/page_words.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

/// What noise alone would leave, whose noise that is, and whether the model explains the rest: with
/// something unexplained nothing is as good as noise allows.
struct Floor {
  double rms = 0.0;  ///< m
  std::string noise;
  bool explained = true;
};

std::string floor_text(const HeldOut& held_out, const Floor& floor, double beside) {
  if (!(floor.rms > 0.0)) return "";
  const std::string size = distance_text(floor.rms, beside);
  return floor.explained && as_good_as_noise(held_out, floor.rms)
             ? fmt::format(", as good as {} allows ({})", floor.noise, size)
             : fmt::format("; noise alone would leave {}", size);
}

std::string leg_sentence(const HeldOut& before, const HeldOut* after, const std::string& with,
                         const Floor& floor) {
  if (before.legs.empty()) return "After a leg: unknown, no leg could be held out.";
  const double off = before.arrival_rms;
  const std::string head = fmt::format(
      "After a leg (root mean square of {} that no fit has seen): ", before.legs.size());
  if (after == nullptr || after->legs.empty()) {
    return head + distance_text(off) + floor_text(before, floor, off) + ".";
  }
  return fmt::format("{}{} as given, {} {}{}.", head, distance_text(off, after->arrival_rms),
                     distance_text(after->arrival_rms, off), with, floor_text(*after, floor, off));
}

/// The longest horizon that both have.
std::string reckoned_sentence(const ModelEvidence& before, const ModelEvidence* after,
                              const std::string& with) {
  for (auto one = before.reckoned.rbegin(); one != before.reckoned.rend(); ++one) {
    const std::string head = fmt::format("After {:g} s of dead reckoning: ", one->horizon);
    if (after == nullptr) return head + distance_text(one->rms) + ".";
    const auto same =
        std::find_if(after->reckoned.begin(), after->reckoned.end(),
                     [&one](const ReckonedError& other) { return other.horizon == one->horizon; });
    if (same == after->reckoned.end()) continue;
    return fmt::format("{}{} as given, {} {}.", head, distance_text(one->rms, same->rms),
                       distance_text(same->rms, one->rms), with);
  }
  return "After a tour: unknown, these recordings are too short to judge dead reckoning by.";
}

std::vector<std::string> sentences(const ModelEvidence& before, const ModelEvidence* after,
                                   const std::string& with, const Floor& floor) {
  std::vector<std::string> result{
      leg_sentence(before.comparison.held_out,
                   after == nullptr ? nullptr : &after->comparison.held_out, with, floor),
      reckoned_sentence(before, after, with)};
  if (after == nullptr) return result;
  const auto gain = local_gain(before.comparison.held_out, after->comparison.held_out);
  if (gain) result.push_back(fmt::format("The gain is local: {}.", gain_in_words(*gain)));
  return result;
}

}  // namespace

bool as_good_as_noise(const HeldOut& held_out, double floor) {
  constexpr double kErrors = 3.0;
  if (held_out.legs.empty() || !(floor > 0.0)) return false;
  // Two coordinates of n legs: the root mean square is uncertain by one in 2 sqrt(n).
  const double error = 0.5 / std::sqrt(static_cast<double>(held_out.legs.size()));
  return std::abs(held_out.arrival_rms - floor) <= kErrors * error * floor;
}

bool as_good_as_noise(const HeldOut& held_out) {
  return as_good_as_noise(held_out, held_out.expected_rms);
}

double noise_floor(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence) {
  const double found = evidence.given.comparison.held_out.expected_rms;
  if (diagnosis.verdict != Diagnosis::Verdict::missing || !evidence.as_stated) return found;
  const double stated = evidence.as_stated->expected_rms;
  return stated > 0.0 ? std::min(found, stated) : found;
}

std::optional<LocalGain> local_gain(const HeldOut& before, const HeldOut& after) {
  constexpr double kLeast = 1e-3;   // m
  constexpr double kHardly = 0.5;   // of what noise makes of a leg
  constexpr double kNoGain = 0.95;  // of the error before
  if (before.legs.empty() || before.legs.size() != after.legs.size()) return std::nullopt;
  if (after.arrival_rms > kNoGain * before.arrival_rms) return std::nullopt;
  LocalGain gain;
  gain.legs = before.legs.size();
  for (std::size_t k = 0; k < gain.legs; ++k) {
    const LegPrediction& one = before.legs[k];
    const LegPrediction& other = after.legs[k];
    if (one.leg != other.leg) return std::nullopt;
    const double off = one.arrival_error.norm();
    const double now = other.arrival_error.norm();
    if (std::abs(off - now) <= std::max(kLeast, kHardly * other.expected_error)) ++gain.unchanged;
    if (off > gain.worst_before) {
      gain.worst_before = off;
      gain.worst_after = now;
    }
  }
  const bool improved = gain.worst_after < gain.worst_before;
  return 2 * gain.unchanged > gain.legs && improved ? std::optional(gain) : std::nullopt;
}

std::string gain_in_words(const LocalGain& gain) {
  return fmt::format("{} of {} legs unchanged, the worst {:.0f} \u2192 {:.0f} mm", gain.unchanged,
                     gain.legs, geometry::kMillimetres * gain.worst_before,
                     geometry::kMillimetres * gain.worst_after);
}

std::vector<std::string> off_sentences(const ModelEvidence& before, const std::string& noise) {
  return sentences(
      before, nullptr, "",
      {before.comparison.held_out.expected_rms, noise, before.comparison.consistent()});
}

std::vector<std::string> off_sentences(const ModelEvidence& before, const ModelEvidence& after,
                                       const std::string& with, double floor,
                                       const std::string& noise) {
  return sentences(before, &after, with, {floor, noise, after.comparison.consistent()});
}

}  // namespace trussmap::report
