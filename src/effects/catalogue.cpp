// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/catalogue.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace trussmap {
namespace {

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at)) {
    text.replace(at, what.size(), by);
    at += by.size();
  }
  return text;
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

/// Effects of a variable that once had entries of their own.
std::string_view present_name(std::string_view name) {
  if (name == "tyre drift with time") return "tyre drift (t)";
  if (name == "tyre drift with distance") return "tyre drift (distance)";
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
  for (const ShapeParameter& one : entry.parameters) {
    text += text.empty() ? "" : ", ";
    text += one.usual == 0.0 ? fmt::format("{}=...", one.name)
                             : fmt::format("{}={:g}", one.name, one.usual);
  }
  return fmt::format("{} ({})", entry.name, text);
}

/// The shapes with the parameters that stand in the brackets.
std::vector<std::string> with_parameters(const CatalogueEntry& entry, const Effect& effect) {
  const auto refuse = [&](const std::string& why) {
    throw std::invalid_argument(
        fmt::format("effect \"{}\" {}, expected \"{}\"; or a channel and a shape of its own",
                    effect.name, why, expected_name(entry)));
  };
  std::vector<std::string> shapes = entry.shape;
  std::vector<std::string_view> given;
  std::string_view rest = taken_apart(effect.name).brackets;
  while (!trimmed(rest).empty()) {
    const std::size_t comma = std::min(rest.find(','), rest.size());
    const std::string_view item = rest.substr(0, comma);
    rest.remove_prefix(std::min(comma + 1, rest.size()));
    const std::size_t equals = std::min(item.find('='), item.size());
    const std::string_view name = trimmed(item.substr(0, equals));
    const std::string_view number = trimmed(item.substr(std::min(equals + 1, item.size())));
    const auto is_it = [name](const ShapeParameter& one) { return one.name == name; };
    if (std::none_of(entry.parameters.begin(), entry.parameters.end(), is_it) ||
        std::find(given.begin(), given.end(), name) != given.end()) {
      refuse(fmt::format("has no parameter \"{}\", or has it twice", name));
    }
    double value = 0.0;
    const auto read = std::from_chars(number.data(), number.data() + number.size(), value);
    if (read.ec != std::errc{} || read.ptr != number.data() + number.size() ||
        !std::isfinite(value)) {
      refuse(fmt::format("has {} = \"{}\", which is no number", name, number));
    }
    given.push_back(name);
    const std::string text = value < 0.0 ? fmt::format("({})", number) : std::string(number);
    for (std::string& shape : shapes) shape = replaced(shape, fmt::format("{{{}}}", name), text);
  }
  if (given.size() < entry.parameters.size()) refuse("lacks a place or threshold");
  return shapes;
}

std::vector<std::string> shapes_of(const CatalogueEntry& entry, const Effect& effect) {
  if (entry.has_parameters()) return with_parameters(entry, effect);
  if (!entry.of_covariate()) return entry.shape;
  const std::string_view covariate = taken_apart(present_name(effect.name)).brackets;
  if (covariate.empty()) {
    throw std::invalid_argument(fmt::format("effect \"{}\" needs a covariate, expected \"{}\"",
                                            effect.name, expected_name(entry)));
  }
  std::vector<std::string> shapes;
  for (const std::string& shape : entry.shape) shapes.push_back(replaced(shape, "{}", covariate));
  return shapes;
}

}  // namespace

bool CatalogueEntry::of_covariate() const {
  return !shape.empty() && shape.front().find("{}") != std::string::npos;
}

const CatalogueEntry* find_entry(std::string_view name) {
  name = present_name(name);
  for (const CatalogueEntry& entry : catalogue()) {
    const bool open = entry.of_covariate() || entry.has_parameters();
    if (entry.name == name || (open && entry.name == taken_apart(name).name)) return &entry;
  }
  return nullptr;
}

std::string name_of(const CatalogueEntry& entry, std::string_view covariate) {
  return fmt::format("{} ({})", entry.name, covariate);
}

std::string name_of(const CatalogueEntry& entry, const std::vector<double>& values) {
  std::string text;
  for (std::size_t k = 0; k < entry.parameters.size(); ++k) {
    text += fmt::format("{}{}={:.10g}", k == 0 ? "" : ", ", entry.parameters[k].name, values.at(k));
  }
  return fmt::format("{} ({})", entry.name, text);
}

Effect resolved(const Effect& effect) {
  Effect result = effect;
  if (effect.channel.empty()) {
    const CatalogueEntry* entry = find_entry(effect.name);
    if (entry == nullptr) {
      throw std::invalid_argument(fmt::format(
          "effect \"{}\" is not in the catalogue, expected a channel and a shape", effect.name));
    }
    result.channel = facts_of(entry->channel).name;
    result.shape = shapes_of(*entry, effect);
  }
  if (!parse_channel(result.channel)) {
    throw std::invalid_argument(
        fmt::format("effect \"{}\" has channel \"{}\", which is unknown, "
                    "expected one of {}",
                    effect.name, result.channel, channel_names()));
  }
  if (!effect.per_session && !effect.coefficients.empty() &&
      effect.coefficients.size() != result.shape.size()) {
    throw std::invalid_argument(
        fmt::format("effect \"{}\" has {} coefficients, expected {}, one "
                    "per shape",
                    effect.name, effect.coefficients.size(), result.shape.size()));
  }
  return result;
}

}  // namespace trussmap
