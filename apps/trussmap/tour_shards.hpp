// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The seeds of tour as trials of a run in shares: whole in one process, by the processes of mpirun,
// or by the tasks of a job array whose files merge puts together.
#pragma once

#include "tour_output.hpp"
#include "trussmap/tour_experiment.hpp"

#include <functional>
#include <string>

namespace trussmap::app {

/// Program that a shard of tour names.
inline constexpr const char* kTourProgram = "trussmap tour";

/// All that the results depend on, as JSON; the world's name and the seeds among it, for printing.
[[nodiscard]] std::string tour_settings(const TourOptions& options, const std::string& world);

/// What the seeds of a share came to.
[[nodiscard]] ShardResults run_tour_shard(const TourOptions& options, const std::string& settings,
                                          const Shard& shard);

/// Of a whole run: prints and writes what tour does.
void show_tour_run(const ShardResults& whole, TourOutput output);

}  // namespace trussmap::app
