// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The sub-commands. Each has a file of its own, command_NAME.cpp, with its options, its
// setup_NAME, which registers it, and the function that runs it.
#pragma once

#include <stdexcept>

#include <CLI/CLI.hpp>

namespace trussmap::app {

// A command's callback throws: InputError and UsageError end with status 2, anything else with 1.

/// Options that fit each other badly, or a value out of range: one line, status 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

void setup_add(CLI::App& app);
void setup_adjust(CLI::App& app);
void setup_build(CLI::App& app);
void setup_calibrate(CLI::App& app);
void setup_compare(CLI::App& app);
void setup_convert(CLI::App& app);
void setup_diagnose(CLI::App& app);
void setup_discover(CLI::App& app);
void setup_fit(CLI::App& app);
void setup_noise(CLI::App& app);
void setup_reveal(CLI::App& app);
void setup_simulate(CLI::App& app);
void setup_tour(CLI::App& app);
void setup_umbmark(CLI::App& app);

}  // namespace trussmap::app
