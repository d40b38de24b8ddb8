// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The sub-commands. Each has a file of its own, command_NAME.cpp, with its options, its
// setup_NAME, which registers it, and the function that runs it.
#pragma once

#include "command_line.hpp"

namespace trussmap::app {

// A command's callback throws: InputError and UsageError end with status 2, anything else with 1.

void setup_add(const Command& app);
void setup_adjust(const Command& app);
void setup_apply(const Command& app);
void setup_build(const Command& app);
void setup_calibrate(const Command& app);
void setup_check(const Command& app);
void setup_compare(const Command& app);
void setup_completion(const Command& app, const CLI::App& whole);
void setup_contrast(const Command& app);
void setup_convert(const Command& app);
void setup_diagnose(const Command& app);
void setup_discover(const Command& app);
void setup_effects(const Command& app);
void setup_explore(const Command& app);
void setup_fit(const Command& app);
void setup_fleet(const Command& app);
void setup_manual(const Command& app, const CLI::App& whole);
void setup_merge(const Command& app);
void setup_noise(const Command& app);
void setup_plan(const Command& app);
void setup_reveal(const Command& app);
void setup_schema(const Command& app);
void setup_serve(const Command& app);
void setup_simulate(const Command& app);
void setup_tape(const Command& app);
void setup_tour(const Command& app);
void setup_umbmark(const Command& app);
void setup_watch(const Command& app);

}  // namespace trussmap::app
