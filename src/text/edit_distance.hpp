// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How far a word is from what may have been meant.
#pragma once

#include <cstddef>
#include <string_view>

namespace trussmap::text {

/// The fewest letters that have to be put in, taken out or changed (Levenshtein 1966); small and
/// capital letters are alike.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace trussmap::text
