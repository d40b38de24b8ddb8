// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"
#include "trussmap/texts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trussmap {

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
  std::string text = fmt::format("simulated: {} {} of a {} mesh{}\n\n", settings.tours,
                                 settings.tours == 1 ? "tour" : "tours", settings.mesh,
                                 folder.empty() ? "" : ", in " + folder);
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
