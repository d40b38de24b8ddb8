// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/page_words.hpp"

#include "plot/fit_charts.hpp"
#include "report/noise_verdict.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/table.hpp"
#include "trussmap/workbench.hpp"
#include "wording/channel_words.hpp"
#include "wording/explanations.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), by);
    at += by.size();
  }
}

std::string channel_unit(const Effect& effect) {
  return std::string(facts_of(effect.channel).unit);
}

}  // namespace

std::string typeset(std::string text) {
  replace_all(text, "+-", "\u00b1");
  replace_all(text, "chi^2", "chi\u00b2");
  replace_all(text, "chi2", "chi\u00b2");
  const std::string degrees = " deg";
  for (std::size_t at = text.find(degrees); at != std::string::npos; at = text.find(degrees, at)) {
    const std::size_t end = at + degrees.size();
    if (end < text.size() && std::isalnum(static_cast<unsigned char>(text[end])) != 0) {
      at = end;
      continue;
    }
    text.replace(at, degrees.size(), "\u00b0");
  }
  return text;
}

std::string distance_text(double metres, double beside) {
  const double larger = std::max(metres, beside);
  if (larger < 0.0995) return two_digits(1000.0 * metres) + " mm";
  if (larger < 0.995) return two_digits(100.0 * metres) + " cm";
  return two_digits(metres) + " m";
}

std::string effect_in_words(const EffectEvidence& effect) {
  const Effect& one = effect.estimate.effect;
  return name_in_words(one) + ": " +
         typeset(size_in_words(one, effect.range.least, effect.range.most));
}

std::string gain_sentence(const Comparison& before, const Comparison& after,
                          const std::string& it) {
  if (before.held_out.legs.empty() || after.held_out.legs.empty()) return "";
  const double off = before.held_out.arrival_rms;
  const double with = after.held_out.arrival_rms;
  return fmt::format("Legs end {} off, {} with {}.{}", distance_text(off, with),
                     distance_text(with, off), it,
                     after.consistent() ? "" : " Something is still unexplained.");
}

std::string trend_variable(const Trend& trend) {
  return trend.against == "all" ? "everything alike" : trend.against;
}

std::string counted_legs(std::size_t legs) {
  return fmt::format("{} leg{}", legs, legs == 1 ? "" : "s");
}

std::string chance_text(double p) {
  return p < 1e-12 ? "below 10\u207b\u00b9\u00b2" : probability_text(p);
}

std::string listed(const std::vector<std::string>& names, const std::string& last) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    text += (k == 0 ? std::string() : k + 1 == names.size() ? " " + last + " " : ", ") + names[k];
  }
  return text;
}

SizeText size_text_of(const EffectEvidence& effect) {
  const Effect& one = effect.estimate.effect;
  if (one.channel == Channel::compass && one.shape.size() == 1 && one.shape[0] == "turn_rate" &&
      one.coefficients.size() == 1) {  // a lag
    constexpr double kMilliseconds = 1000.0;
    const double sd = effect.estimate.sd.empty() ? 0.0 : effect.estimate.sd[0];
    const double lag = kMilliseconds * std::abs(one.coefficients[0]);
    const QuantityText text = quantity_text(lag, kMilliseconds * sd);
    return {(text.error.empty() ? two_digits(lag) : text.value) + " ms",
            text.error.empty() ? "" : text.error + " ms"};
  }
  const wording::ShownUnit unit = wording::shown_unit(channel_unit(one));
  const double least = effect.range.least;
  const double most = effect.range.most;
  const double size = unit.factor * std::max(std::abs(least), std::abs(most));
  double squares = 0.0;
  double errors = 0.0;
  for (std::size_t k = 0; k < one.coefficients.size() && k < effect.estimate.sd.size(); ++k) {
    squares += one.coefficients[k] * one.coefficients[k];
    errors += std::pow(one.coefficients[k] * effect.estimate.sd[k], 2);
  }
  const double sd = squares > 0.0 ? size * std::sqrt(errors) / squares : 0.0;
  const QuantityText text = quantity_text(size, sd);
  const std::string with = (unit.name.starts_with("\u00b0") ? "" : " ") + unit.name;
  const bool both = least * most < 0.0 && std::min(-least, most) > 0.3 * std::max(-least, most);
  return {(both ? "\u00b1" : "") + (text.error.empty() ? two_digits(size) : text.value) + with,
          text.error.empty() ? "" : text.error + with};
}

