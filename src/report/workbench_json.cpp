// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/fit_charts.hpp"
#include "recording/variable_names.hpp"
#include "report/effect_parts.hpp"
#include "report/page_words.hpp"
#include "report/view_json.hpp"
#include "report/workbench_views.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/table.hpp"
#include "trussmap/workbench.hpp"
#include "wording/channel_words.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace trussmap {
using namespace report;

namespace {

using nlohmann::ordered_json;

constexpr std::size_t kMostCards = 240;

std::string step_name(const WorkbenchStep& step) {
  Effect effect;
  effect.name = step.effect;
  for (const Effect& one : step.model.effects) {
    if (one.name == step.effect) effect = one;
  }
  switch (step.kind) {
    case WorkbenchStep::Kind::add:
      return "+ " + name_in_words(effect);
    case WorkbenchStep::Kind::remove:
      return "\u2212 " + step.effect;
    case WorkbenchStep::Kind::exclude:
      return "without " + counted_legs(step.excluded_legs);
    case WorkbenchStep::Kind::include:
      return "all legs again";
    case WorkbenchStep::Kind::given:
      break;
  }
  return "as given";
}

ordered_json step_json(const WorkbenchLog& log, std::size_t k,
                       const std::vector<std::size_t>& way) {
  const WorkbenchStep& step = log.steps[k];
  ordered_json has = ordered_json::array();
  for (const Effect& one : step.model.effects) has.push_back(name_in_words(one));
  const bool on_way = std::find(way.begin(), way.end(), k) != way.end();
  return {{"step", k},
          {"from", step.from},
          {"name", step_name(step)},
          {"label", step.label},
          {"on_way", on_way},
          {"has", std::move(has)},
          {"mm", 1e3 * step.arrival_rms},
          {"predicted_mm",
           step.predicted_rms ? ordered_json(1e3 * *step.predicted_rms) : ordered_json(nullptr)},
          {"chi2_per_dof", step.chi2 / std::max(1, step.dof)}};
}

/// The ladder of the steps, with what was predicted, and the floor that noise alone makes.
plot::Chart staircase(const WorkbenchLog& log, const std::vector<std::size_t>& way) {
  std::vector<plot::LadderStep> ladder;
  for (const std::size_t k : way) {
    const WorkbenchStep& step = log.steps[k];
    ladder.push_back({step.label.empty() ? step_name(step) : step.label, step.arrival_rms,
                      step.chi2, step.dof, step.predicted_rms});
  }
  return plot::ladder_chart("staircase", ladder, log.steps[way.back()].expected_rms);
}

ordered_json card_json(const TriedModel& now, std::size_t k) {
  const Diagnosis& diagnosis = now.diagnosis();
  const Finding& one = diagnosis.findings[k];
  const EffectRange& range = now.sizes().at(k).range;
  ordered_json card = effect_view(one.effect);
  card["finding"] = k;
  card["words"] = typeset(size_in_words(one.effect, range.least, range.most));
  card["status"] = name_of(one.status);
  card["implausible"] = one.implausible;
  card["saves_mm"] = 1e3 * (diagnosis.held_out.arrival_rms - one.held_out.arrival_rms);
  card["chi2_less"] = one.score;
  card["leaves_mm"] = 1e3 * one.held_out.arrival_rms;
  card["p"] = chance_text(one.p_adjusted);
  card["significant"] = one.p_adjusted < diagnosis.level;
  ordered_json looks_like = ordered_json::array();
  for (const LookAlike& rival : one.look_alikes) {
    if (!rival.told_apart()) looks_like.push_back(rival.effect.name);
  }
  card["looks_like"] = std::move(looks_like);
  ordered_json parameters = ordered_json::array();
  for (const EffectParameter& parameter : now.parameters(k)) {
    parameters.push_back({{"name", parameter.parameter.name},
                          {"value", parameter.parameter.value},
                          {"step", parameter.step},
                          {"least", parameter.least},
                          {"most", parameter.most},
                          {"unit", parameter.unit}});
  }
  card["parameters"] = std::move(parameters);
  return card;
}

/// What is missing first, as the diagnosis has it; then by what each would save. A free form that
/// saves hardly more than the catalogue's best of its part has nothing to say for itself.
std::vector<std::size_t> order_of_cards(const std::vector<Finding>& findings, double now) {
  constexpr double kHardlyMore = 0.02;  // of what the catalogue's best saves
  const auto is_missing = [&findings](std::size_t k) {
    return findings[k].status == Status::missing || findings[k].status == Status::negligible;
  };
  const auto saves = [&findings, now](std::size_t k) {
    return now - findings[k].held_out.arrival_rms;
  };
  std::map<EffectPart, double> best;
  for (std::size_t k = 0; k < findings.size(); ++k) {
    if (findings[k].catalogue) {
      double& most = best[part_of(findings[k].effect)];
      most = std::max(most, saves(k));
    }
  }
  const auto weight = [&](std::size_t k) {
    const double most = best[part_of(findings[k].effect)];
    const bool hardly = !findings[k].catalogue && most > 0.0 &&
                        saves(k) < (1.0 + kHardlyMore) * most && saves(k) > 0.0;
    return hardly ? (1.0 - kHardlyMore) * saves(k) / (1.0 + kHardlyMore) : saves(k);
  };
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < findings.size(); ++k) order.push_back(k);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (is_missing(a) != is_missing(b)) return is_missing(a);
    return !is_missing(a) && weight(a) > weight(b);
  });
  return order;
}

