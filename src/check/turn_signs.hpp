// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Quantities that turn with or against each other: which of them has to be wrong?
#pragma once

#include "check/findings.hpp"

#include <string>
#include <vector>

namespace trussmap::check {

/// What may count its turns the other way round.
enum class Turning {
  wheels,
  compass,
  gyro,
  bearings,
  yaws,
  survey,
  fixes,
  whole_truth,  ///< both of the next
  truth_heading,
  truth_course
};

/// Signs by which pairs of quantities agree; which quantity, alone, explains those that do not?
class TurnSigns {
 public:
  /// `words`: what is seen where the sign is negative; 0 says nothing.
  void add(Turning a, Turning b, int sign, const char* words);

  /// One where it explains all that is contradicted; several where each would, or none does.
  [[nodiscard]] std::vector<Turning> culprits() const;
  [[nodiscard]] const std::string& seen() const { return seen_; }

 private:
  struct Known {
    Turning a;
    Turning b;
    int sign;
  };
  [[nodiscard]] std::vector<Turning> suspects() const;

  std::vector<Known> known_;
  std::string seen_;
};

/// The finding that they are.
void blame(Checked& checked, const TurnSigns& signs);

}  // namespace trussmap::check
