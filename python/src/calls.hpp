// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Long calls of the library: the interpreter is unlocked, Ctrl-C stops them, progress is told.
#pragma once

#include "trussmap/running.hpp"
#include "trussmap/session.hpp"

#include <cstddef>
#include <pybind11/pybind11.h>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::python {

namespace py = pybind11;

/// Whether a signal's handler (Ctrl-C) has raised; the exception is then set. Locks the
/// interpreter for it.
[[nodiscard]] bool was_interrupted();

/// Keeps BLAS from threads of its own for as long as one of these lives: they would only be in the
/// way of the library's, and change the last digits. Afterwards BLAS, which numpy may share, has as
/// many as before. Of OpenBLAS; another BLAS is left as it is.
class OneBlasThread {
 public:
  OneBlasThread();
  ~OneBlasThread();
  OneBlasThread(const OneBlasThread&) = delete;
  OneBlasThread& operator=(const OneBlasThread&) = delete;
};

/// What `work` returns, other threads of Python running meanwhile. Stopped by Ctrl-C, with what its
/// handler raises (KeyboardInterrupt). `work` must not touch Python.
template <typename Work>
auto unlocked(Work&& work) -> decltype(work()) {
  try {
    const py::gil_scoped_release release;
    const OneBlasThread alone;
    const StopQuestion question(was_interrupted);
    stop_if_asked();
    return work();
  } catch (const StoppedOnRequest&) {
    throw py::error_already_set();
  }
}

/// Tells a callback progress(what, done): the step that begins, and which share of the call has
/// been done before it, 0 to 1. May be called with the interpreter unlocked.
class CallProgress {
 public:
  CallProgress(py::object callback, std::vector<Stage> steps);

  void next();
  /// Within the present step.
  void say(const std::string& what);
  void end();

 private:
  /// Of the present step.
  [[nodiscard]] double share_before() const;
  void tell(const std::string& what, double done);

  py::object callback_;
  std::vector<Stage> steps_;
  std::size_t begun_ = 0;
};

}  // namespace trussmap::python
