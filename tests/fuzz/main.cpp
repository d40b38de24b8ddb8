// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// One executable per target, for libFuzzer: TRUSSMAP_FUZZ_TARGET is its name.
#include "fuzz/targets.hpp"

#include <cstddef>
#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const trussmap::fuzz::Target kTarget = trussmap::fuzz::targets().at(TRUSSMAP_FUZZ_TARGET);
  kTarget({reinterpret_cast<const char*>(data), size});
  return 0;
}
