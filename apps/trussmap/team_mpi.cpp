// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A build with MPI.
#include "command_line.hpp"
#include "team.hpp"
#include "trussmap/distributed.hpp"
#include "trussmap/table.hpp"

#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>

namespace trussmap::app {
namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;
constexpr double kPatience = 10.0;  // s, until a process counts as the only one that has failed

/// In all processes, if they all have failed; otherwise all are ended.
[[noreturn]] void fail(const Processes& processes, int status, const std::exception& error) {
  if (!processes.all_come(kPatience)) {
    std::fprintf(stderr, "trussmap: %s (process %d of %d)\n", error.what(), processes.rank(),
                 processes.count());
    processes.abort(status);
  }
  // Said before any of them ends: mpirun ends the others as soon as one has failed.
  if (processes.rank() == 0) {
    const std::string message = escaped_controls(error.what(), true);
    std::fprintf(stderr, "trussmap: %s\n", shortened_words(message).c_str());
    std::fflush(stderr);
  }
  static_cast<void>(processes.all_come(kPatience));
  throw AlreadySaid(status);
}

}  // namespace

bool built_with_mpi() {
  return true;
}

int Team::rank() const {
  return processes_ != nullptr ? processes_->rank() : 0;
}

int Team::count() const {
  return processes_ != nullptr ? processes_->count() : 1;
}

std::vector<std::string> Team::gather(const std::string& text) const {
  return processes_ != nullptr ? processes_->gather(text) : std::vector<std::string>{text};
}

bool run_together(bool always, const std::function<void(const Team&)>& work) {
  if (!always && !launched_together()) {
    work(Team(nullptr));
    return true;
  }
  const Processes processes;
  try {
    work(Team(&processes));
  } catch (const InputError& error) {
    fail(processes, kBadInput, error);
  } catch (const UsageError& error) {
    fail(processes, kBadInput, error);
  } catch (const std::filesystem::filesystem_error& error) {
    fail(processes, kBadInput, error);
  } catch (const std::exception& error) {
    fail(processes, kFailed, error);
  }
  return processes.rank() == 0;
}

}  // namespace trussmap::app
