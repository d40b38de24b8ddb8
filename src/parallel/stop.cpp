// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/running.hpp"

#include <chrono>
#include <utility>

namespace trussmap {
namespace {

constexpr long long kPause = 100'000'000;  // ns

thread_local StopQuestion* of_this_thread = nullptr;

long long now() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

}  // namespace

StopQuestion::StopQuestion(std::function<bool()> asked)
    : asked_(std::move(asked)), before_(of_this_thread) {
  of_this_thread = this;
}

StopQuestion::~StopQuestion() {
  of_this_thread = before_;
}

void StopQuestion::ask() {
  if (!yes_) {
    const long long time = now();
    if (time < next_) return;
    next_ = time + kPause;
    yes_ = asked_();
  }
  if (yes_) throw StoppedOnRequest();
}

void stop_if_asked() {
  if (of_this_thread != nullptr) of_this_thread->ask();
}

}  // namespace trussmap
