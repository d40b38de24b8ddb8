// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Signals to one process, and to no other. To kill(2) and waitpid(2) an id of 0 or less means a
// group of processes, and -1, which a failed fork() returns, means all of them.
#pragma once

#include <csignal>
#include <stdexcept>
#include <string>
#include <sys/types.h>
#include <sys/wait.h>

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

}  // namespace trussmap::testing
