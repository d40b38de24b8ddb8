// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/diagnosis_tables.hpp"

#include "effects/channel_physics.hpp"
#include "plot/fit_charts.hpp"
#include "report/fit_sections.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/table.hpp"
#include "wording/effect_words.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace trussmap {
namespace {

constexpr std::size_t kEventRows = 8;
constexpr double kSignificant = 0.05;

enum class EffectPart { wheels, turning, floor, compass, sighting };
constexpr std::array kEffectParts{EffectPart::wheels, EffectPart::turning, EffectPart::floor,
                                  EffectPart::compass, EffectPart::sighting};

const char* name_of(EffectPart part) {
  constexpr std::array kNames{"wheels", "turning", "floor", "compass", "sighting"};
  return kNames.at(static_cast<std::size_t>(part));
}

bool speaks_of(const Effect& effect, std::initializer_list<const char*> names) {
  return std::any_of(effect.shape.begin(), effect.shape.end(), [&](const Shape& shape) {
    return std::any_of(names.begin(), names.end(),
                       [&](const char* name) { return shape.speaks_of(name); });
  });
}

EffectPart part_of(const Effect& effect) {
  switch (acts_on(effect.channel)) {
    case ActsOn::readings:
      return EffectPart::compass;
    case ActsOn::views:
      return EffectPart::sighting;
    case ActsOn::drives:
      break;
  }
  if (effect.channel == Channel::creep || speaks_of(effect, {"x", "y", "heading"})) {
    return EffectPart::floor;
  }
  const bool turns = effect.channel == Channel::turn || effect.channel == Channel::drift ||
                     effect.channel == Channel::rotate;
  return turns ? EffectPart::turning : EffectPart::wheels;
}

std::string unit_of(const Effect& effect) {
  return std::string(facts_of(effect.channel).unit);
}

std::string what_it_would_be(const Effect& effect, const ShapeContext& context) {
  const EffectRange range = range_of(effect, context);
  return typeset(size_in_words(effect, range.least, range.most));
}

/// The largest |g| of coefficients as they are.
std::string at_most(const Effect& effect, const ShapeContext& context) {
  const EffectRange range = range_of(effect, context);
  return shown(std::max(std::abs(range.least), std::abs(range.most)), unit_of(effect));
}

/// The smallest size that would have been seen, as the largest |g| that it makes; empty where none
/// would have been.
std::string seen_from(const Finding& finding, const ShapeContext& context) {
  Effect effect = finding.candidate.effect;
  double most = 0.0;
  for (std::size_t k = 0; k < finding.minimal_detectable.size(); ++k) {
    if (!std::isfinite(finding.minimal_detectable[k])) return "";
    std::vector<double> alone(effect.coefficients.size(), 0.0);
    alone.at(k) = finding.minimal_detectable[k];
    effect.coefficients = std::move(alone);
    const EffectRange range = range_of(effect, context);
    most = std::max({most, std::abs(range.least), std::abs(range.most)});
  }
  return most > 0.0 ? shown(most, unit_of(effect)) : "";
}

bool looks_like_one_of(const Effect& effect, const std::vector<LookAlike>& rivals) {
  return std::any_of(rivals.begin(), rivals.end(), [&](const LookAlike& one) {
    return one.effect.name == effect.name && one.effect.shape == effect.shape;
  });
}

struct FindingVerdict {
  std::string words;
  Tone tone = Tone::neutral;
};

FindingVerdict verdict_on(const Finding& one, const Diagnosis& diagnosis) {
  if (one.status == Status::missing) return {"missing", Tone::bad};
  if (one.status == Status::negligible) return {"there, but too small to matter"};
  if (!diagnosis.missing.empty() &&
      looks_like_one_of(one.candidate.effect, diagnosis.findings.front().look_alikes)) {
    return {"could be it instead"};
  }
  if (one.p_adjusted < kSignificant) {
    return {diagnosis.missing.empty() ? "explained by noise or a single event"
                                      : "explained by what is missing"};
  }
  if (one.status == Status::absent) return {"nothing: it would have been seen"};
  return {"cannot tell from these data"};
}

/// A second effect that is missing shows only when the first is in.
std::string chance_of(const Finding& one, const Diagnosis& diagnosis) {
  const bool second = one.status == Status::missing && &one != &diagnosis.findings.front();
  return second && one.p_adjusted >= kSignificant ? "seen once the first is in"
                                                  : chance_text(one.p_adjusted);
}

std::string drop_text(const Diagnosis& diagnosis, const HeldOutMetrics& with) {
  if (diagnosis.held_out.legs.empty()) return "-";
  const double drop = diagnosis.held_out.arrival_rms - with.arrival_rms;
  return fmt::format("{:.1f}", std::abs(drop) < 5e-5 ? 0.0 : 1000.0 * drop);
}

void add_effect_part(PageTable& table, EffectPart part, const Diagnosis& diagnosis,
                     const ShapeContext& context) {
  const auto found =
      std::find_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                   [part](const Finding& one) { return part_of(one.candidate.effect) == part; });
  if (found != diagnosis.findings.end()) {
    const Effect& effect = found->candidate.effect;
    const FindingVerdict verdict = verdict_on(*found, diagnosis);
    table.rows.push_back({name_of(part), verdict.words, name_in_words(effect),
                          what_it_would_be(effect, context), drop_text(diagnosis, found->held_out),
                          chance_of(*found, diagnosis)});
    table.tones.push_back(verdict.tone);
    return;
  }
  const bool unseen =
      std::any_of(diagnosis.unobservable.begin(), diagnosis.unobservable.end(),
                  [part](const Unobservable& one) { return part_of(one.effect) == part; });
  table.rows.push_back({name_of(part),
                        unseen ? "cannot be seen in these data" : "not in these recordings", "-",
                        "-", "-", "-"});
  table.tones.push_back(Tone::neutral);
}

