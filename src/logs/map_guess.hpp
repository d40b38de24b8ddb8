// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Parts of a first map.toml.
#pragma once

#include "logs/log_survey.hpp"
#include "logs/map_text.hpp"

#include <string>
#include <vector>

namespace trussmap::logs {

/// A field with its whole path.
struct NamedFacts {
  std::string path;
  const LogFieldFacts* facts = nullptr;
  double step = kAbsent;       ///< s between its messages, where known
  std::string topic = {};      ///< empty of a table
  std::string file = {};       ///< where several logs are read as one
  std::string time_unit = {};  ///< that its file's times are in, where the others tell
  std::string type = {};       ///< of its topic
};

/// What was found, for the comment at the top.
struct Guessed {
  bool wheels = false;
  bool places = false;
  int to_state = 0;  ///< figures that nobody can guess
  bool truth = false;
  bool fixes = false;
};

/// By the types of a bag's messages.
[[nodiscard]] Guessed guess_by_types(const LogSurvey& survey, MapText& text);
/// Of the tables beside a bag: what ties the drive to a place. Whether there is such.
[[nodiscard]] bool guess_beside(const std::vector<NamedFacts>& fields, const Guessed& bag,
                                MapText& text);
/// By the names of columns and entries. `table`: with a column of times, or with those of several
/// files, whose `clocks` these are.
[[nodiscard]] Guessed guess_by_names(const std::vector<NamedFacts>& fields, bool table,
                                     const std::vector<LogClockFacts>& clocks, MapText& text);

/// Letters, digits and _ alone, beginning with a letter: what a covariate may be called.
[[nodiscard]] std::string covariate_name(const std::string& path);
/// Whether a topic's name says that it was measured apart from the robot.
[[nodiscard]] bool is_called_truth(const std::string& name);
/// Whether a word of the name begins with one of these, whatever its case; what has other
/// characters in it than letters and digits may stand anywhere; "=l" is the whole word l.
[[nodiscard]] bool has_word(const std::string& name, const std::vector<std::string>& words);
/// Words of a name in small letters, in order: leftTicks_mm is left, ticks, leftticks, mm.
[[nodiscard]] std::vector<std::string> words_of(const std::string& name);

}  // namespace trussmap::logs