ordered_json cards_json(const TriedModel& now) {
  const Diagnosis& diagnosis = now.diagnosis();
  std::vector<std::size_t> order =
      order_of_cards(diagnosis.findings, diagnosis.held_out.arrival_rms);
  if (order.size() > kMostCards) order.resize(kMostCards);
  ordered_json cards = ordered_json::array();
  for (const std::size_t k : order) cards.push_back(card_json(now, k));
  return cards;
}

/// What these recordings could not tell an effect from when it was added.
std::vector<std::string> could_be(const Effect& effect, const WorkbenchLog& log) {
  std::vector<std::string> names;
  for (const std::size_t k : way_to(log, log.at)) {
    const WorkbenchStep& step = log.steps[k];
    if (step.kind != WorkbenchStep::Kind::add || step.effect != effect.name) continue;
    names.clear();
    for (const Effect& one : step.could_be) names.push_back(name_in_words(one));
  }
  return names;
}

ordered_json on_json(const TriedModel& now, const WorkbenchLog& log) {
  ordered_json list = ordered_json::array();
  for (std::size_t k = 0; k < now.fit().effects.size(); ++k) {
    const EffectEstimate& one = now.fit().effects[k];
    ordered_json card = effect_view(one.effect);
    card["effect"] = k;
    card["words"] = typeset(in_words(one.effect, one.sd));
    ordered_json unfitted = ordered_json::array();
    for (const UnfittedCoefficient& why : one.not_fitted) unfitted.push_back(in_words(one, why));
    card["not_fitted"] = std::move(unfitted);
    card["could_be"] = could_be(one.effect, log);
    list.push_back(std::move(card));
  }
  return list;
}

ordered_json unseen_json(const Diagnosis& diagnosis) {
  ordered_json list = ordered_json::array();
  for (const Unobservable& one : diagnosis.unobservable) {
    const Advice advice = advice_on(one);
    list.push_back(
        {{"name", name_in_words(one.effect)}, {"why", advice.why}, {"drive", advice.drive}});
  }
  return list;
}

/// What a shape may speak of in all of these.
std::vector<std::string> shape_variables(const std::vector<DrivenRecording>& recordings) {
  std::vector<std::string> names = recording::reserved_variables();
  for (const Covariate& one : recordings.front().drive.covariates) {
    const auto has = [&one](const DrivenRecording& recording) {
      const auto& all = recording.drive.covariates;
      return std::any_of(all.begin(), all.end(),
                         [&one](const Covariate& other) { return other.name == one.name; });
    };
    if (std::all_of(recordings.begin(), recordings.end(), has)) names.push_back(one.name);
  }
  return names;
}

/// What a shape may speak of in all of these, with units.
ordered_json variables_json(const std::vector<DrivenRecording>& recordings) {
  ordered_json list = ordered_json::array();
  for (const std::string& name : shape_variables(recordings)) {
    list.push_back({{"name", name}, {"unit", recording::unit_of_variable(name)}});
  }
  return list;
}
/// What an effect can act on in these recordings: where the search has looked, or the model acts.
ordered_json channels_json(const TriedModel& now) {
  std::set<Channel> there;
  for (const Finding& one : now.diagnosis().findings) there.insert(one.effect.channel);
  for (const Unobservable& one : now.diagnosis().unobservable) there.insert(one.effect.channel);
  for (const EffectEstimate& one : now.fit().effects) there.insert(one.effect.channel);
  ordered_json list = ordered_json::array();
  for (const ChannelFacts& one : channels()) {
    if (!there.contains(one.channel)) continue;
    list.push_back({{"name", one.name}, {"unit", one.unit}, {"words", one.does_what}});
  }
  return list;
}

/// Where an effect that was added saves nothing of what was foretold; empty else.
std::string disappointment(const WorkbenchLog& log) {
  constexpr double kLess = 0.95, kMore = 1.2;
  const WorkbenchStep& step = log.steps[log.at];
  if (step.kind != WorkbenchStep::Kind::add || !step.predicted_rms) return {};
  const double before = log.steps[step.from].arrival_rms;
  if (step.arrival_rms < kLess * before || step.arrival_rms < kMore * *step.predicted_rms)
    return {};
  return fmt::format(
      "Adding {} did not help: legs end {} off, where {} was foretold and {} was before. Undo it, "
      "and try another.",
      step.effect, distance_text(step.arrival_rms), distance_text(*step.predicted_rms),
      distance_text(before));
}

