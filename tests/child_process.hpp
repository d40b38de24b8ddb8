// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Signals to one process, and to no other. To kill(2) and waitpid(2) an id of 0 or less means a
// group of processes, and -1, which a failed fork() returns, means all of them.
#pragma once

#include <atomic>
#include <csignal>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <string>
#include <sys/mman.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

namespace trussmap::testing {

/// Throws std::invalid_argument, and signals nothing, unless `process` is above 0.
inline void send_signal(pid_t process, int signal) {
  if (process <= 0) {
    throw std::invalid_argument("no signal is sent to process id " + std::to_string(process));
  }
  ::kill(process, signal);
}

/// Waits for the end of a child; its status as of waitpid(2). Throws std::invalid_argument unless
/// `process` is above 0, std::runtime_error where it is no child.
inline int wait_for(pid_t process) {
  if (process <= 0) {
    throw std::invalid_argument("there is no process with id " + std::to_string(process));
  }
  int status = 0;
  if (::waitpid(process, &status, 0) != process) {
    throw std::runtime_error("process " + std::to_string(process) + " is no child");
  }
  return status;
}

/// A copy of this process that does one thing and nothing else, until it is killed.
class ChildProcess {
 public:
  template <typename Work>
  explicit ChildProcess(const Work& work) : id_(::fork()) {
    if (id_ < 0) throw std::runtime_error("no process could be made");
    if (id_ > 0) return;
    try {
      work();
    } catch (...) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  ~ChildProcess() {
    if (running_) kill();
  }
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Kills it (SIGKILL) and waits; the signal that it died of, 0 where it had ended by itself.
  int kill() const {
    running_ = false;
    send_signal(id_, SIGKILL);
    const int status = wait_for(id_);
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

 private:
  pid_t id_;
  mutable bool running_ = true;
};

/// A number that a process and its children share; 0 at first.
class SharedCounter {
 public:
  SharedCounter()
      : memory_(::mmap(nullptr, sizeof(Number), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                       -1, 0)) {
    if (memory_ == MAP_FAILED) throw std::runtime_error("no memory could be shared");
    number_ = new (memory_) Number(0);
  }
  ~SharedCounter() { ::munmap(memory_, sizeof(Number)); }
  SharedCounter(const SharedCounter&) = delete;
  SharedCounter& operator=(const SharedCounter&) = delete;

  void set(std::int64_t value) const { *number_ = value; }
  [[nodiscard]] std::int64_t get() const { return *number_; }

 private:
  using Number = std::atomic<std::int64_t>;
  static_assert(Number::is_always_lock_free);
  void* memory_;
  Number* number_ = nullptr;
};

}  // namespace trussmap::testing
