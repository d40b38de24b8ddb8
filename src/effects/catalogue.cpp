// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"

#include "effects/catalogue_record.hpp"
#include "text/edit_distance.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
using namespace effects;

namespace {

/// A pattern with a covariate's name in its "{}"s.
std::string of_covariate(std::string pattern, std::string_view covariate) {
  constexpr std::string_view kOpen = "{}";
  for (std::size_t at = pattern.find(kOpen); at != std::string::npos; at = pattern.find(kOpen)) {
    pattern.replace(at, kOpen.size(), covariate);
  }
  return pattern;
}

/// "load on both wheels (payload_kg)" -> "load on both wheels", "payload_kg".
struct Named {
  std::string_view name;
  std::string_view brackets;
};

Named taken_apart(std::string_view name) {
  const std::size_t open = name.rfind(" (");
  if (open == std::string_view::npos || !name.ends_with(')')) return {name, {}};
  return {name.substr(0, open), name.substr(open + 2, name.size() - open - 3)};
}

/// What once had entries of their own.
std::string_view present_name(std::string_view name) {
  for (const CatalogueRecord& record : catalogue_records()) {
    for (const FormerName& one : record.former_names) {
      if (one.former == name) return one.present;
    }
  }
  return name;
}

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  return text;
}

/// The pattern of a name: "slippery patch (x=..., y=..., r=3)".
std::string expected_name(const CatalogueEntry& entry) {
  if (entry.of_covariate()) return fmt::format("{} (COLUMN)", entry.name);
  std::string text;
  for (const OpenParameter& one : entry.parameters) {
    text += text.empty() ? "" : ", ";
    text += one.usual == 0.0 ? fmt::format("{}=...", one.name)
                             : fmt::format("{}={:g}", one.name, one.usual);
  }
  return fmt::format("{} ({})", entry.name, text);
}

/// The parameters that stand in a name's brackets.
std::vector<ShapeParameter> parameters_in(std::string_view effect, const CatalogueEntry& entry) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(
        fmt::format("effect \"{}\" {}, expected \"{}\"; or a channel and a shape of its own",
                    effect, why, expected_name(entry)));
  };
  std::vector<ShapeParameter> given;
  std::string_view rest = taken_apart(effect).brackets;
  while (!trimmed(rest).empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view item = rest.substr(0, comma);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
    const std::size_t equals = std::min(item.find('='), item.size());
    const std::string_view name = trimmed(item.substr(0, equals));
    const std::string_view number = trimmed(item.substr(std::min(equals + 1, item.size())));
    const auto is_it = [name](const auto& one) { return one.name == name; };
    if (std::none_of(entry.parameters.begin(), entry.parameters.end(), is_it) ||
        std::any_of(given.begin(), given.end(), is_it)) {
      refuse(fmt::format("has no parameter \"{}\", or has it twice", name));
    }
    double value = 0.0;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), value);
    if (read.ec != std::errc{} || read.ptr != number.data() + number.size() ||
        !std::isfinite(value)) {
      refuse(fmt::format("has {} = \"{}\", which is no number", name, number));
    }
    given.push_back({std::string(name), value});
  }
  if (given.size() < entry.parameters.size()) refuse("lacks a place or threshold");
  return given;
}

}  // namespace

bool CatalogueEntry::of_covariate() const {
  return !pattern.empty() && pattern.front().find("{}") != std::string::npos;
}

const std::vector<CatalogueEntry>& catalogue() {
  static const std::vector<CatalogueEntry> entries = [] {
    std::vector<CatalogueEntry> all;
    for (const CatalogueRecord& one : catalogue_records()) all.push_back(one.entry);
    return all;
  }();
  return entries;
}

const CatalogueEntry* find_entry(std::string_view name) {
  const CatalogueRecord* record = find_record(name);
  if (record == nullptr) return nullptr;
  return &catalogue()[static_cast<std::size_t>(record - catalogue_records().data())];
}

}  // namespace trussmap

