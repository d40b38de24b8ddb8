// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The processes that run a command together: one, unless mpirun has started several of a program
// that is built with MPI. Compiled as team_mpi.cpp or as team_alone.cpp.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace trussmap {
class Processes;
}

namespace trussmap::app {

[[nodiscard]] bool built_with_mpi();

class Team {
 public:
  [[nodiscard]] int rank() const;
  [[nodiscard]] int count() const;
  /// At the first process the text of each, elsewhere none.
  [[nodiscard]] std::vector<std::string> gather(const std::string& text) const;
  /// None where MPI has not begun.
  [[nodiscard]] const Processes* processes() const { return processes_; }

 private:
  friend bool run_together(bool, const std::function<void(const Team&)>&);
  explicit Team(const Processes* processes) : processes_(processes) {}

  const Processes* processes_;
};

/// Runs `work` in each process of a team; true in the first of them, which goes on and prints.
/// `always`: begins MPI even where nothing was launched. What fails in all processes is said by
/// the first, and all throw AlreadySaid; what fails in one alone ends all.
bool run_together(bool always, const std::function<void(const Team&)>& work);

}  // namespace trussmap::app
