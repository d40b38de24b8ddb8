// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One seed, many random streams: each use draws from a stream of its own, so that drawing more in
// one place changes nothing in another.
#pragma once

#include <cstdint>
#include <random>

namespace trussmap {

enum class Stream : std::uint32_t {
  mesh = 1,
  walk,
  path,
  wheels,
  compass,
  range,
  survey,
  covariates,
  hidden
};

[[nodiscard]] inline std::mt19937_64 random_stream(std::uint64_t seed, Stream stream) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32U),
                         static_cast<std::uint32_t>(stream)};
  return std::mt19937_64(sequence);
}

}  // namespace trussmap
