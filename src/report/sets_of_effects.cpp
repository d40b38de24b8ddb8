// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/sets_of_effects.hpp"

#include "report/page_words.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

namespace trussmap::report {
namespace {

constexpr std::size_t kMostSets = 4;     // in the text
constexpr std::size_t kMostRows = 20;    // in the table
constexpr std::size_t kMostChances = 6;  // in a line
constexpr double kLeastSaid = 0.05;      // probability
constexpr std::size_t kMostLikeIt = 2;   // names

/// Never certain: nothing but what was tried was weighed.
std::string likelihood_text(double probability) {
  if (probability > 0.99) return "> 0.99";
  if (probability < 0.01) return "< 0.01";
  return fmt::format("{:.2f}", probability);
}

std::string with_look_alikes(const Effect& effect, const std::vector<std::string>& otherwise) {
  if (otherwise.empty()) return effect.name;
  std::string names;
  for (std::size_t k = 0; k < std::min(kMostLikeIt, otherwise.size()); ++k) {
    names += (k > 0 ? ", or " : "or ") + otherwise[k];
  }
  if (otherwise.size() > kMostLikeIt) {
    names += fmt::format(", or {} more", otherwise.size() - kMostLikeIt);
  }
  return fmt::format("{} ({})", effect.name, names);
}

std::string set_in_words(const EffectSet& set) {
  std::vector<std::string> names;
  for (const ExplainingEffect& one : set.effects) {
    names.push_back(with_look_alikes(one.effect, one.otherwise));
  }
  return names.empty() ? "no effect" : listed(names);
}

std::string chances_in_words(const Explanations& explanations) {
  std::vector<std::string> chances;
  for (const EffectChance& one : explanations.effects) {
    if (chances.size() == kMostChances || one.probability < kLeastSaid) break;
    chances.push_back(fmt::format("{} {}", with_look_alikes(one.effect, one.otherwise),
                                  likelihood_text(one.probability)));
  }
  return fmt::format("{}", fmt::join(chances, "; "));
}

}  // namespace

std::string sets_text(const Diagnosis& diagnosis) {
  const Explanations& all = diagnosis.explanations;
  if (all.sets.empty()) return "";
  std::string text;
  if (all.sets.size() == 1) {
    text = "\nNo other set of effects explains the legs nearly as well\n";
  } else {
    text = "\nThese sets of effects explain the legs about equally well (probability)\n";
    double rest = 0.0;
    for (std::size_t k = 0; k < all.sets.size(); ++k) {
      const EffectSet& one = all.sets[k];
      if (k >= kMostSets) {
        rest += one.probability;
        continue;
      }
      text += fmt::format("  {:>6}  {}\n", likelihood_text(one.probability), set_in_words(one));
    }
    if (all.sets.size() > kMostSets) {
      text += fmt::format("  {:>6}  {} more\n", likelihood_text(rest), all.sets.size() - kMostSets);
    }
  }
  return text +
         fmt::format("  probability of being part of the explanation: {}\n", chances_in_words(all));
}

PageTable sets_table(const Diagnosis& diagnosis) {
  PageTable table;
  table.caption = "Sets of effects that explain the legs about equally well";
  table.headings = {"effects", "sizes", "probability", "behind [log evidence]",
                    "explains chi\u00b2"};
  table.texts = 2;
  for (const EffectSet& one : diagnosis.explanations.sets) {
    if (table.rows.size() == kMostRows) break;
    std::vector<std::string> sizes;
    for (const ExplainingEffect& effect : one.effects) {
      sizes.push_back(typeset(in_words(effect.effect, effect.sd)));
    }
    table.rows.push_back({set_in_words(one) + (one.named ? " \u2013 named above" : ""),
                          fmt::format("{}", fmt::join(sizes, "; ")),
                          likelihood_text(one.probability), fmt::format("{:.1f}", one.behind),
                          fmt::format("{:.1f}", one.chi2_decrease)});
    table.tones.push_back(Tone::neutral);
  }
  return table;
}

std::string chances_note(const Diagnosis& diagnosis) {
  const Explanations& all = diagnosis.explanations;
  if (all.effects.empty()) return "";
  return fmt::format(
      "Part of the explanation, with probability: {}. Each candidate, each pair and each triple "
      "was "
      "weighed; those that look alike count as one.",
      chances_in_words(all));
}

}  // namespace trussmap::report
