// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far a long run is, on standard error, where that is a terminal: nothing in the first second,
// then a line that is written over, and gone in the end.
//
//   looking for what is missing (step 3 of 4), 12 s left
//
// The steps are known beforehand, each with its usual share of the time; the time left follows from
// how long the steps before have taken, or from the parts that a step reports. A clock of its own
// keeps the line alive while the library works.
#pragma once

#include "trussmap/session.hpp"

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace trussmap::app {

/// Where a run of steps is. Without a terminal, so that it can be tested.
class ProgressClock {
 public:
  explicit ProgressClock(std::vector<Stage> steps) : steps_(std::move(steps)) {}

  /// The next step begins, the first one with the first call. `seconds`: since the run began.
  void next(double seconds);
  /// More steps than were known, after the present one.
  void insert(const std::vector<Stage>& steps);
  /// What the present step is about at the moment.
  void say(std::string what) { said_ = std::move(what); }
  /// So many of its parts are done.
  void report(int done, int total);

  /// Seconds from now to the end of the run; none where nothing tells.
  [[nodiscard]] std::optional<double> left(double seconds) const;
  [[nodiscard]] std::string line(double seconds) const;

 private:
  [[nodiscard]] double share_before() const;
  [[nodiscard]] double share_after() const;

  std::vector<Stage> steps_;
  std::size_t begun_ = 0;  ///< how many have begun
  double since_ = 0.0;     ///< when the present one did
  std::string said_;
  int done_ = 0;
  int total_ = 0;
};

class Progress {
 public:
  /// Nothing has begun: call next().
  explicit Progress(std::vector<Stage> steps);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void next();
  void insert(const std::vector<Stage>& steps);
  void say(const std::string& what);
  void report(int done, int total);
  /// Takes the line away; before anything is printed.
  void end();

 private:
  [[nodiscard]] double seconds() const;
  void run();

  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  bool written_ = false;
  ProgressClock clock_;
  std::thread thread_;  ///< where there is a terminal
};

}  // namespace trussmap::app
