// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What reports over small worlds say, read line by line for what cannot be. Seeds 1 to 10.
#include "report/page.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/evidence.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/simulated_recording.hpp"
#include "trussmap/texts.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::contradictions_test {
namespace {

/// What is known of the recordings that a report is of.
struct Known {
  bool gyro = false;
};

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

bool says(const std::string& text, const std::string& what) {
  return text.find(what) != std::string::npos;
}

bool matches(const std::string& text, const std::string& pattern) {
  return std::regex_search(text, std::regex(pattern));
}

/// Of the ladder: a line's degrees of freedom; nothing of other lines.
std::optional<int> dof_of(const std::string& line) {
  static const std::regex ladder("^  (?:as given|\\+ .*?) +[0-9.]+ +([0-9]+)  ");
  std::smatch found;
  if (!std::regex_search(line, found, ladder)) return std::nullopt;
  return std::stoi(found[1]);
}

/// Names that stand before " (" on lines that begin so.
std::vector<std::string> named_on(const std::vector<std::string>& lines, const std::string& begin) {
  std::vector<std::string> names;
  for (const std::string& line : lines) {
    if (!line.starts_with(begin) || !says(line, " (")) continue;
    names.push_back(line.substr(begin.size(), line.find(" (") - begin.size()));
  }
  return names;
}

/// Whether an effect of the catalogue asks for a column of another kind than it is named with.
bool has_wrong_role(const std::string& text) {
  return matches(text, "load on (both wheels|one wheel) \\((?!payload|[a-z_]*(load|mass|kg))") ||
         matches(text, "(tyre drift|gyro temperature drift) \\((payload_kg|lights)");
}

using Rule = std::function<bool(const std::string&, const Known&)>;  ///< true: it cannot be

bool effects_are_miscounted(const std::string& text, const Known&) {
  static const std::regex counted("(one|[0-9]+) effects? found");
  std::smatch found;
  if (!std::regex_search(text, found, counted)) return false;
  const std::size_t said = found[1] == "one" ? 1 : static_cast<std::size_t>(std::stoi(found[1]));
  std::size_t listed = 0;
  const std::vector<std::string> lines = lines_of(text);
  for (std::size_t k = 1; k < lines.size() && lines[k].starts_with("  "); ++k) ++listed;
  return said != listed;
}

/// More degrees of freedom with more coefficients, and no word of measurements that come back.
bool freedom_rises(const std::string& text, const Known&) {
  int before = -1;
  for (const std::string& line : lines_of(text)) {
    const std::optional<int> dof = dof_of(line);
    if (!dof) continue;
    if (before >= 0 && *dof > before && !says(text, "come back")) return true;
    before = *dof;
  }
  return false;
}

/// A rival that all measurements tell apart cannot be untold in the table, and one that looks the
/// same is seen.
bool rival_has_two_statuses(const std::string& text, const Known&) {
  const std::vector<std::string> lines = lines_of(text);
  for (const std::string& name : named_on(lines, "  looks much like it: ")) {
    for (const std::string& line : lines) {
      if (line.starts_with("  " + name + "  ") && line.ends_with("cannot tell")) return true;
    }
  }
  for (const std::string& name : named_on(lines, "  looks the same here: ")) {
    if (says(text, "\n  " + name + ": only an implausibly large one")) return true;
  }
  return false;
}

bool names_too_many(const std::string& text, const Known&) {
  std::size_t in_a_row = 0;
  for (const std::string& line : lines_of(text)) {
    const bool rival = line.starts_with("  looks the same here: ");
    in_a_row = rival ? in_a_row + 1 : 0;
    if (in_a_row > 4) return true;
  }
  return false;
}

/// What all measurements tell apart from all that it looks like explains the legs in nothing's
/// place.
bool set_has_what_is_told_apart(const std::string& text, const Known&) {
  const std::vector<std::string> lines = lines_of(text);
  const std::vector<std::string> same = named_on(lines, "  looks the same here: ");
  for (const std::string& name : named_on(lines, "  looks much like it: ")) {
    if (std::find(same.begin(), same.end(), name) != same.end()) continue;
    if (says(text, "(or " + name) || says(text, ", or " + name)) return true;
  }
  return false;
}

/// Sets of effects where nothing is missing, or something missing that is in none of the sets.
bool sets_say_otherwise(const std::string& text, const Known&) {
  const bool sets = says(text, "explain the legs about equally well") ||
                    says(text, "explains the legs nearly as well");
  if (sets && text.starts_with("nothing missing")) return true;
  for (const std::string& line : lines_of(text)) {
    if (!sets || !line.starts_with("missing: ")) continue;
    const std::string name = line.substr(9, line.find(';') - 9);
    if (!says(text.substr(text.find("the legs ")), name)) return true;
  }
  return false;
}

const std::vector<std::pair<const char*, Rule>>& rules() {
  static const std::vector<std::pair<const char*, Rule>> all{
      {"a gyro for a robot that has one",
       [](const std::string& text, const Known& known) {
         return known.gyro && says(text, "a gyro would help");
       }},
      {"a column in another's role",
       [](const std::string& text, const Known&) { return has_wrong_role(text); }},
      {"as good as noise allows, and unexplained",
       [](const std::string& text, const Known&) {
         return matches(text, "as good as|as its noise allows") &&
                matches(text, "unexplained|not explained|does not explain");
       }},
      {"consistent and a misfit",
       [](const std::string& text, const Known&) {
         return text.starts_with("consistent") && says(text, "misfit");
       }},
      {"effects miscounted", effects_are_miscounted},
      {"nothing predicted as 0.0 mm",
       [](const std::string& text, const Known&) {
         return matches(text, "\n  \\+ .* 0\\.0 +[0-9]+( |\n)") || says(text, "predicted 0.0 mm");
       }},
      {"behind by less than nothing",
       [](const std::string& text, const Known&) {
         return matches(text, "chi(\\^?2|\u00b2) -[0-9]+ behind|its fit -");
       }},
      {"unsettled by what nobody sees",
       [](const std::string& text, const Known&) {
         return matches(text, "did not settle.* [0-9.]+e-(0[5-9]|[1-9])");
       }},
      {"freedom gained by an effect", freedom_rises},
      {"two statuses", rival_has_two_statuses},
      {"more than three rivals", names_too_many},
      {"told apart, and in its place", set_has_what_is_told_apart},
      {"sets that say otherwise", sets_say_otherwise}};
  return all;
}

void read_for_contradictions(const std::string& text, const Known& known,
                             const std::string& where) {
  for (const auto& [what, cannot_be] : rules()) {
    EXPECT_FALSE(cannot_be(text, known)) << where << ": " << what << "\n" << text;
  }
}

/// A verdict and the answers below it.
std::string sentences_of(const Page& page) {
  std::string text = page.content().verdict + "\n";
  for (const report::PageAnswer& one : page.content().answers) text += one.answer + "\n";
  return text;
}

struct World {
  SimulationSettings settings;
  std::vector<Effect> effects;
};

World world(std::uint64_t seed) {
  constexpr int kKinds = 5;
  World one;
  one.settings.mesh = "3x3";
  one.settings.spacing = 3.0;
  one.settings.tours = 2;
  one.settings.seed = seed;
  one.settings.gyro = seed % 2 == 0;
  one.settings.range_sensor = seed % 3 == 0;
  one.settings.no_compass = seed % 4 == 0;
  const auto add = [&one](const char* name, double coefficient) {
    one.effects.push_back(catalogue_effect(name, {coefficient}));
  };
  switch (seed % kKinds) {
    case 0:
      add("wheelbase", 0.15);
      break;
    case 1:
      add("turn scrub", 0.2);
      break;
    case 2:
      add("wheelbase", -0.05);
      add("travel scale", 0.08);
      break;
    case 3:
      add("twist per spin", 0.2);
      break;
    default:
      break;
  }
  return one;
}

TEST(SlowContradictions, AreInNoReportOverSmallWorlds) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const World now = world(seed);
    const SimulatedRecording simulated = simulate(now.settings, now.effects);
    const std::vector<DrivenRecording> recordings =
        with_wheels(std::vector<Recording>{simulated.drive.recording}, simulated.model.robot);
    const Known known{now.settings.gyro};
    const auto read = [&](const std::string& text, const char* report) {
      read_for_contradictions(text, known, "seed " + std::to_string(seed) + ", " + report);
    };
    const Model& model = simulated.model;
    const auto budget = noise_budget(recordings, model);
    CompareOptions held;
    held.fit.fit_effects = false;
    const ModelFit fit = fit_model(recordings, model, held.fit);
    const Comparison compared = compare(recordings, fit, held);
    read(comparison_text(compared, model.noise, budget), "compare");
    read(sentences_of(comparison_page(evidence_of(fit, compared), "")), "page of compare");
    const Discovery discovery = discover(recordings, model);
    read(discovery_text(discovery, model.noise, budget), "discover");
    read(diagnosis_text(discovery.first, budget), "diagnose");
    read(diagnosis_text(discovery.last, budget), "diagnose the model found");
    if (discovery.found.model.effects.empty()) continue;
    Model bare = discovery.found.model;
    bare.effects.clear();
    const EffectGain gain = gain_of_effects(recordings, fit_model(recordings, bare, held.fit),
                                            fit_model(recordings, discovery.found.model));
    read(fit_text(gain), "fit");
  }
}

