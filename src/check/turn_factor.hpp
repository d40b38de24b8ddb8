// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How many times as far the robot turns as its wheels say, by places that something else knows.
// Over pieces of the drive in which these go round a corner, the way by the wheels is laid over
// them, turned, moved and scaled as suits it best; with its turns times f:
//
//   e(f)   median over pieces of what is left, by the piece's extent: 0 fits, 1 has nothing to do
//          with it
//
// f below 0 is the mirrored way: wheels exchanged, or the places' axes. Factors from 0.4 to 2.5
// are tried; one near 1 counts first. Where the robot turns on the spot by right angles alone,
// turns that differ by four of them look the same; then nothing is said.
#pragma once

#include "check/places.hpp"
#include "check/track.hpp"

#include <cstddef>
#include <vector>

namespace trussmap::check {

/// Places from first to before end, in which they are no straight line.
struct CornerPiece {
  std::size_t first = 0;
  std::size_t end = 0;
};

/// The places that are so far apart, by the way driven, that their noise does not matter.
[[nodiscard]] std::vector<TimedPlace> places_apart(const PlacesSeen& places, const Track& track);
/// Of these; at most a hundred, evenly spread.
[[nodiscard]] std::vector<CornerPiece> corner_pieces(const std::vector<TimedPlace>& places,
                                                     const Track& track, double noise);

/// The sign of the factor; 0: cannot be told.
[[nodiscard]] int turn_sign(const MotionRows& drive, const Track& track, const PlacesSeen& places);

}  // namespace trussmap::check
