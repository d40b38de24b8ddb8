// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap effects: the catalogue, or one effect of it.
#include "commands.hpp"
#include "effect_options.hpp"
#include "help.hpp"
#include "results/catalogue.hpp"
#include "results/json.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/workbench.hpp"
#include "trussmap/write_files.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace trussmap::app {
namespace {

struct EffectsCommand {
  std::string name;
  std::string json;
  std::string drawing;
};

std::vector<const CatalogueEntry*> asked_for(const std::string& name) {
  std::vector<const CatalogueEntry*> entries;
  if (name.empty()) {
    for (const CatalogueEntry& entry : catalogue()) entries.push_back(&entry);
  } else if (const CatalogueEntry* entry = find_entry(name)) {
    entries.push_back(entry);
  } else {
    throw UsageError(
        fmt::format("\"{}\" is not in the catalogue, whose names trussmap effects lists{}", name,
                    what_was_meant(name)));
  }
  return entries;
}

results::CatalogueReport listed(const std::vector<const CatalogueEntry*>& entries) {
  results::CatalogueReport report;
  for (const CatalogueEntry* one : entries) {
    report.effects.push_back({one, name_with_brackets(*one)});
  }
  return report;
}

std::string entry_text(const CatalogueEntry& entry) {
  const ChannelFacts& channel = facts_of(entry.channel);
  const Effect effect = results::effect_of(entry);
  const Explanation explained = explanation_of(effect);
  const std::vector<std::string> shapes =
      effect.shape.empty() ? entry.pattern : texts_of(effect.shape);
  constexpr std::size_t kWidth = 85, kColumn = 15;
  std::string text = fmt::format(
      "{}\n\n  does         {}\n  look at      {}\n  drive        {}\n", name_with_brackets(entry),
      wrapped(explained.does, kWidth, kColumn), wrapped(explained.look, kWidth, kColumn),
      wrapped(explained.drive, kWidth, kColumn));
  text += fmt::format(
      "  cause        {}\n  remedy       {}\n  acts on      {} (channel {})\n"
      "  goes with    {}\n  coefficient  {}\n",
      entry.cause, entry.remedy, channel.does_what, channel.name, fmt::join(shapes, "; "),
      entry.unit.empty() ? "-" : entry.unit);
  if (entry.detectable > 0.0) {
    text += fmt::format("  seen from    {:g}{}{} on, roughly\n", entry.detectable,
                        channel.unit.empty() ? "" : " ", channel.unit);
  }
  return text;
}

void run_effects(const EffectsCommand& options) {
  const std::vector<const CatalogueEntry*> entries = asked_for(options.name);
  if (!options.drawing.empty() && options.name.empty()) {
    throw UsageError("--drawing draws one effect, expected its NAME");
  }
  NamedContents files;
  if (!options.json.empty()) files.emplace_back(options.json, results::json_text(listed(entries)));
  if (!options.drawing.empty()) {
    files.emplace_back(options.drawing, effect_drawing(results::effect_of(*entries.front())));
  }
  write_files(files);
  fmt::print("{}", options.name.empty() ? catalogue_text() : entry_text(*entries.front()));
}

}  // namespace

void setup_effects(const Command& app) {
  auto options = std::make_shared<EffectsCommand>();
  const Command command =
      app.add_subcommand("effects", "List the catalogue of physical effects, or tell of one");
  command.add_option("NAME", options->name, "An effect of the catalogue").type_name("NAME");
  command.add_option("--json", options->json, "Write the same as JSON").type_name("FILE");
  command
      .add_option("--drawing", options->drawing, "Write a drawing of what it does to a robot (SVG)")
      .type_name("FILE");
  command.footer(
      "  trussmap effects\n"
      "  trussmap effects \"turn scrub\"\n"
      "\"seen from\": the largest effect in a recording that 60 legs of 5 m with survey and "
      "compass\n"
      "just show, in the channel's unit; how the robot drives decides.");
  command.callback([options] { run_effects(*options); });
}

}  // namespace trussmap::app