TEST(Contradictions, AreFoundWhereTheyAre) {
  const Known gyro{true};
  const std::vector<std::string> wrong{
      "after 30 s 90 % is turning error; a gyro would help most",
      "  load on both wheels (temperature_C)  wheels x temperature_C",
      "Legs end 3.1 cm off, as good as this robot's noise allows. Something is still unexplained.",
      "consistent: nothing found; but the misfit is not explained",
      "consistent: 4 effects found, one by one\n  a: b\n  c: d\n  e: f\n\n",
      "ladder\n  + wheelbase   20.0  118       20.0           17.2        0.0    15\n",
      "spin loss (19.3 mm; chi\u00b2 -1 behind)",
      "warning: shapes and path did not settle in 30 rounds; a measurement by up to 7e-11",
      "  as given     27046.3  117          -\n  + wheelbase     20.0  118       20.0\n",
      "missing: a\n  looks much like it: turn scrub (turn), cosine 0.99\n  turn scrub  x  cannot "
      "tell\n",
      "  looks the same here: a\n  looks the same here: b\n  looks the same here: c\n"
      "  looks the same here: d\n  looks the same here: e\n",
      "  looks much like it: turn scrub (turn), cosine 0.99\n    0.90  wheelbase (or turn scrub)\n",
      "nothing missing\n\nThese sets of effects explain the legs about equally well\n"};
  ASSERT_EQ(wrong.size(), rules().size());
  for (std::size_t k = 0; k < wrong.size(); ++k) {
    EXPECT_TRUE(rules()[k].second(wrong[k], gyro)) << rules()[k].first;
  }
}

}  // namespace
}  // namespace trussmap::contradictions_test
