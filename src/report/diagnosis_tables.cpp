// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/diagnosis_tables.hpp"

#include "effects/catalogue_record.hpp"
#include "plot/fit_charts.hpp"
#include "report/effect_parts.hpp"
#include "report/noise_verdict.hpp"
#include "report/page_words.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/table.hpp"
#include "wording/channel_words.hpp"
#include "wording/explanations.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

constexpr std::size_t kEventRows = 8;

std::string unit_of(const Effect& effect) {
  return std::string(facts_of(effect.channel).unit);
}

std::string what_it_would_be(const Effect& effect, const EffectRange& range) {
  return typeset(size_in_words(effect, range.least, range.most));
}

/// The largest |g| of coefficients as they are.
std::string at_most(const Effect& effect, const EffectRange& range) {
  return wording::shown(std::max(std::abs(range.least), std::abs(range.most)), unit_of(effect));
}

/// The smallest size that would have been seen; empty where none would have been.
std::string seen_from(const Finding& finding, const FindingSize& size) {
  return size.seen_from > 0.0 ? wording::shown(size.seen_from, unit_of(finding.effect)) : "";
}

bool looks_like_one_of(const Effect& effect, const std::vector<LookAlike>& rivals) {
  return std::any_of(rivals.begin(), rivals.end(), [&](const LookAlike& one) {
    return !one.told_apart() && one.effect.name == effect.name && one.effect.shape == effect.shape;
  });
}

struct FindingVerdict {
  std::string words;
  Tone tone = Tone::neutral;
};

/// `size`: what it does in these recordings.
FindingVerdict verdict_on(const Finding& one, const FindingSize& size, const Diagnosis& diagnosis) {
  if (one.status == Status::missing) return {"missing", Tone::bad};
  if (one.status == Status::negligible) return {"there, but too small to matter"};
  if (!diagnosis.missing.empty() &&
      looks_like_one_of(one.effect, diagnosis.findings.front().look_alikes)) {
    return {"could be it instead"};
  }
  if (one.p_adjusted < diagnosis.level) {
    if (one.implausible) return {"would have to be implausibly large"};
    return {diagnosis.missing.empty() ? "explained by noise or a single event"
                                      : "explained by what is missing"};
  }
  if (one.status == Status::absent && size.seen_from > 0.0) {
    const double found = std::max(std::abs(size.range.least), std::abs(size.range.most));
    return {found < size.seen_from ? "nothing: it would have been seen"
                                   : "not more than chance, though large enough to be seen"};
  }
  return {"cannot tell from these data"};
}

/// A second effect that is missing shows only when the first is in.
std::string chance_of(const Finding& one, const Diagnosis& diagnosis) {
  const bool second = one.status == Status::missing && &one != &diagnosis.findings.front();
  return second && one.p_adjusted >= diagnosis.level ? "seen once the first is in"
                                                     : chance_text(one.p_adjusted);
}

std::string drop_text(const Diagnosis& diagnosis, const HeldOutMetrics& with) {
  if (diagnosis.held_out.legs.empty()) return "-";
  const double drop = diagnosis.held_out.arrival_rms - with.arrival_rms;
  return fmt::format("{:.1f}", std::abs(drop) < 5e-5 ? 0.0 : 1000.0 * drop);
}

const FindingSize& size_of(const Finding& finding, const SizedDiagnosis& sized) {
  return sized.sizes.at(static_cast<std::size_t>(&finding - sized.diagnosis.findings.data()));
}

void add_effect_part(PageTable& table, EffectPart part, const SizedDiagnosis& sized) {
  const Diagnosis& diagnosis = sized.diagnosis;
  const auto found =
      std::find_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                   [part](const Finding& one) { return part_of(one.effect) == part; });
  if (found != diagnosis.findings.end()) {
    const Effect& effect = found->effect;
    const FindingVerdict verdict = verdict_on(*found, size_of(*found, sized), diagnosis);
    table.rows.push_back({part_name(part), verdict.words, name_in_words(effect),
                          what_it_would_be(effect, size_of(*found, sized).range),
                          drop_text(diagnosis, found->held_out), chance_of(*found, diagnosis)});
    table.tones.push_back(verdict.tone);
    return;
  }
  const bool unseen =
      std::any_of(diagnosis.unobservable.begin(), diagnosis.unobservable.end(),
                  [part](const Unobservable& one) { return part_of(one.effect) == part; });
  if (!unseen && part == EffectPart::gyro) return;  // few robots have one
  table.rows.push_back({part_name(part),
                        unseen ? "cannot be seen in these data" : "not in these recordings", "-",
                        "-", "-", "-"});
  table.tones.push_back(Tone::neutral);
}

void add_found(PageTable& table, EffectPart part, const std::vector<EffectEvidence>& found) {
  for (const EffectEvidence& one : found) {
    const Effect& effect = one.estimate.effect;
    if (part_of(effect) != part) continue;
    table.rows.push_back({part_name(part), "found, and in the model now", name_in_words(effect),
                          typeset(size_in_words(effect, one.range.least, one.range.most)), "-",
                          "-"});
    table.tones.push_back(Tone::good);
  }
}

