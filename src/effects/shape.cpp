// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/shape.hpp"

#include "effects/compiled_shape.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace trussmap {
namespace {

[[noreturn]] void refuse(const Shape& shape, const std::string& why) {
  throw std::invalid_argument("shape \"" + shape.text() + "\" " + why);
}

std::string names_in(const RowVariables& variables) {
  std::string text;
  for (const auto& [name, values] : variables) text += (text.empty() ? "" : ", ") + name;
  return text;
}

/// "(x = 0, y = 5)", the variables in one row.
std::string state_in(std::size_t row, const std::vector<std::string>& names,
                     const std::vector<const double*>& columns) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k) {
    text += (k == 0 ? "" : ", ") + names[k] + " = " + text::short_text(columns[k][row]);
  }
  return "(" + text + ")";
}

}  // namespace

const std::string& Shape::text() const {
  return compiled_->facts().text;
}

const std::vector<std::string>& Shape::variables() const {
  return compiled_->facts().variables;
}

bool Shape::speaks_of(std::string_view variable) const {
  const std::vector<std::string>& names = variables();
  return std::find(names.begin(), names.end(), variable) != names.end();
}

const std::vector<ShapeParameter>& Shape::parameters() const {
  return compiled_->facts().parameters;
}

std::optional<double> Shape::parameter(std::string_view name) const {
  for (const ShapeParameter& one : parameters()) {
    if (one.name == name) return one.value;
  }
  return std::nullopt;
}

std::optional<std::string> Shape::argument_of(std::string_view function) const {
  const effects::ShapeFacts& facts = compiled_->facts();
  if (facts.function.empty() || facts.function != function) return std::nullopt;
  return facts.argument;
}

std::vector<double> Shape::values(const RowVariables& variables) const {
  const std::vector<std::string>& names = this->variables();
  std::vector<const double*> columns;
  for (const std::string& name : names) {
    const auto found = variables.find(name);
    if (found == variables.end()) {
      refuse(*this,
             "names \"" + name + "\", which is unknown, expected one of " + names_in(variables));
    }
    columns.push_back(found->second.data());
  }
  std::vector<double> result(variables.empty() ? 0 : variables.begin()->second.size());
  compiled_->evaluate(columns, result.size(), result.data());
  const auto lost = std::find_if_not(result.begin(), result.end(),
                                     [](double value) { return std::isfinite(value); });
  if (lost != result.end()) {
    const auto row = static_cast<std::size_t>(lost - result.begin());
    refuse(*this, "has no finite value in row " + std::to_string(row + 1) + " of the drive " +
                      state_in(row, names, columns) + ", expected one in every row");
  }
  return result;
}

std::string filled(std::string pattern, const std::vector<ShapeParameter>& parameters) {
  for (const ShapeParameter& one : parameters) {
    const std::string open = "{" + one.name + "}";
    const std::string number = text::shortest_text(one.value);
    const std::string text = number.starts_with('-') ? "(" + number + ")" : number;
    for (std::size_t at = pattern.find(open); at != std::string::npos; at = pattern.find(open)) {
      pattern.replace(at, open.size(), text);
    }
  }
  return pattern;
}

std::vector<std::string> texts_of(const std::vector<Shape>& shapes) {
  std::vector<std::string> texts;
  texts.reserve(shapes.size());
  for (const Shape& shape : shapes) texts.push_back(shape.text());
  return texts;
}

}  // namespace trussmap