void add_found(PageTable& table, EffectPart part, const std::vector<FittedEffect>& found) {
  for (const FittedEffect& one : found) {
    const Effect& effect = one.estimate.effect;
    if (part_of(effect) != part) continue;
    table.rows.push_back({name_of(part), "found, and in the model now", name_in_words(effect),
                          typeset(size_in_words(effect, one.range.least, one.range.most)), "-",
                          "-"});
    table.tones.push_back(Tone::good);
  }
}

void add_noise(PageTable& table, const Diagnosis& diagnosis) {
  if (diagnosis.noise.empty()) return;
  const NoiseTest& first = diagnosis.noise.front();
  const bool more = first.p_adjusted < kStandsOut;
  table.rows.push_back({"noise", more ? "more than the model states" : "as the model states it",
                        first.law, more ? typeset(first.in_words) : "-", "-",
                        chance_text(first.p_adjusted)});
  table.tones.push_back(more ? Tone::bad : Tone::neutral);
}

void add_event(PageTable& table, const char* part, const Diagnosis& diagnosis, bool of_landmarks) {
  const auto found = std::find_if(
      diagnosis.events.begin(), diagnosis.events.end(),
      [of_landmarks](const EventTest& one) { return (one.kind == "landmark") == of_landmarks; });
  if (found == diagnosis.events.end()) return;
  const bool stands_out = found->p_adjusted < kStandsOut;
  table.rows.push_back(
      {part, stands_out ? "stands out" : "nothing out of line", found->kind + " " + found->name,
       stands_out ? typeset(found->in_words) : "-", "-", chance_text(found->p_adjusted)});
  table.tones.push_back(stands_out ? Tone::bad : Tone::neutral);
}

PageTable parts_table(const Diagnosis& diagnosis, const ShapeContext& context,
                      const std::vector<FittedEffect>& found) {
  PageTable table;
  table.caption = fmt::format("The best change to each part (of {} tried)", diagnosis.tried);
  if (!diagnosis.held_out.legs.empty()) {
    table.caption +=
        fmt::format("; legs now end {} off", distance_text(diagnosis.held_out.arrival_rms));
  }
  table.headings = {"part",
                    "verdict",
                    "best change",
                    "what it would be",
                    "legs would end closer by [mm]",
                    "chance of luck"};
  table.texts = 4;
  for (const EffectPart part : kEffectParts) {
    add_found(table, part, found);
    add_effect_part(table, part, diagnosis, context);
  }
  add_event(table, "map", diagnosis, true);
  add_noise(table, diagnosis);
  add_event(table, "single events", diagnosis, false);
  return table;
}

std::string cause_of(const Effect& effect) {
  const CatalogueEntry* entry = find_entry(effect.name);
  return entry == nullptr ? "-" : std::string(entry->cause);
}

PageTable rivals_table(const Diagnosis& diagnosis, const ShapeContext& context) {
  PageTable table;
  if (diagnosis.missing.empty() || diagnosis.findings.front().look_alikes.empty()) return table;
  const Finding& first = diagnosis.findings.front();
  table.caption = "What these recordings cannot tell apart";
  table.headings = {"it could be", "part",      "what it would be",
                    "made by",     "alike [%]", "legs would end off [mm]"};
  table.texts = 4;
  const auto add = [&](const Finding& one, const std::string& alike) {
    const Effect& effect = one.candidate.effect;
    table.rows.push_back({name_in_words(effect), name_of(part_of(effect)),
                          what_it_would_be(effect, context), cause_of(effect), alike,
                          diagnosis.held_out.legs.empty()
                              ? "-"
                              : fmt::format("{:.1f}", 1000.0 * one.held_out.arrival_rms)});
  };
  add(first, "the first choice");
  for (const LookAlike& rival : first.look_alikes) {
    const auto found = std::find_if(
        diagnosis.findings.begin(), diagnosis.findings.end(),
        [&](const Finding& one) { return looks_like_one_of(one.candidate.effect, {rival}); });
    if (found != diagnosis.findings.end()) add(*found, fmt::format("{:.1f}", 100.0 * rival.cosine));
  }
  return table;
}

