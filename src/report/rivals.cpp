// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/rivals.hpp"

#include "geometry/units.hpp"
#include "report/page_words.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

constexpr std::size_t kMostNamed = 5;  // of one effect and its rivals, in a headline

/// The effects that a lack hides; none: more than can be listed.
std::vector<std::string> hidden_by(Lack lack) {
  switch (lack) {
    case Lack::positions:
      return {"travel scale", "compass offset", "loss per start"};
    case Lack::headings:
      return {"hard iron", "soft iron", "slope"};
    case Lack::turning_sense:
      return {"wheelbase", "turn asymmetry"};
    case Lack::leg_lengths:
      return {"travel scale", "loss per start"};
    case Lack::speeds:
      return {"travel scale", "slip with speed"};
    case Lack::spin_rates:
      return {"wheelbase", "turn scrub"};
    case Lack::rests:
      return {"heading drift", "wheel diameter ratio"};
    case Lack::compass:
    case Lack::covariate_range:
    case Lack::revisits:
      break;
  }
  return {};
}

bool is_ruled_out(const Diagnosis& diagnosis, const std::string& name) {
  return std::any_of(diagnosis.findings.begin(), diagnosis.findings.end(),
                     [&name](const Finding& one) {
                       return one.effect.name == name && one.status == Status::absent;
                     });
}

}  // namespace

std::vector<NearRival> near_rivals(const Diagnosis& diagnosis, const Finding& first) {
  constexpr double kNear = 1e-3;  // m
  std::vector<NearRival> near;
  if (diagnosis.held_out.legs.empty()) return near;
  const double gain = diagnosis.held_out.arrival_rms - first.held_out.arrival_rms;
  std::vector<std::string> names{name_in_words(first.effect)};
  for (const LookAlike& one : first.look_alikes) names.push_back(name_in_words(one.effect));
  for (const Finding* one : found_by(diagnosis)) names.push_back(name_in_words(one->effect));
  for (const Finding& one : diagnosis.findings) {
    const double apart = one.held_out.arrival_rms - first.held_out.arrival_rms;
    const double saves = diagnosis.held_out.arrival_rms - one.held_out.arrival_rms;
    if (std::abs(apart) > kNear || !(saves > 0.5 * gain)) continue;
    const std::string name = name_in_words(one.effect);
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    names.push_back(name);
    near.push_back({&one, first.score - one.score});
  }
  return near;
}

std::vector<std::string> rival_sentences(const Effect& effect, const std::vector<LookAlike>& alike,
                                         const std::vector<NearRival>& near) {
  std::vector<std::string> sentences;
  if (!alike.empty() || near.empty()) sentences.push_back(rivals_note(effect, alike));
  if (near.empty()) return sentences;
  constexpr double kBehind = 1.0;  // of chi^2
  std::vector<std::string> behind, level;
  for (const NearRival& one : near) {
    const std::string legs =
        fmt::format("{} ({:.1f} mm", name_in_words(one.finding->effect),
                    geometry::kMillimetres * one.finding->held_out.arrival_rms);
    if (one.behind < kBehind) {
      level.push_back(legs + ")");
    } else {
      behind.push_back(fmt::format("{}; chi\u00b2 {:.0f} behind)", legs, one.behind));
    }
  }
  shorten(behind);
  shorten(level);
  if (!behind.empty()) {
    sentences.push_back(fmt::format(
        "Within a millimetre of {} on held-out legs: {}. All measurements together speak for {}.",
        short_name(effect), listed(behind), short_name(effect)));
  }
  if (!level.empty()) {
    sentences.push_back(fmt::format(
        "By itself as much as {} explains: {}. The sum of all that was measured decided.",
        short_name(effect), listed(level)));
  }
  return sentences;
}

std::string named_with_rivals(const std::vector<EffectEvidence>& effects,
                              const std::vector<std::vector<LookAlike>>& alike) {
  const bool rivals = std::any_of(alike.begin(), alike.end(),
                                  [](const auto& one) { return closest_rival(one) != nullptr; });
  if (!rivals) return named_with_sizes(effects);
  std::string text;
  std::size_t hardly = 0;
  for (std::size_t k = 0; k < effects.size(); ++k) {
    if (k > 0 && is_hardly_seen(effects[k].estimate)) {
      ++hardly;
      continue;
    }
    if (k > 0) text += "; and ";
    text += named_with_size(effects[k]);
    std::vector<std::string> names{name_in_words(effects[k].estimate.effect)};
    for (std::size_t i = 0; k < alike.size() && i < alike[k].size(); ++i) {
      if (alike[k][i].told_apart()) continue;
      const std::string name = name_in_words(alike[k][i].effect);
      if (std::find(names.begin(), names.end(), name) != names.end()) continue;
      names.push_back(name);
      if (names.size() <= kMostNamed) text += ", or " + name;
    }
    if (names.size() > kMostNamed) {
      text += fmt::format(", or {} more", names.size() - kMostNamed);
    }
  }
  if (hardly > 0) text += fmt::format("; and {} hardly seen beside it", hardly);
  return text;
}

std::optional<DataLack> lack_to_mend(const Diagnosis& diagnosis) {
  for (const DataLack& lack : diagnosis.lacks) {
    const std::vector<std::string> hidden = hidden_by(lack.what);
    const bool helps = hidden.empty() || !std::all_of(hidden.begin(), hidden.end(),
                                                      [&diagnosis](const std::string& name) {
                                                        return is_ruled_out(diagnosis, name);
                                                      });
    if (helps) return lack;
  }
  return std::nullopt;
}

std::string drive_that_shows_more(const Diagnosis& diagnosis) {
  if (const std::optional<DataLack> lack = lack_to_mend(diagnosis)) {
    return advised_drive(advice_on(*lack));
  }
  for (const Unobservable& one : diagnosis.unobservable) {
    const Advice advice = advice_on(one);
    if (advice.drive.empty()) continue;
    return fmt::format("To see {} as well: {} ({}).", name_in_words(one.effect), advice.drive,
                       advice.why);
  }
  return "";
}

}  // namespace trussmap::report
