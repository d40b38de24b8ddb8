// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// How calls run: on how many threads, and stopped from outside where they take long.
//
// Threads. The figures are the same, to the last digit, whatever their number. A BLAS that starts
// threads of its own would compete with these; OpenBLAS is told by OPENBLAS_NUM_THREADS=1 or
// openblas_set_num_threads(1).
//
// Stopping: a key that was pressed, a window that was closed.
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

/// How many threads calls work on from now on; the caller's own counts. 1 until it is set. A call
/// that comes while another one has the library's threads works on its caller's alone. Throws
/// std::invalid_argument below 1.
void set_threads(int threads);

[[nodiscard]] int threads();

/// As many as the machine runs at once, 1 where that is not known.
[[nodiscard]] int available_threads();

// ----------------------------------------
// Stopping.

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
