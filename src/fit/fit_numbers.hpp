// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Numbers that decide which noise a fit has, and of which size. L is -2 log of the restricted
// likelihood.
#pragma once

#include <cstddef>

namespace trussmap::fitting {

// Which noise there is.
inline constexpr double kWorthFitting = 2.0;   ///< sds of a score: about one in 40 by chance
inline constexpr std::size_t kMostFitted = 4;  ///< kinds of a round, those of the best scores
/// of L that another size than the stated one, or a process, has to bring: p = 0.0016
inline constexpr double kAsStated = 10.0;
inline constexpr double kStays = kAsStated;
inline constexpr double kNegligible = 0.05;  ///< of a size: what is so near is as stated
inline constexpr double kOfALength = 3.0;    ///< of L that a length has to bring: plain is likelier
inline constexpr double kAlmostNothing = 1e-4;  ///< of an sd: as good as 0, whose logarithm is none
inline constexpr double kLeastSize = 1e-9;      ///< of a first guess, for the same reason
inline constexpr double kStillBetter = 1.0;     ///< of L, for noise and fit to be fitted once more

// How far sizes and lengths go.
inline constexpr double kReach = 5.0;  ///< of a logarithm: a factor of 150
/// times smaller than stated a white size may be
inline constexpr double kLeastOfStated = 2.0;
inline constexpr double kLeastBesideAProcess = 8.0;  ///< the same where a process takes its part
inline constexpr double kMostOfALaw = 1.0;           ///< rad/s^(1/2), rad/rad^(1/2), m/s^(1/2)
inline constexpr double kShortest = 0.2;             ///< s or m: the pace of instants
inline constexpr double kLongest = 60.0;  ///< s or m: what lasts longer is an effect, and no noise
inline constexpr double kLongestOfViews = 10.0;  ///< the same, of what is seen
inline constexpr double kLongestShare = 0.1;     ///< of all recorded: ten lengths tell one

// How sizes are sought: by their logarithms.
inline constexpr double kSlopeStep =
    1e-3;  ///< of a logarithm: short for a slope, long for L's rounding
inline constexpr double kWideStep = 0.05;   ///< the same, for curvatures; of rough ones 4 times
inline constexpr double kFarthest = 1.5;    ///< that a step goes, of a logarithm
inline constexpr double kShorter = 0.4;     ///< a step that does not pay is made so much shorter
inline constexpr int kMostShorter = 6;      ///< times
inline constexpr int kMostSteps = 12;       ///< of all sizes together
inline constexpr int kMostStepsOfOne = 10;  ///< of a process and its sensor
inline constexpr double kLeastGain = 1e-3;  ///< of L, to go on for
inline constexpr double kRoughly = 0.05;    ///< the same, to compare processes
inline constexpr double kLeastInformation = 1e-2;  ///< of a logarithm: an sd of 10 tells nothing

}  // namespace trussmap::fitting
