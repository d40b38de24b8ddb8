// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far a long run is, on standard error, where that is a terminal: nothing in the first second,
// then a line that is written over and gone in the end.
#pragma once

#include <chrono>
#include <cstdio>
#include <string>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {

/// "12 of 50 seeds, 8 s left".
inline std::string progress_text(int done, int total, const std::string& what, double seconds) {
  const double left = done > 0 ? seconds * (total - done) / done : 0.0;
  const std::string time =
      left < 90.0 ? fmt::format("{:.0f} s", left) : fmt::format("{:.0f} min", left / 60.0);
  return fmt::format("{} of {} {}, {} left", done, total, what, time);
}

class Progress {
 public:
  Progress(int total, std::string what)
      : total_(total), what_(std::move(what)), shown_(::isatty(STDERR_FILENO) == 1) {}
  ~Progress() { clear(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void report(int done) {
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
    if (!shown_ || seconds < 1.0) return;
    clear();
    fmt::print(stderr, "{}", progress_text(done, total_, what_, seconds));
    std::fflush(stderr);
    written_ = true;
  }

 private:
  void clear() {
    if (written_) fmt::print(stderr, "\r\033[K");
    written_ = false;
  }

  int total_;
  std::string what_;
  bool shown_;
  bool written_ = false;
  std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
};

}  // namespace trussmap::app