std::string named_with_size(const EffectEvidence& effect) {
  EffectEvidence roughly = effect;
  roughly.estimate.sd.clear();
  return fmt::format("{} ({})", name_in_words(effect.estimate.effect), size_text_of(roughly).size);
}

std::string named_with_sizes(const std::vector<EffectEvidence>& effects) {
  constexpr std::size_t kShort = 70;  // three lines of a narrow screen, with what it gains
  if (effects.size() == 1) {
    const EffectEvidence& only = effects.front();
    const std::string text = fmt::format(
        "{} \u2013 {}", name_in_words(only.estimate.effect),
        typeset(size_in_words(only.estimate.effect, only.range.least, only.range.most)));
    return text.size() <= kShort ? text : named_with_size(only);
  }
  std::vector<std::string> names;
  names.reserve(effects.size());
  for (const EffectEvidence& one : effects) {
    names.push_back(named_with_size(one));
  }
  return listed(names);
}

bool is_hardly_seen(const EffectEstimate& fitted) {
  constexpr double kClear = 2.0;  // standard errors
  for (std::size_t k = 0; k < fitted.sd.size(); ++k) {
    if (std::abs(fitted.effect.coefficients.at(k)) > kClear * fitted.sd[k]) return false;
  }
  return !fitted.sd.empty();
}

namespace {

const char* doubt_of(const EffectEstimate& fitted) {
  return is_hardly_seen(fitted) ? "; beside the others it is hardly seen" : "";
}

}  // namespace

std::string how_large(const EffectEvidence& effect) {
  constexpr std::size_t kMostCoefficients = 3;
  const EffectEstimate& fitted = effect.estimate;
  const std::size_t count = fitted.effect.coefficients.size();
  if (count == 0 || count > kMostCoefficients || fitted.sd.size() != count) {
    return sized_in_words(effect);
  }
  return fmt::format("{}: {}{}.", capitalised(name_in_words(fitted.effect)),
                     typeset(in_words(fitted.effect, fitted.sd)), doubt_of(fitted));
}

std::string sized_in_words(const EffectEvidence& effect) {
  const SizeText size = size_text_of(effect);
  const std::string text = capitalised(effect_in_words(effect));
  if (size.error.empty()) return text + ".";
  return fmt::format("{} ({}, standard error {}){}.", text, size.size, size.error,
                     doubt_of(effect.estimate));
}

std::string advised_drive(const Advice& advice) {
  if (advice.drive.empty()) return "A drive that would show more: " + in_words(advice) + ".";
  return fmt::format("A drive that would show more: {} ({}: {}).", advice.drive, advice.lack,
                     advice.why);
}

std::string sure_text(double p, std::size_t tests) {
  const std::string chance = p < 1e-6   ? "less than one in a million"
                             : p < 0.01 ? fmt::format("one in {:.0f}", 1.0 / p)
                                        : fmt::format("{:.2g} %", 100.0 * p);
  return fmt::format(
      "If nothing were missing, noise alone would show as much with a probability of {} (adjusted "
      "for {} tests).",
      chance, tests);
}

std::string capitalised(std::string text) {
  if (!text.empty()) {
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  }
  return text;
}

std::string what_it_is(const Effect& effect) {
  const std::string name = capitalised(name_in_words(effect));
  const Explanation explained = explanation_of(effect);
  if (explained.unusual)
    return fmt::format("{}, not with its usual sign: {}", name, explained.does);
  const CatalogueEntry* entry = find_entry(effect.name);
  return fmt::format("{}{}.", name, entry == nullptr ? "" : ": " + std::string(entry->cause));
}

std::string what_helps(const Effect& effect) {
  const CatalogueEntry* entry = wording::usual_entry(effect);
  if (entry == nullptr) return "";
  return fmt::format("Against {} for good: {}.", short_name(effect), entry->remedy);
}