void add_noise(PageTable& table, const Diagnosis& diagnosis) {
  if (noise_is_wrong(diagnosis)) {
    table.rows.push_back({"noise", "other than the model states", "estimated",
                          typeset(in_words(diagnosis.under->noise)), "-", "-"});
    table.tones.push_back(Tone::bad);
    return;
  }
  if (diagnosis.noise.empty()) return;
  const NoiseTest& first = diagnosis.noise.front();
  const bool more = first.p_adjusted < diagnosis.level;
  table.rows.push_back({"noise", more ? "more than the model states" : "as the model states it",
                        first.law, more ? typeset(in_words(first)) : "-", "-",
                        chance_text(first.p_adjusted)});
  table.tones.push_back(more ? Tone::bad : Tone::neutral);
}

void add_event(PageTable& table, const char* part, const Diagnosis& diagnosis, bool of_landmarks) {
  const auto found = std::find_if(diagnosis.events.begin(), diagnosis.events.end(),
                                  [of_landmarks](const EventTest& one) {
                                    return (one.kind == EventKind::landmark) == of_landmarks;
                                  });
  if (found == diagnosis.events.end()) return;
  const bool stands_out = found->p_adjusted < diagnosis.level;
  table.rows.push_back({part, stands_out ? "stands out" : "nothing out of line",
                        fmt::format("{} {}", name_of(found->kind), found->name),
                        stands_out ? typeset(in_words(*found)) : "-", "-",
                        chance_text(found->p_adjusted)});
  table.tones.push_back(stands_out ? Tone::bad : Tone::neutral);
}

std::string cause_of(const Effect& effect) {
  if (const CatalogueEntry* entry = wording::usual_entry(effect)) return std::string(entry->cause);
  return find_entry(effect.name) == nullptr ? "-" : "not its usual sign";
}

PageTable tried_table(const SizedDiagnosis& sized) {
  const Diagnosis& diagnosis = sized.diagnosis;
  PageTable table;
  table.caption = "The catalogue of effects: sizes at their most in these recordings";
  table.headings = {"effect", "part", "verdict", "found", "seen from", "p, adjusted"};
  table.texts = 3;
  for (const EffectPart part : kEffectParts) {
    for (const Finding& one : diagnosis.findings) {
      const Effect& effect = one.effect;
      if (!one.catalogue || part_of(effect) != part) continue;
      const FindingSize& size = size_of(one, sized);
      const FindingVerdict verdict = verdict_on(one, size, diagnosis);
      const std::string from = seen_from(one, size);
      table.rows.push_back({name_in_words(effect), part_name(part), verdict.words,
                            at_most(effect, size.range), from.empty() ? "-" : from,
                            chance_of(one, diagnosis)});
      table.tones.push_back(verdict.tone);
    }
  }
  return table;
}

std::vector<std::string> well_known(const SizedDiagnosis& sized) {
  std::vector<std::string> texts;
  for (const effects::CatalogueRecord& record : effects::catalogue_records()) {
    if (!record.well_known) continue;
    const std::string_view name = record.entry.name;
    for (const Finding& one : sized.diagnosis.findings) {
      if (one.effect.name != name || one.status != Status::absent) continue;
      const FindingSize& size = size_of(one, sized);
      const std::string from = seen_from(one, size);
      const double found = std::max(std::abs(size.range.least), std::abs(size.range.most));
      if (!from.empty() && found < size.seen_from)
        texts.push_back(fmt::format("{} from {}", name, from));
    }
  }
  return texts;
}

}  // namespace

PageTable noise_table(const Diagnosis& diagnosis) {
  PageTable table;
  table.caption = "Noise, as estimated";
  table.headings = {"noise of", "unit", "lasts for", "stated", "found"};
  table.texts = 3;
  if (!diagnosis.under || !diagnosis.under->noise.changed()) return table;
  for (const NoiseSource& one : diagnosis.under->noise.sources) {
    const bool by_time = one.process.process == ProcessKind::correlated_in_t;
    table.rows.push_back({one.name, one.unit,
                          one.process.length > 0.0
                              ? fmt::format("{:.3g} {}", one.process.length, by_time ? "s" : "m")
                              : "",
                          one.stated > 0.0 ? fmt::format("{:.3g}", one.stated) : "-",
                          fmt::format("{:.3g}{}", one.sd, one.at_limit ? " (or beyond)" : "")});
    table.tones.push_back(is_wrong(one) ? Tone::bad : Tone::neutral);
  }
  return table;
}

