// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Shapes: expressions over the variables of a row.
//
//   + - * / ^ ( )   sin cos tan abs sign min max exp log sqrt   (log is natural)   numbers
//
//   "sin(heading)", "payload_kg", "max(0, speed - 0.5)", "exp(-((x-12)^2+(y-9)^2)/(2*3^2))"
#pragma once

#include "recording/row_variables.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace trussmap {

/// One value per row. Throws std::invalid_argument, in a sentence that names the expression:
/// what cannot be read, a variable that is not there (and those that are), a value that is not
/// finite (and the first row where).
[[nodiscard]] std::vector<double> evaluate_shape(const std::string& expression,
                                                 const RowVariables& variables);

/// The variables that an expression names, in alphabetical order. Throws std::invalid_argument on
/// what cannot be read.
[[nodiscard]] std::vector<std::string> variables_of(const std::string& expression);

}  // namespace trussmap
