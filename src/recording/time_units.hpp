// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Units that times are given in where seconds are expected.
#pragma once

#include <array>

namespace trussmap::recording {

struct TimeUnit {
  const char* name;
  double per_second;
};
inline constexpr std::array<TimeUnit, 3> kTimeUnits{
    {{"milliseconds", 1e3}, {"microseconds", 1e6}, {"nanoseconds", 1e9}}};

}  // namespace trussmap::recording
