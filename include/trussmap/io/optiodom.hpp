// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// OptiOdom runs (Sousa, Petry, Costa & Moreira, 2022) of the differential robot as recordings.
//
//   SET_run-NN.csv   time [s], x, y [m], heading [rad], ticks of the right wheel, of the left wheel
//                    in the cycle that ends then; no header; plain or .xz
//   SET_metadata.csv beside it: type (diff), ngear, encRes (counts per turn of the motor), ...
//
// Wheels of 0.084 m and a wheelbase of 0.20 m, the nominal ones. (The metadata's own Li and Di are
// what the controller believed during the set.) There are no landmarks: truth.csv takes their
// place.
#pragma once

#include "trussmap/effects/model.hpp"
#include "trussmap/recording/recording.hpp"

#include <filesystem>

namespace trussmap {

struct OptiOdomRecording {
  Recording recording;
  Model model;  ///< nominal wheelbase, and noise that suits this robot and its motion capture
  double metre_per_tick = 0.0;
};

/// True if the file's name is that of a run: ..._run-NN.csv or ..._run-NN.csv.xz.
[[nodiscard]] bool is_optiodom(const std::filesystem::path& file);

/// Throws InputError with file and line; a run of another robot than the differential one is named.
[[nodiscard]] OptiOdomRecording read_optiodom(const std::filesystem::path& file);

}  // namespace trussmap
