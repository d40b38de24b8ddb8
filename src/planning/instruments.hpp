// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What further instruments would change: their rows taken in with those of a planned drive.
//
//   compass, gyro   each with an offset of its own that is unknown
//   range sensor    ranges and bearings of half of the landmarks in reach, 8 m
//   distance        one between the start and a neighbour: a row by both, 2 mm
//   survey          of every landmark, as the model states its noise
//   truth           a pose a second
#pragma once

#include "planning/tour_search.hpp"
#include "trussmap/session.hpp"

#include <vector>

namespace trussmap::planning {

/// Of a task with all questions, those beyond the drive marked. The most useful first.
[[nodiscard]] std::vector<InstrumentWorth> worth_of_instruments(const SearchTask& task,
                                                                const DrivePlan& plan,
                                                                const std::vector<bool>& beyond);

}  // namespace trussmap::planning
