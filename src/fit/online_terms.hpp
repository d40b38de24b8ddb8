// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Coefficients with their shapes, for one row at a time: a shape's variables are looked up once.
#pragma once

#include "drive/causal_variables.hpp"
#include "trussmap/channel.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/shape.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trussmap::fitting {

struct OnlineTerm {
  Channel channel = Channel::travel;
  double coefficient = 0.0;
  Shape shape;
  std::string effect;
  std::optional<double> constant = std::nullopt;  ///< the shape's value, where it has no variable
};

/// Where a variable's value comes from: a row, a pose, or else the covariates.
struct VariableSource {
  std::string_view name = {};
  double drive::CausalRow::*middle = nullptr;
  double drive::CausalRow::*end = nullptr;
  double Pose::*pose = nullptr;
  std::size_t covariate = 0;
};

/// Terms that are taken at the same instant of a row, with the variables that they speak of.
class OnlineTerms {
 public:
  enum class Instant { middle, end };
  explicit OnlineTerms(Instant at) : at_(at) {}

  /// Throws std::invalid_argument where the shape names a variable that is neither a row's nor one
  /// of the covariates', or is a constant that is not finite. Coefficients of 0 are left out.
  void add(OnlineTerm term, const std::vector<std::string>& covariates);

  /// What the shapes see from here on.
  void fill(const drive::CausalRow& row, const Pose& pose, std::span<const double> covariates);

  /// A shape's value. Throws std::invalid_argument, naming the effect, where it is not finite.
  [[nodiscard]] double value(const OnlineTerm& term) const;

  [[nodiscard]] const std::vector<OnlineTerm>& all() const { return terms_; }
  /// Whether a shape speaks of heading, x or y.
  [[nodiscard]] bool see_the_pose() const;

 private:
  Instant at_;
  std::vector<OnlineTerm> terms_;
  RowVariables columns_;                 ///< one value each
  std::vector<VariableSource> sources_;  ///< in the order of the columns
};

}  // namespace trussmap::fitting