/// The verdict in words of this page alone: names as its cards have them, and no other command.
std::string headline(const TriedModel& now) {
  const Diagnosis& diagnosis = now.diagnosis();
  if (diagnosis.verdict == Diagnosis::Verdict::missing) {
    std::vector<std::string> names;
    for (const Finding* one : found_by(diagnosis)) names.push_back(name_in_words(one->effect));
    return "missing: " + listed(names, "and");
  }
  const std::vector<Trend>& trends = now.comparison().trends;
  if (diagnosis.objection == Objection::trend && !trends.empty()) {
    const Trend& first = trends.front();
    return fmt::format(
        "unexplained misfit: the {} error {}, and none of {} effects tried explains it", first.kind,
        first.against == "all" ? std::string("is everywhere alike")
                               : "goes with " + wording::variable_in_words(first.against),
        diagnosis.tried);
  }
  return typeset(verdict_in_words(diagnosis));
}

/// What is said above all else.
ordered_json verdict_json(const TriedModel& now) {
  const Diagnosis& diagnosis = now.diagnosis();
  const bool slight = is_slight_misfit(diagnosis);
  ordered_json result = {{"text", capitalised(headline(now))},
                         {"tone", diagnosis.verdict == Diagnosis::Verdict::nothing_missing ? "good"
                                  : slight ? "neutral"
                                           : "bad"}};
  if (diagnosis.verdict == Diagnosis::Verdict::missing) {
    const Finding& first = diagnosis.findings.front();
    result["unsure"] =
        first.look_alikes.empty() ? "" : rivals_note(first.effect, first.look_alikes);
  }
  const bool doubt = diagnosis.verdict == Diagnosis::Verdict::unexplained_misfit && !slight;
  result["drive"] =
      diagnosis.next_drive ? "To tell them apart, " + in_words(diagnosis.next_drive) + "."
      : doubt && !diagnosis.lacks.empty() ? advised_drive(advice_on(diagnosis.lacks.front()))
                                          : "";
  result["others"] = others_notes(diagnosis, "the model that is taken along states it");
  if (slight) {
    result["others"].push_back(
        "A misfit as slight as this speaks against no model: prefer the one whose legs end less "
        "far off.");
  }
  ordered_json warnings = ordered_json::array();
  for (const std::string& one : diagnosis.warnings) {
    warnings.push_back(capitalised(typeset(one)) + ".");
  }
  result["warnings"] = std::move(warnings);
  return result;
}

/// "At a leg's end and after 10 s 98 % is what ...": horizons of which the same is to be said are
/// said together.
std::vector<std::string> noise_lines(const std::vector<NoiseBudget>& budget) {
  std::vector<std::pair<std::string, std::vector<std::string>>> said;  // what, of which horizons
  for (const NoiseBudget& one : budget) {
    if (one.shares.empty()) continue;
    const std::string words = typeset(in_words(one));
    const std::size_t at =
        words.find(fmt::format(" {:.0f} % is ", 100.0 * one.shares.front().share));
    if (at == std::string::npos) {
      said.emplace_back(words, std::vector<std::string>());
      continue;
    }
    const std::string what = words.substr(at);
    if (said.empty() || said.back().first != what)
      said.emplace_back(what, std::vector<std::string>());
    said.back().second.push_back(words.substr(0, at));
  }
  std::vector<std::string> lines;
  lines.reserve(said.size());
  for (const auto& [what, when] : said)
    lines.push_back(capitalised(listed(when, "and") + what) + ".");
  return lines;
}

ordered_json noise_json(const TriedModel& now) {
  ordered_json shares = ordered_json::array();
  if (!now.budget().empty()) {
    for (const NoiseShare& one : now.budget().front().shares) {
      shares.push_back({{"source", one.source}, {"share", one.share}});
    }
  }
  return {{"lines", noise_lines(now.budget())}, {"shares", std::move(shares)}};
}

}  // namespace

std::string workbench_json(const TriedModel& now, const WorkbenchLog& log,
                           const std::string& subject, bool provisional) {
  const std::vector<std::size_t> way = way_to(log, log.at);
  ordered_json steps = ordered_json::array();
  for (std::size_t k = 0; k < log.steps.size(); ++k) steps.push_back(step_json(log, k, way));
  ordered_json verdict = verdict_json(now);
  if (provisional) {
    verdict["text"] = "So far: " + headline(now);
  } else if (const std::string said = disappointment(log); !said.empty()) {
    verdict["others"].insert(verdict["others"].begin(), said);
  }
  ordered_json result = {{"subject", subject},
                         {"provisional", provisional},
                         {"at", log.at},
                         {"steps", std::move(steps)},
                         {"verdict", std::move(verdict)},
                         {"fit", fit_in_words(now.diagnosis().chi2, now.diagnosis().dof,
                                              now.diagnosis().coefficients)},
                         {"tried", now.diagnosis().tried},
                         {"on", on_json(now, log)},
                         {"cards", cards_json(now)},
                         {"unseen", unseen_json(now.diagnosis())},
                         {"noise", noise_json(now)},
                         {"variables", variables_json(now.recordings())},
                         {"channels", channels_json(now)},
                         {"staircase", chart_view(staircase(log, way))}};
  result.update(views_json(now, std::nullopt, log.steps.front().arrival_rms));
  return safe_text(result);
}

}  // namespace trussmap
