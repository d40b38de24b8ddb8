// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Stopping a call that takes long, from outside: a key that was pressed, a window that was closed.
//
//   const StopQuestion question([&] { return was_pressed(); });
//   diagnose(recordings, model);   // throws StoppedOnRequest soon after it was
//
// The question is asked within loops and between steps of a descent, some ten times a second where
// the work is in small pieces; a factorisation of a very large map is not interrupted.
#pragma once

#include <exception>
#include <functional>

namespace trussmap {

/// What a call throws that was asked to stop. It leaves what it was given as it was.
class StoppedOnRequest : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "stopped on request"; }
};

/// As long as it lives, the library's calls on this thread ask it whether to stop, until it has
/// once said yes; questions of the same thread end in reverse order.
class StopQuestion {
 public:
  /// `asked` is called on this thread, and may be slow: a tenth of a second passes between two
  /// calls. It must not throw.
  explicit StopQuestion(std::function<bool()> asked);
  ~StopQuestion();
  StopQuestion(const StopQuestion&) = delete;
  StopQuestion& operator=(const StopQuestion&) = delete;

  /// Throws StoppedOnRequest where the answer is yes, or was.
  void ask();

 private:
  std::function<bool()> asked_;
  StopQuestion* before_ = nullptr;
  long long next_ = 0;  ///< ns of the steady clock, when to ask next
  bool yes_ = false;
};

/// Asks the question of this thread, if it has one: for long loops of a caller's own. Costs next to
/// nothing where there is none, some 30 ns else.
void stop_if_asked();

}  // namespace trussmap