namespace {

PageTable others_table(const Diagnosis& diagnosis) {
  PageTable table;
  table.caption = "Laws of noise and single events, the likeliest of each";
  table.headings = {"what", "which", "in words", "explains chi\u00b2", "p, adjusted"};
  table.texts = 3;
  const auto add = [&table, &diagnosis](const std::string& what, const std::string& which,
                                        const std::string& words, double score, double p) {
    table.rows.push_back(
        {what, which, typeset(words), fmt::format("{:.1f}", score), chance_text(p)});
    table.tones.push_back(p < diagnosis.level ? Tone::bad : Tone::neutral);
  };
  for (std::size_t k = 0; k < std::min(kEventRows, diagnosis.noise.size()); ++k) {
    const NoiseTest& one = diagnosis.noise[k];
    add("noise", one.law, one.p_adjusted < diagnosis.level ? in_words(one) : "-", one.score,
        one.p_adjusted);
  }
  for (std::size_t k = 0; k < std::min(kEventRows, diagnosis.events.size()); ++k) {
    const EventTest& one = diagnosis.events[k];
    add(std::string(name_of(one.kind)), one.name, in_words(one), one.score, one.p_adjusted);
  }
  return table;
}

PageTable unseen_table(const Diagnosis& diagnosis) {
  PageTable table;
  table.caption = "What these data cannot show";
  table.headings = {"effect", "why", "what helps"};
  table.texts = 3;
  for (const Unobservable& one : diagnosis.unobservable) {
    const Advice advice = advice_on(one);
    table.rows.push_back({name_in_words(one.effect), advice.why, advice.drive});
  }
  return table;
}

}  // namespace

PageTable parts_table(const SizedDiagnosis& sized, const std::vector<EffectEvidence>& found) {
  const Diagnosis& diagnosis = sized.diagnosis;
  PageTable table;
  table.caption = fmt::format("The best change to each part (of {} tried)", diagnosis.tried);
  if (!diagnosis.held_out.legs.empty()) {
    table.caption +=
        fmt::format("; legs now end {} off", distance_text(diagnosis.held_out.arrival_rms));
  }
  table.headings = {
      "part",   "verdict", "best change", "what it would be", "legs would end closer by [mm]",
      "p-value"};
  table.texts = 4;
  for (const EffectPart part : kEffectParts) {
    add_found(table, part, found);
    add_effect_part(table, part, sized);
  }
  add_event(table, "map", diagnosis, true);
  add_noise(table, diagnosis);
  add_event(table, "single events", diagnosis, false);
  return table;
}

PageTable rivals_table(const SizedDiagnosis& sized) {
  const Diagnosis& diagnosis = sized.diagnosis;
  PageTable table;
  if (diagnosis.missing.empty() ||
      closest_rival(diagnosis.findings.front().look_alikes) == nullptr) {
    return table;
  }
  const Finding& first = diagnosis.findings.front();
  table.caption = "What these recordings cannot tell apart";
  table.headings = {"it could be", "part",      "what it would be",
                    "made by",     "alike [%]", "legs would end off [mm]"};
  table.texts = 4;
  const auto add = [&](const Finding& one, const std::string& alike) {
    const Effect& effect = one.effect;
    table.rows.push_back({name_in_words(effect), part_name(part_of(effect)),
                          what_it_would_be(effect, size_of(one, sized).range), cause_of(effect),
                          alike,
                          diagnosis.held_out.legs.empty()
                              ? "-"
                              : fmt::format("{:.1f}", 1000.0 * one.held_out.arrival_rms)});
  };
  add(first, "the first choice");
  for (const LookAlike& rival : first.look_alikes) {
    const auto found =
        std::find_if(diagnosis.findings.begin(), diagnosis.findings.end(),
                     [&](const Finding& one) { return looks_like_one_of(one.effect, {rival}); });
    if (found != diagnosis.findings.end()) add(*found, fmt::format("{:.1f}", 100.0 * rival.cosine));
  }
  return table;
}

std::string seen_from_note(const SizedDiagnosis& sized) {
  const std::vector<std::string> known = well_known(sized);
  return known.empty() ? "" : "Larger effects would have been seen: " + listed(known) + ".";
}

PageSection tried_section(const SizedDiagnosis& sized) {
  const Diagnosis& diagnosis = sized.diagnosis;
  PageSection section{"All that was looked for", {}};
  section.blocks.emplace_back(
      "Sizes are those of the error that an effect makes, at its most in these recordings. "
      "\u201cSeen from\u201d is the size that would be named nine times in ten.");
  PageTable tried = tried_table(sized);
  if (!tried.rows.empty()) section.blocks.emplace_back(std::move(tried));
  PageTable others = others_table(diagnosis);
  if (!others.rows.empty()) section.blocks.emplace_back(std::move(others));
  PageTable unseen = unseen_table(diagnosis);
  if (!unseen.rows.empty()) section.blocks.emplace_back(std::move(unseen));
  for (const std::string& line : in_words(diagnosis.lacks)) {
    section.blocks.emplace_back("What these data lack: " + typeset(line) + ".");
  }
  for (const std::string& line : diagnosis.warnings) {
    section.blocks.emplace_back("Warning: " + typeset(line) + ".");
  }
  return section;
}

}  // namespace trussmap::report
