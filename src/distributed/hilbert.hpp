// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Places along Hilbert's curve through a square (Hilbert 1891): what is near on the curve is near
// in the plane, so that equal lengths of it are compact shares of a map.
#pragma once

#include <cstdint>

namespace trussmap::distributed {

inline constexpr int kHilbertBits = 31;  // of each coordinate

/// The place on the curve of a cell, coordinates from 0 to 2^31 - 1.
[[nodiscard]] std::uint64_t hilbert_place(std::uint32_t x, std::uint32_t y);

}  // namespace trussmap::distributed
