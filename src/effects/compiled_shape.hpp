// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a shape's text was read into, behind an interface: code that carries shapes and asks for
// their values needs no parser. compile_shape.cpp alone knows the library that reads expressions.
#pragma once

#include "trussmap/shape.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace trussmap::effects {

/// A shape's text and what reading it has shown (shape.hpp).
struct ShapeFacts {
  std::string text;
  std::vector<std::string> variables;
  std::vector<ShapeParameter> parameters;
  std::string function;  ///< of "f(argument)" where that is the whole text; "" = it is not
  std::string argument;
};

class CompiledShape {
 public:
  explicit CompiledShape(ShapeFacts facts) : facts_(std::move(facts)) {}
  CompiledShape(const CompiledShape&) = delete;
  CompiledShape& operator=(const CompiledShape&) = delete;
  virtual ~CompiledShape() = default;

  [[nodiscard]] const ShapeFacts& facts() const { return facts_; }

  /// `columns`: `rows` values of each of the variables, in their order. Any thread may ask.
  virtual void evaluate(const std::vector<const double*>& columns, std::size_t rows,
                        double* values) const = 0;

 private:
  ShapeFacts facts_;
};

/// Reads an expression. Equal texts share one result as long as a shape has it. Throws
/// std::invalid_argument on what cannot be read.
[[nodiscard]] std::shared_ptr<const CompiledShape> compile_shape(const std::string& text);

/// How often an expression has been read in this process.
[[nodiscard]] std::size_t shapes_read();

}  // namespace trussmap::effects
