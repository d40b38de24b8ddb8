// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "progress.hpp"

#include "terminal.hpp"
#include "trussmap/table.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

constexpr double kQuiet = 1.0;  // s before the first line
constexpr std::chrono::milliseconds kBeat{250};
constexpr std::size_t kWidth = 78;  // a line that wraps could not be written over
constexpr double kNearlyDone = 0.05;

std::string time_text(double seconds) {
  return seconds < 90.0 ? fmt::format("{:.0f} s", std::max(1.0, seconds))
                        : fmt::format("{:.0f} min", seconds / 60.0);
}

}  // namespace

void ProgressClock::next(double seconds) {
  begun_ = std::min(begun_ + 1, steps_.size());
  since_ = seconds;
  said_.clear();
  done_ = 0;
  total_ = 0;
}

void ProgressClock::insert(const std::vector<Stage>& steps) {
  steps_.insert(steps_.begin() + static_cast<std::ptrdiff_t>(begun_), steps.begin(), steps.end());
}

void ProgressClock::report(int done, int total) {
  done_ = done;
  total_ = total;
}

double ProgressClock::share_before() const {
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < begun_; ++k) sum += steps_[k].share;
  return sum;
}

double ProgressClock::share_after() const {
  double sum = 0.0;
  for (std::size_t k = begun_; k < steps_.size(); ++k) sum += steps_[k].share;
  return sum;
}

std::optional<double> ProgressClock::left(double seconds) const {
  if (begun_ == 0) return std::nullopt;
  const double share = steps_[begun_ - 1].share;
  const double spent = seconds - since_;
  double whole = 0.0;  // of this step
  if (done_ > 0) {
    whole = spent * total_ / done_;
  } else if (share_before() > 0.0 && since_ > 0.0) {
    whole = std::max(since_ / share_before() * share, spent / (1.0 - kNearlyDone));
  } else {
    return std::nullopt;
  }
  return whole - spent + (share > 0.0 ? whole / share * share_after() : 0.0);
}

std::string ProgressClock::line(double seconds) const {
  if (begun_ == 0) return "";
  std::string text = said_.empty() ? steps_[begun_ - 1].what : said_;
  if (total_ > 0) text = fmt::format("{} of {} {}", done_, total_, text);
  std::string rest;
  if (steps_.size() > 1) rest = fmt::format(" (step {} of {})", begun_, steps_.size());
  const std::optional<double> still = left(seconds);
  rest += still ? ", " + time_text(*still) + " left" : ", " + time_text(seconds) + " so far";
  return shortened(text, kWidth - rest.size()) + rest;
}

Progress::Progress(std::vector<Stage> steps) : clock_(std::move(steps)) {
  if (can_rewrite_lines(stderr)) thread_ = std::thread([this] { run(); });
}

Progress::~Progress() {
  end();
}

double Progress::seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
}

void Progress::next() {
  const std::scoped_lock lock(mutex_);
  clock_.next(seconds());
}

void Progress::insert(const std::vector<Stage>& steps) {
  const std::scoped_lock lock(mutex_);
  clock_.insert(steps);
}

void Progress::say(const std::string& what) {
  const std::scoped_lock lock(mutex_);
  clock_.say(what);
}

void Progress::report(int done, int total) {
  const std::scoped_lock lock(mutex_);
  clock_.report(done, total);
}

void Progress::end() {
  if (!thread_.joinable()) return;
  {
    const std::scoped_lock lock(mutex_);
    end_ = true;
  }
  ended_.notify_all();
  thread_.join();
  if (written_) fmt::print(stderr, "\r\033[K");
  std::fflush(stderr);
}

void Progress::run() {
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, kBeat, [this] { return end_; })) {
    if (seconds() < kQuiet) continue;
    fmt::print(stderr, "\r\033[K{}", clock_.line(seconds()));
    std::fflush(stderr);
    written_ = true;
  }
}

}  // namespace trussmap::app
