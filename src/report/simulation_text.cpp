// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trussmap {
namespace {

const char* outcome_in_words(const ScoredEffect& row) {
  if (row.outcome == ScoredEffect::Outcome::found) return "found";
  return row.outcome == ScoredEffect::Outcome::missed ? "missed" : "false";
}

/// A row per coefficient, truth beside estimate in the catalogue's unit.
void add_scored(TextTable& table, const ScoredEffect& row) {
  const Effect& effect = row.truth ? *row.truth : *row.estimate;
  const CatalogueEntry* entry = find_entry(effect.name);
  for (std::size_t k = 0; k < effect.coefficients.size(); ++k) {
    std::vector<std::string> cells = {k == 0 ? outcome_in_words(row) : "",
                                      k == 0 ? effect.name : ""};
    cells.push_back(row.truth ? fmt::format("{:.4g}", row.truth->coefficients[k]) : "");
    const bool there = row.estimate && k < row.estimate->coefficients.size();
    const double sd = there && k < row.sd.size() && std::isfinite(row.sd[k]) ? row.sd[k] : 0.0;
    const QuantityText text =
        there ? quantity_text(row.estimate->coefficients[k], sd) : QuantityText{};
    cells.push_back(text.value);
    cells.push_back(text.error.empty() ? "" : "\u00b1 " + text.error);
    const bool known = k < row.z.size() && std::isfinite(row.z[k]);
    cells.push_back(known ? fmt::format("{:+.1f}", row.z[k]) : "");
    cells.push_back(entry == nullptr ? "" : std::string(entry->unit));
    cells.push_back(effect.shape[k % effect.shape.size()].text());
    table.rows.push_back(std::move(cells));
  }
}

std::string words_of(const Effect& effect, std::vector<double> sd) {
  sd.resize(effect.coefficients.size(), 0.0);
  return in_words(effect, sd);
}

}  // namespace

std::string score_text(const AnswerScore& score, TextStyle style) {
  const bool all = score.missed == 0 && score.false_alarms == 0;
  std::string out = verdict_text(all ? Mood::good : Mood::doubt,
                                 fmt::format("score: {} found, {} missed, {} false", score.found,
                                             score.missed, score.false_alarms),
                                 style) +
                    "\n";
  TextTable table{{Align::left, Align::left, Align::right, Align::right, Align::left, Align::right,
                   Align::left, Align::left},
                  {{"", "effect", "truth", "estimate", "", "z", "unit", "shape"}},
                  true,
                  2};
  for (const ScoredEffect& row : score.effects) add_scored(table, row);
  if (table.rows.size() > 1) out += "\n" + table_text(table, style) + "\n";
  for (const ScoredEffect& row : score.effects) {
    if (row.truth) out += "  truth:    " + words_of(*row.truth, {}) + "\n";
    if (row.estimate) out += "  estimate: " + words_of(*row.estimate, row.sd) + "\n";
  }
  return out;
}

std::string effects_text(const std::vector<Effect>& effects, TextStyle style) {
  TextTable table;
  table.columns = {Align::left, Align::left, Align::right, Align::left, Align::left};
  table.has_heading = true;
  table.rows = {{"effect", "channel", "coefficient", "unit", "shape"}};
  for (const Effect& effect : effects) {
    const CatalogueEntry* entry = find_entry(effect.name);
    for (std::size_t k = 0; k < effect.shape.size(); ++k) {
      table.rows.push_back(
          {k == 0 ? effect.name : "", k == 0 ? std::string(name_of(effect.channel)) : "",
           fmt::format("{:g}", effect.coefficients.at(k)),
           entry == nullptr ? "" : std::string(entry->unit), effect.shape[k].text()});
    }
  }
  return table_text(table, style);
}

std::string simulation_text(const SimulatedRecording& simulated, const SimulationSettings& settings,
                            const std::string& folder, TextStyle style) {
  const Recording& recording = simulated.drive.recording;
  const TrueMotion& motion = simulated.drive.motion;
  const std::string what =
      settings.plan ? fmt::format("a plan of {} waypoints", settings.plan->waypoints.size())
                    : fmt::format("{} {}", settings.tours, settings.tours == 1 ? "tour" : "tours");
  const std::string where = settings.plan && settings.places_of_plan
                                ? "on its own landmarks"
                                : fmt::format("of a {} mesh", settings.mesh);
  std::string text =
      fmt::format("simulated: {} {}{}\n\n", what, where, folder.empty() ? "" : ", in " + folder);
  const auto line = [&text](const char* name, const std::string& value, const char* unit = "") {
    text += fmt::format("  {:<10} {:>10}{}{}\n", name, value, *unit == '\0' ? "" : " ", unit);
  };
  const auto count = [&line](const char* name, std::size_t number) {
    line(name, std::to_string(number));
  };
  count("landmarks", static_cast<std::size_t>(simulated.mesh.landmarks()));
  count("routes", simulated.mesh.routes.size());
  count("legs", motion.stops.size() - 1);
  count("rows", motion.rows.size());
  count("sightings", recording.sightings.size());
  if (!recording.fixes.empty()) count("fixes", recording.fixes.size());
  if (!recording.loops.empty()) count("loops", recording.loops.size());
  line("length", fmt::format("{:.1f}", simulated.length()), "m");
  line("duration", fmt::format("{:.1f}", motion.rows.back().t), "s");
  line("compass", recording.drive.has_compass() ? "yes" : "no");
  if (recording.drive.has_gyro()) line("gyro", "yes");
  count("surveyed", recording.survey.size());
  const std::vector<std::string> rough = rough_names(rough_of(settings));
  if (!rough.empty()) {
    text +=
        fmt::format("\n  Its noise is not what model.toml states: {}.\n", fmt::join(rough, ", "));
  }
  if (settings.hide) {
    text += fmt::format("\n  Effects are hidden in it; `trussmap reveal {}` names them.\n",
                        folder.empty() ? "FOLDER" : folder);
  } else if (!simulated.effects.empty()) {
    text += "\n" + effects_text(simulated.effects, style);
  }
  return text;
}

}  // namespace trussmap