PageTable tried_table(const Diagnosis& diagnosis, const ShapeContext& context) {
  PageTable table;
  table.caption = "The catalogue of effects: sizes at their most in these recordings";
  table.headings = {"effect", "part", "verdict", "found", "seen from", "p, adjusted"};
  table.texts = 3;
  for (const EffectPart part : kEffectParts) {
    for (const Finding& one : diagnosis.findings) {
      const Effect& effect = one.candidate.effect;
      if (one.candidate.form != Form::catalogue || part_of(effect) != part) continue;
      const FindingVerdict verdict = verdict_on(one, diagnosis);
      const std::string from = seen_from(one, context);
      table.rows.push_back({name_in_words(effect), name_of(part), verdict.words,
                            at_most(effect, context), from.empty() ? "-" : from,
                            chance_of(one, diagnosis)});
      table.tones.push_back(verdict.tone);
    }
  }
  return table;
}

std::vector<std::string> well_known(const Diagnosis& diagnosis, const ShapeContext& context) {
  std::vector<std::string> texts;
  for (const char* name : {"wheel diameter ratio", "wheelbase", "travel scale", "constant creep",
                           "compass offset", "hard iron", "range scale"}) {
    for (const Finding& one : diagnosis.findings) {
      if (one.candidate.effect.name != name || one.status != Status::absent) continue;
      const std::string from = seen_from(one, context);
      if (!from.empty()) texts.push_back(fmt::format("{} from {}", name, from));
    }
  }
  return texts;
}

PageTable others_table(const Diagnosis& diagnosis) {
  PageTable table;
  table.caption = "Laws of noise and single events, the likeliest of each";
  table.headings = {"what", "which", "in words", "explains chi\u00b2", "p, adjusted"};
  table.texts = 3;
  const auto add = [&table](const std::string& what, const std::string& which,
                            const std::string& words, double score, double p) {
    table.rows.push_back(
        {what, which, typeset(words), fmt::format("{:.1f}", score), chance_text(p)});
    table.tones.push_back(p < kStandsOut ? Tone::bad : Tone::neutral);
  };
  for (std::size_t k = 0; k < std::min(kEventRows, diagnosis.noise.size()); ++k) {
    const NoiseTest& one = diagnosis.noise[k];
    add("noise", one.law, one.p_adjusted < kStandsOut ? one.in_words : "-", one.score,
        one.p_adjusted);
  }
  for (std::size_t k = 0; k < std::min(kEventRows, diagnosis.events.size()); ++k) {
    const EventTest& one = diagnosis.events[k];
    add(one.kind, one.name, one.in_words, one.score, one.p_adjusted);
  }
  return table;
}

PageTable unseen_table(const Diagnosis& diagnosis) {
  PageTable table;
  table.caption = "What these data cannot show";
  table.headings = {"effect", "why", "what helps"};
  table.texts = 3;
  for (const Unobservable& one : diagnosis.unobservable) {
    table.rows.push_back({name_in_words(one.effect), one.why, one.remedy});
  }
  return table;
}

}  // namespace

std::vector<const Finding*> found_by(const Diagnosis& diagnosis) {
  std::vector<const Finding*> found;
  for (const Finding& one : diagnosis.findings) {
    if (one.status == Status::missing || one.status == Status::negligible) found.push_back(&one);
  }
  return found;
}

DiagnosisTables diagnosis_tables(const Diagnosis& diagnosis, const ShapeContext& context,
                                 const std::vector<FittedEffect>& found) {
  return {parts_table(diagnosis, context, found), rivals_table(diagnosis, context),
          tried_table(diagnosis, context), well_known(diagnosis, context)};
}

std::string chance_text(double p) {
  return p < 1e-12 ? "next to 0" : probability_text(p);
}

std::string listed(const std::vector<std::string>& names, const std::string& last) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    text += (k == 0 ? std::string() : k + 1 == names.size() ? " " + last + " " : ", ") + names[k];
  }
  return text;
}

