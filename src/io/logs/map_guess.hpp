// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Parts of a first map.toml.
#pragma once

#include "io/logs/log_survey.hpp"
#include "io/logs/map_text.hpp"

#include <string>
#include <vector>

namespace trussmap {

/// A field with its whole path.
struct NamedFacts {
  std::string path;
  const LogFieldFacts* facts = nullptr;
  double step = kAbsent;  ///< s between its messages, where known
};

/// What was found, for the comment at the top.
struct Guessed {
  bool wheels = false;
  bool places = false;
  int to_state = 0;  ///< figures that nobody can guess
};

/// By the types of a bag's messages.
[[nodiscard]] Guessed guess_by_types(const LogSurvey& survey, MapText& text);
/// By the names of columns and entries. `table`: with a column of times.
[[nodiscard]] Guessed guess_by_names(const std::vector<NamedFacts>& fields, bool table,
                                     MapText& text);

/// Letters, digits and _ alone, beginning with a letter: what a covariate may be called.
[[nodiscard]] std::string covariate_name(const std::string& path);
/// Whether a topic's name says that it was measured apart from the robot.
[[nodiscard]] bool is_called_truth(const std::string& name);
/// Whether a word of the name begins with one of these, whatever its case; what has other
/// characters in it than letters and digits may stand anywhere.
[[nodiscard]] bool has_word(const std::string& name, const std::vector<std::string>& words);

}  // namespace trussmap