namespace trussmap::effects {

const CatalogueRecord* find_record(std::string_view name) {
  name = present_name(name);
  for (const CatalogueRecord& record : catalogue_records()) {
    const CatalogueEntry& entry = record.entry;
    const bool open = entry.of_covariate() || entry.has_parameters();
    if (entry.name == name || (open && entry.name == taken_apart(name).name)) return &record;
  }
  return nullptr;
}

}  // namespace trussmap::effects

namespace trussmap {

std::string what_was_meant(std::string_view name) {
  const std::size_t space = std::min(name.find(' '), name.size());
  if (parse_channel(name.substr(0, space)) && name.substr(space).starts_with(" with ")) {
    return "; what diagnose names so has its channel and shape beside it";
  }
  const std::string_view given = taken_apart(name).name;
  const CatalogueEntry* nearest = nullptr;
  std::size_t apart = given.size() / 3 + 1;  // from here on it is another word
  for (const CatalogueEntry& entry : catalogue()) {
    const std::size_t distance = text::edit_distance(given, entry.name);
    if (distance >= apart) continue;
    nearest = &entry;
    apart = distance;
  }
  if (nearest == nullptr) return "";
  const bool open = nearest->of_covariate() || nearest->has_parameters();
  return fmt::format("; is \"{}\" meant?",
                     open ? expected_name(*nearest) : std::string(nearest->name));
}

std::string name_of(const CatalogueEntry& entry, std::string_view covariate) {
  return fmt::format("{} ({})", entry.name, covariate);
}

std::string name_of(const CatalogueEntry& entry, const std::vector<ShapeParameter>& parameters) {
  std::string text;
  for (const ShapeParameter& one : parameters) {
    text += (text.empty() ? "" : ", ") + one.name + "=" + text::shortest_text(one.value);
  }
  return fmt::format("{} ({})", entry.name, text);
}

Effect catalogue_effect(const CatalogueEntry& entry) {
  Effect effect{std::string(entry.name), entry.channel, {}, {}};
  for (const std::string& pattern : entry.pattern) effect.shape.emplace_back(pattern);
  return effect;
}

Effect catalogue_effect(const CatalogueEntry& entry, std::string_view covariate) {
  Effect effect{name_of(entry, covariate), entry.channel, {}, {}};
  for (const std::string& pattern : entry.pattern) {
    effect.shape.emplace_back(of_covariate(pattern, covariate));
  }
  return effect;
}

Effect catalogue_effect(const CatalogueEntry& entry,
                        const std::vector<ShapeParameter>& parameters) {
  Effect effect{name_of(entry, parameters), entry.channel, {}, {}};
  for (const std::string& pattern : entry.pattern) effect.shape.emplace_back(pattern, parameters);
  return effect;
}

Effect catalogue_effect(std::string_view name, std::vector<double> coefficients) {
  const CatalogueEntry* entry = find_entry(name);
  if (entry == nullptr) {
    throw std::invalid_argument(
        fmt::format("effect \"{}\" is not in the catalogue, expected a channel and a shape{}", name,
                    what_was_meant(name)));
  }
  const std::string_view brackets = taken_apart(present_name(name)).brackets;
  if (entry->of_covariate() && brackets.empty()) {
    throw std::invalid_argument(fmt::format("effect \"{}\" needs a covariate, expected \"{}\"",
                                            name, expected_name(*entry)));
  }
  Effect effect = entry->of_covariate()     ? catalogue_effect(*entry, brackets)
                  : entry->has_parameters() ? catalogue_effect(*entry, parameters_in(name, *entry))
                                            : catalogue_effect(*entry);
  if (!coefficients.empty() && coefficients.size() != effect.shape.size()) {
    throw std::invalid_argument(
        fmt::format("effect \"{}\" has {} coefficients, expected {}, one per shape", name,
                    coefficients.size(), effect.shape.size()));
  }
  effect.name = name;
  effect.coefficients = std::move(coefficients);
  return effect;
}

}  // namespace trussmap
