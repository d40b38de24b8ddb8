// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Shapes: what an effect goes with, as an expression over the variables of a row.
//
//   + - * / ^ ( )   sin cos tan abs sign min max exp log sqrt   (log is natural)   numbers
//   < > <= >=       1 where it holds, else 0; in brackets beside * and the like: "(speed>0.5)*t"
//
//   "sin(heading)", "payload_kg", "max(0, speed-0.5)", "exp(-((x-12)^2+(y-9)^2)/(2*3^2))"
//
// A shape is read once, when it is made; its values cost no further reading. Copies share what was
// read. The numbers in it that no coefficient scales are its parameters: they are written so that
// they read back to the same bits, so that a shape's text is the shape.
#pragma once

#include "trussmap/recording.hpp"

#include <compare>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trussmap {

namespace effects {
class CompiledShape;
}

/// A number inside a shape that no coefficient scales: a place, a radius, a threshold, a time.
struct ShapeParameter {
  std::string name;  ///< "{name}" in a pattern; in a shape as Shape::parameters has it
  double value = 0.0;

  friend bool operator==(const ShapeParameter&, const ShapeParameter&) = default;
};

/// Copies share what was read. Threads may use one, and its copies, at once.
class Shape {
 public:
  /// Throws std::invalid_argument, in a sentence that names the expression, on what cannot be read.
  /// Reading takes a parser: link trussmap::trussmap.
  Shape(const char* text);         // NOLINT(google-explicit-constructor): a shape is its text
  Shape(const std::string& text);  // NOLINT(google-explicit-constructor)
  /// One that has been read: for the library's own use.
  explicit Shape(std::shared_ptr<const effects::CompiledShape> compiled)
      : compiled_(std::move(compiled)) {}
  /// The pattern with its "{name}"s filled in.
  Shape(const std::string& pattern, const std::vector<ShapeParameter>& parameters);

  [[nodiscard]] const std::string& text() const;

  /// The variables that it speaks of, in alphabetical order.
  [[nodiscard]] const std::vector<std::string>& variables() const;
  [[nodiscard]] bool speaks_of(std::string_view variable) const;

  /// What is subtracted from a variable, under the variable's name (in "x-12" the place x = 12, in
  /// "speed-0.5" the threshold speed = 0.5, in "t-600" a time), what it is compared with
  /// ("speed>0.5"), and what is squared in a shape of x and y (the radius r); in the order of the
  /// text.
  [[nodiscard]] const std::vector<ShapeParameter>& parameters() const;
  /// The first of this name.
  [[nodiscard]] std::optional<double> parameter(std::string_view name) const;

  /// "heading" of "sin(heading)" for the function sin; nothing where that is not the whole shape.
  [[nodiscard]] std::optional<std::string> argument_of(std::string_view function) const;

  /// One value per row. Throws std::invalid_argument, in a sentence that names the expression: a
  /// variable that is not there (and those that are), a value that is not finite (and the first row
  /// where).
  [[nodiscard]] std::vector<double> values(const RowVariables& variables) const;

  /// Shapes of the same text are the same.
  friend bool operator==(const Shape& a, const Shape& b) { return a.text() == b.text(); }
  friend bool operator==(const Shape& a, const char* text) { return a.text() == text; }
  friend std::strong_ordering operator<=>(const Shape& a, const Shape& b) {
    return a.text() <=> b.text();
  }

 private:
  std::shared_ptr<const effects::CompiledShape> compiled_;
};

/// The pattern with "{name}" replaced by each parameter's value: the shortest text that reads back
/// to the same bits, negative numbers in parentheses.
[[nodiscard]] std::string filled(std::string pattern,
                                 const std::vector<ShapeParameter>& parameters);

/// The texts, for files and reports.
[[nodiscard]] std::vector<std::string> texts_of(const std::vector<Shape>& shapes);

}  // namespace trussmap
