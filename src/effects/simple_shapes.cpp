// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "effects/simple_shapes.hpp"

#include "effects/compiled_shape.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace trussmap::effects {
namespace {

class Constant : public CompiledShape {
 public:
  Constant() : CompiledShape({"1", {}, {}, "", ""}) {}

  void evaluate(const std::vector<const double*>& /*columns*/, std::size_t rows,
                double* values) const override {
    std::fill(values, values + rows, 1.0);
  }
};

class Wave : public CompiledShape {
 public:
  Wave(const std::string& function, const std::string& variable, double (*wave)(double))
      : CompiledShape({function + "(" + variable + ")", {variable}, {}, function, variable}),
        wave_(wave) {}

  void evaluate(const std::vector<const double*>& columns, std::size_t rows,
                double* values) const override {
    std::transform(columns[0], columns[0] + rows, values, wave_);
  }

 private:
  double (*wave_)(double);
};

}  // namespace

Shape constant_shape() {
  return Shape(std::make_shared<const Constant>());
}

Shape sine_of(const std::string& variable) {
  return Shape(std::make_shared<const Wave>("sin", variable, [](double x) { return std::sin(x); }));
}

Shape cosine_of(const std::string& variable) {
  return Shape(std::make_shared<const Wave>("cos", variable, [](double x) { return std::cos(x); }));
}

}  // namespace trussmap::effects
