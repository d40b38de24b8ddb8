// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::map.
//
// The two ways in which a call can fail.
//
//   InputError   what the user gave is wrong: one line `file:line: found, expected`; exit status 2
//   SolveError   the input is well formed but the problem has no answer, said in the user's words
//                ("landmark K is tied to nothing"); exit status 1
//
// A value that breaks a call's stated precondition is the caller's mistake: std::invalid_argument.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace trussmap {

class InputError : public std::runtime_error {
 public:
  /// `line` counts from 1; 0 means the file as a whole.
  InputError(const std::string& file, std::size_t line, const std::string& what)
      : std::runtime_error(line == 0 ? file + ": " + what
                                     : file + ":" + std::to_string(line) + ": " + what),
        file_(file),
        line_(line) {}

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] std::size_t line() const { return line_; }

 private:
  std::string file_;
  std::size_t line_;
};

class SolveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace trussmap
