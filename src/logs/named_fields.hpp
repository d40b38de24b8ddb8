// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Guesses by the names of columns and entries. Each writes its tables into a first map.toml, and
// takes the fields that it needs. What never changes tells nothing, whatever it is called, and is
// never taken. Where several files are read, what belongs together is of one file, and the file's
// name speaks for columns whose own do not: x of mocap.csv.
#pragma once

#include "logs/map_guess.hpp"
#include "logs/units.hpp"

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::logs {

/// A log's fields, and which of them are taken.
class FreeFields {
 public:
  using Words = std::vector<std::string>;

  explicit FreeFields(const std::vector<NamedFacts>& fields) : fields_(&fields) {}

  [[nodiscard]] const std::vector<NamedFacts>& all() const { return *fields_; }
  [[nodiscard]] bool is_taken(const NamedFacts& field) const {
    return taken_.contains({field.file, field.path});
  }
  /// Those that change, are not taken, and are of the file that is looked at.
  [[nodiscard]] bool is_free(const NamedFacts& field) const;
  /// The first free field that has a word of each list, and none of `without`; where none has, one
  /// whose file's name has what its own lacks.
  [[nodiscard]] const NamedFacts* find(const std::vector<Words>& words, const Words& without,
                                       bool text = false) const;
  const NamedFacts* take(const std::vector<Words>& words, const Words& without = {});
  void mark_taken(const NamedFacts& field) { taken_.insert({field.file, field.path}); }
  /// From now on fields of one file alone; of all again: nothing.
  void look_at(std::optional<std::string> file) { file_ = std::move(file); }

 private:
  const std::vector<NamedFacts>* fields_;
  std::set<std::pair<std::string, std::string>> taken_;
  std::optional<std::string> file_;
};

[[nodiscard]] bool is_of(const std::optional<Unit>& unit,
                         std::initializer_list<Quantity> quantities);
/// A sum so far has a range of many steps; what is added a row has not.
[[nodiscard]] bool is_cumulative(const LogFieldFacts& facts);
/// What ranges over more than a turn in radians.
[[nodiscard]] bool looks_like_degrees(const LogFieldFacts& facts);
/// 'x', 'y', 'z' or 'w' of a vector's or quaternion's component: linear.x, gyro_z, qw; 0 of others.
[[nodiscard]] char axis_of(const std::string& path);
/// A name without the file's ending.
[[nodiscard]] std::string stem_of(const std::string& file);
/// The line that says of which file a table's fields are, where there are several.
void write_file_of(const NamedFacts& field, MapText& text);

/// [time], or [[time]] for each file. How many are left to state.
int guess_times(FreeFields& fields, const std::vector<LogClockFacts>& clocks, MapText& text);
/// Of messages that have no times of their own, or those of the log.
void guess_log_time(const FreeFields& fields, MapText& text);
/// How many figures are left to state; nothing where there are no wheels.
std::optional<int> guess_wheels(FreeFields& fields, MapText& text);
/// The same where there are none: poses that move, or speeds.
/// FRC's ChassisSpeeds, or swerve modules; `holonomic_alone`: of robots that go sideways.
std::optional<int> guess_body_speeds(const FreeFields& fields, bool holonomic_alone, MapText& text);
/// What a robot makes of its wheels is no further sensor.
void pass_over_body_speeds(FreeFields& fields);
std::optional<int> guess_odometry(FreeFields& fields, MapText& text);
/// Beside wheels: what sums them up, or estimates, is no sensor of its own.
void pass_over_odometries(FreeFields& fields, MapText& text);
void guess_headings(FreeFields& fields, MapText& text);
/// Of tables without a header: left and right, if two columns look like wheels.
[[nodiscard]] std::optional<std::pair<const NamedFacts*, const NamedFacts*>> unnamed_wheels(
    const FreeFields& fields);
/// What is left of their columns, as comments.
void list_unnamed(const FreeFields& fields, MapText& text);
/// Whether there are some.
bool guess_sightings(FreeFields& fields, MapText& text);
bool guess_fixes(FreeFields& fields, MapText& text);
bool guess_truth(FreeFields& fields, MapText& text);

}  // namespace trussmap::logs
