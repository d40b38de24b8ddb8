// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "calls.hpp"

#include <mutex>

// Of OpenBLAS, where it is the BLAS in use.
extern "C" void openblas_set_num_threads(int threads) __attribute__((weak));
extern "C" int openblas_get_num_threads() __attribute__((weak));

namespace trussmap::python {
namespace {

std::mutex blas_mutex;
int blas_calls = 0;    // under way
int blas_threads = 1;  // before the first of them

bool has_openblas() {
  return openblas_set_num_threads != nullptr && openblas_get_num_threads != nullptr;
}

}  // namespace

OneBlasThread::OneBlasThread() {
  if (!has_openblas()) return;
  const std::scoped_lock lock(blas_mutex);
  if (blas_calls++ > 0) return;
  blas_threads = openblas_get_num_threads();
  openblas_set_num_threads(1);
}

OneBlasThread::~OneBlasThread() {
  if (!has_openblas()) return;
  const std::scoped_lock lock(blas_mutex);
  if (--blas_calls == 0) openblas_set_num_threads(blas_threads);
}

bool was_interrupted() {
  const py::gil_scoped_acquire lock;
  return PyErr_CheckSignals() != 0;
}

CallProgress::CallProgress(py::object callback, std::vector<Stage> steps)
    : callback_(std::move(callback)), steps_(std::move(steps)) {
  if (!callback_.is_none() && PyCallable_Check(callback_.ptr()) == 0) {
    throw py::type_error("progress: expected a function of (what, done), or None");
  }
}

void CallProgress::next() {
  ++begun_;
  tell(begun_ <= steps_.size() ? steps_[begun_ - 1].what : std::string(), share_before());
}

void CallProgress::say(const std::string& what) {
  tell(what, share_before());
}

double CallProgress::share_before() const {
  double all = 0.0;
  double before = 0.0;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    if (k + 1 < begun_) before += steps_[k].share;
    all += steps_[k].share;
  }
  return all > 0.0 ? before / all : 0.0;
}

void CallProgress::end() {
  tell("done", 1.0);
}

void CallProgress::tell(const std::string& what, double done) {
  if (callback_.is_none()) return;
  const py::gil_scoped_acquire lock;
  callback_(what, done);
}

}  // namespace trussmap::python
