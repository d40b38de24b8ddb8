// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Constants to paste, as text and as a part of a page. The text's lines are TOML, and those of
// other programs in their own syntax.
#include "report/page.hpp"
#include "report/page_words.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/wording.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

namespace trussmap {
using namespace report;

namespace {

constexpr const char* kFactor = "times";
constexpr const char* kMultiplied = "Road Runner";  // fields of a program, not a file of parameters

std::string toml_key(const std::string& name) {
  std::string key = name;
  std::replace(key.begin(), key.end(), ' ', '_');
  const bool bare = std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return (c < 128 && std::isalnum(c) != 0) || c == '_' || c == '-';
  });
  return bare ? key
              : nlohmann::json(name).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string meaning(const RobotConstant& one) {
  if (one.note.empty()) return one.unit;
  return one.unit + (one.unit == kFactor ? " " : ", ") + one.note;
}

/// A factor with six decimals; else three digits.
std::string stack_number(double value) {
  constexpr double kFactors = 0.05;
  return std::abs(value) >= kFactors ? fmt::format("{:.6f}", value) : fmt::format("{:.3g}", value);
}

std::string line_of(const StackValue& one) {
  const std::string value = stack_number(one.value);
  const bool code = one.stack == kMultiplied;
  std::string line = code             ? fmt::format("{} *= {};", one.key, value)
                     : one.multiplies ? fmt::format("{}: times {}", one.key, value)
                                      : fmt::format("{}: {}", one.key, value);
  if (!one.note.empty()) line += fmt::format("  {} {}", code ? "//" : "#", one.note);
  return line;
}

std::string stays_in_the_model(const std::vector<std::string>& effects) {
  return fmt::format("no constant undoes {}: {} in the model", fmt::join(effects, ", "),
                     effects.size() == 1 ? "it stays" : "they stay");
}

PageTable constants_table(const RobotConstants& constants) {
  PageTable table;
  table.caption = "Constants";
  table.headings = {"", "old", "new", "standard error", "unit"};
  for (const RobotConstant& one : constants.list) {
    const QuantityText now = quantity_text(one.after, one.sd);
    table.rows.push_back({capitalised(one.name), fmt::format("{:.6g}", one.before),
                          one.determined ? now.value : "not determined",
                          one.determined ? now.error : "", meaning(one)});
  }
  return table;
}

PageTable stacks_table(const RobotConstants& constants) {
  PageTable table;
  table.caption = "In the words of other programs";
  table.headings = {"", "", "value"};
  table.texts = 2;
  for (const StackValue& one : constants.stacks) {
    table.rows.push_back({one.stack, one.note.empty() ? one.key : one.key + " (" + one.note + ")",
                          (one.multiplies ? "\u00d7 " : "") + stack_number(one.value)});
  }
  return table;
}

}  // namespace

std::string constants_text(const RobotConstants& constants, TextStyle style) {
  if (constants.empty()) return "";
  TextTable table{{Align::left, Align::left, Align::left}, {}, false, 2};
  std::string missing;
  for (const RobotConstant& one : constants.list) {
    if (!one.determined) {
      missing += fmt::format("  # {}: not determined: {}\n", toml_key(one.name), one.note);
      continue;
    }
    const QuantityText now = quantity_text(one.after, one.sd);
    table.rows.push_back(
        {toml_key(one.name), "= " + now.value,
         fmt::format("# {}{}{}", now.error.empty() ? "" : "+- " + now.error + ", ",
                     std::isfinite(one.before) ? fmt::format("was {:.6g}; ", one.before) : "",
                     meaning(one))});
  }
  std::string text = "\nConstants to paste (TOML)\n" + table_text(table, style) + missing;
  if (!constants.others.empty()) text += "  # " + stays_in_the_model(constants.others) + "\n";
  for (const std::string& doubt : constants.doubts) text += "  # " + doubt + "\n";
  if (constants.one_wheel) text += "  # " + in_words(*constants.one_wheel) + "\n";
  std::string stack;
  for (const StackValue& one : constants.stacks) {
    if (one.stack != stack) text += one.stack + "\n";
    stack = one.stack;
    text += "  " + line_of(one) + "\n";
  }
  return text;
}

Page with_constants(const Page& page, const RobotConstants& constants) {
  if (constants.empty()) return page;
  PageContent content = page.content();
  PageSection section{"Constants to paste", {}};
  if (constants.one_wheel) {
    section.blocks.emplace_back(capitalised(typeset(in_words(*constants.one_wheel))) + ".");
  }
  section.blocks.emplace_back(constants_table(constants));
  if (!constants.stacks.empty()) section.blocks.emplace_back(stacks_table(constants));
  if (!constants.others.empty()) {
    section.blocks.emplace_back(capitalised(stays_in_the_model(constants.others)) + ".");
  }
  for (const std::string& doubt : constants.doubts) {
    section.blocks.emplace_back(capitalised(doubt) + ".");
  }
  const auto tables = std::find_if(content.sections.begin(), content.sections.end(),
                                   [](const PageSection& one) { return one.title == "Tables"; });
  content.sections.insert(tables, std::move(section));
  return content;
}

}  // namespace trussmap