SizeText size_text_of(const FittedEffect& effect) {
  const Effect& one = effect.estimate.effect;
  const ShownUnit unit = shown_unit(unit_of(one));
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

std::string named_with_sizes(const std::vector<FittedEffect>& effects) {
  if (effects.size() == 1) {
    const FittedEffect& only = effects.front();
    return name_in_words(only.estimate.effect) + " \u2013 " +
           typeset(size_in_words(only.estimate.effect, only.range.least, only.range.most));
  }
  std::vector<std::string> names;
  for (const FittedEffect& one : effects) {
    FittedEffect roughly = one;
    roughly.estimate.sd.clear();
    names.push_back(
        fmt::format("{} ({})", name_in_words(one.estimate.effect), size_text_of(roughly).size));
  }
  return listed(names);
}

std::string sized_in_words(const FittedEffect& effect) {
  constexpr double kClear = 2.0;  // standard errors
  const SizeText size = size_text_of(effect);
  std::string text = capitalised(effect_in_words(effect));
  if (size.error.empty()) return text + ".";
  text += fmt::format(" ({}, standard error {})", size.size, size.error);
  const EffectEstimate& fitted = effect.estimate;
  bool seen = false;
  for (std::size_t k = 0; k < fitted.sd.size(); ++k) {
    seen = seen || std::abs(fitted.effect.coefficients.at(k)) > kClear * fitted.sd[k];
  }
  return text + (seen ? "." : "; beside the others it is hardly seen.");
}

std::string advised_drive(const std::string& advice) {
  const std::size_t drive = advice.rfind("; ");
  if (drive == std::string::npos) return "A drive that would show more: " + advice + ".";
  return fmt::format("A drive that would show more: {} ({}).", advice.substr(drive + 2),
                     advice.substr(0, drive));
}

std::string sure_text(double p, std::size_t tests) {
  const std::string chance = p < 1e-6   ? "less than one in a million"
                             : p < 0.01 ? fmt::format("one in {:.0f}", 1.0 / p)
                                        : fmt::format("{:.2g} %", 100.0 * p);
  return fmt::format(
      "If nothing were missing, luck alone would show as much with a chance of {} ({} tests "
      "allowed "
      "for).",
      chance, tests);
}

std::string capitalised(std::string text) {
  if (!text.empty()) {
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  }
  return text;
}

std::string cause_note(const Effect& effect) {
  const CatalogueEntry* entry = find_entry(effect.name);
  if (entry == nullptr) return "";
  return fmt::format("{}: {}. What helps for good: {}.", capitalised(short_name(effect)),
                     entry->cause, entry->remedy);
}

std::string rivals_note(const Effect& effect, const std::vector<LookAlike>& rivals) {
  if (rivals.empty()) {
    return fmt::format("Nothing else in the catalogue looks like {} in these recordings.",
                       short_name(effect));
  }
  std::vector<std::string> names;
  for (const LookAlike& rival : rivals) {
    const CatalogueEntry* entry = find_entry(rival.effect.name);
    names.push_back(name_in_words(rival.effect) +
                    (entry == nullptr ? "" : " (" + std::string(entry->cause) + ")"));
  }
  return fmt::format("Instead of {} it could be {}: these recordings cannot tell.",
                     short_name(effect), listed(names, "or"));
}

std::vector<std::string> others_notes(const Diagnosis& diagnosis) {
  std::vector<std::string> notes;
  for (const NoiseTest& one : diagnosis.noise) {
    if (one.p_adjusted >= kStandsOut) continue;
    notes.push_back(
        fmt::format("More noise than the model states ({}): {}.", one.law, typeset(one.in_words)));
    break;
  }
  for (const EventTest& one : diagnosis.events) {
    if (one.p_adjusted >= kStandsOut) continue;
    notes.push_back(fmt::format("A single event stands out: {}.", typeset(one.in_words)));
    break;
  }
  return notes;
}

std::string seen_from_note(const DiagnosisTables& tables) {
  return tables.seen_from.empty()
             ? ""
             : "Larger effects would have been seen: " + listed(tables.seen_from) + ".";
}

PageSection tried_section(const Diagnosis& diagnosis, const DiagnosisTables& tables) {
  PageSection section{"All that was looked for", {}};
  section.blocks.emplace_back(
      "Sizes are those of the error that an effect makes, at its most in these recordings. "
      "\u201cSeen from\u201d is the size that would be named nine times in ten.");
  if (!tables.tried.rows.empty()) section.blocks.emplace_back(tables.tried);
  PageTable others = others_table(diagnosis);
  if (!others.rows.empty()) section.blocks.emplace_back(std::move(others));
  PageTable unseen = unseen_table(diagnosis);
  if (!unseen.rows.empty()) section.blocks.emplace_back(std::move(unseen));
  for (const std::string& line : diagnosis.advice) {
    section.blocks.emplace_back("What these data lack: " + typeset(line) + ".");
  }
  for (const std::string& line : diagnosis.warnings) {
    section.blocks.emplace_back("Warning: " + typeset(line) + ".");
  }
  return section;
}

}  // namespace trussmap
