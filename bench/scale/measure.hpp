// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Measuring rivals beside each other on a machine that others use as well: processor time instead
// of the clock's, rivals in turn instead of one after the other, each in a process of its own, and
// the least of several runs.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace trussmap::bench {

/// Processor time of this thread, s.
[[nodiscard]] double cpu_seconds();

/// Stages of a run in the order in which they came, s each.
class Stages {
 public:
  /// What has passed since the last call, or the object was made, belongs to this stage.
  void end(const std::string& name);

  struct Stage {
    std::string name;
    double seconds = 0.0;
  };
  std::vector<Stage> stages;

  [[nodiscard]] double total() const;
  /// Zero where there is no such stage.
  [[nodiscard]] double of(const std::string& name) const;

 private:
  double last_ = cpu_seconds();
};

struct Run {
  Stages stages;
  double answer = 0.0;     ///< whatever the rivals must agree on
  double megabytes = 0.0;  ///< most memory that the process had, beyond what it began with
};

/// In a process of its own. Throws std::runtime_error if that fails.
[[nodiscard]] Run run_apart(const std::function<double(Stages&)>& work);

struct Rival {
  std::string name;
  std::function<double(Stages&)> work;
};

/// `repetitions` rounds of all rivals in turn. Of each rival the least time of every stage and the
/// most memory.
[[nodiscard]] std::vector<Run> race(const std::vector<Rival>& rivals, int repetitions);

/// A line per rival: its stages in ms, their sum, memory, and the total over that of the first.
void print(const std::vector<Rival>& rivals, const std::vector<Run>& runs);

/// "must hold" lines: `what` is `value`, wanted at most `limit`.
void verdict(const std::string& what, double value, double limit);

[[nodiscard]] double percentile(std::vector<double> values, double share);

}  // namespace trussmap::bench