std::vector<std::string> unseen_names(const Diagnosis& diagnosis) {
  constexpr std::size_t kMost = 5;
  std::vector<std::string> names;
  for (const Unobservable& one : diagnosis.unobservable) {
    if (names.size() == kMost) break;
    names.push_back(name_in_words(one.effect));
  }
  if (diagnosis.unobservable.size() > kMost) {
    names.push_back(fmt::format("{} more", diagnosis.unobservable.size() - kMost));
  }
  return names;
}

std::string with_judged(const std::string& verdict, const UsedSightings& sightings) {
  const std::string by = in_words(sightings);
  return by.empty() ? verdict : verdict + " " + capitalised(by) + ".";
}

void shorten(std::vector<std::string>& names) {
  constexpr std::size_t kMost = 3;
  if (names.size() <= kMost + 1) return;  // "1 more" is no shorter
  const std::size_t more = names.size() - kMost;
  names.resize(kMost);
  names.push_back(fmt::format("{} more", more));
}

std::string rivals_note(const Effect& effect, const std::vector<LookAlike>& rivals) {
  if (rivals.empty()) {
    return fmt::format("Nothing else in the catalogue looks like {} in these recordings.",
                       short_name(effect));
  }
  std::vector<std::string> names, apart;
  double nearest = std::numeric_limits<double>::infinity();
  for (const LookAlike& rival : rivals) {
    if (rival.told_apart()) {
      apart.push_back(name_in_words(rival.effect));
      nearest = std::min(nearest, rival.behind);
      continue;
    }
    const CatalogueEntry* entry = wording::usual_entry(rival.effect);
    names.push_back(name_in_words(rival.effect) +
                    (entry == nullptr ? "" : " (" + std::string(entry->cause) + ")"));
  }
  const std::size_t aparts = apart.size();
  shorten(names);
  shorten(apart);
  std::string open =
      names.empty() ? std::string()
                    : fmt::format("Instead of {} it could be {}: these recordings cannot tell.",
                                  short_name(effect), listed(names, "or"));
  if (apart.empty()) return open;
  const std::string told = fmt::format(
      "{} look{} much like it, but all measurements together tell {} apart (chi\u00b2 {}{:.0f} "
      "behind).",
      capitalised(listed(apart)), aparts == 1 ? "s" : "", aparts == 1 ? "it" : "them",
      aparts == 1 ? "" : "at least ", nearest);
  return open.empty() ? told : open + " " + told;
}

std::string faultless_verdict(const Diagnosis& diagnosis, const std::string& off) {
  std::string slight;
  if (is_slight_misfit(diagnosis)) {
    slight = fmt::format(
        " A slight misfit is left, as much as noise alone makes in one of {:.0f} recordings.",
        1.0 / diagnosis.p_value);
  }
  if (noise_is_wrong(diagnosis)) {
    return fmt::format("The noise is not as the model states it: {}. No effect is missing.{}",
                       found_and_stated(diagnosis.under->noise), slight);
  }
  return fmt::format("Nothing is missing: none of {} changes tried explains more than chance.{}{}",
                     diagnosis.tried, off, slight);
}

std::vector<std::string> others_notes(const Diagnosis& diagnosis, const std::string& who_states) {
  std::vector<std::string> notes;
  if (noise_is_wrong(diagnosis)) {
    notes.push_back(
        fmt::format("The noise is not as the model states it: {}. All is judged by the "
                    "noise as estimated; {}.",
                    typeset(in_words(diagnosis.under->noise)), who_states));
  }
  for (const NoiseTest& one : diagnosis.noise) {
    if (one.p_adjusted >= diagnosis.level || !notes.empty()) continue;
    notes.push_back(
        fmt::format("More noise than the model states ({}): {}.", one.law, typeset(in_words(one))));
    break;
  }
  for (const EventTest& one : diagnosis.events) {
    if (one.p_adjusted >= diagnosis.level) continue;
    notes.push_back(fmt::format("A single event stands out: {}.", typeset(in_words(one))));
    break;
  }
  return notes;
}

}  // namespace trussmap::report
