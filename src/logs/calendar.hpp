// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace trussmap::logs {

inline constexpr std::int64_t kNanosecondsPerSecond = 1000000000;

/// ns since 1970 (UTC) of "2026-03-01T12:30:00.25", with T or a blank, with or without a fraction,
/// Z or an offset like +01:00; none where the text is no such time.
[[nodiscard]] std::optional<std::int64_t> calendar_time(const std::string& text);

/// ns of a number as it is written, "1748457053.946277034", "1.5e3" or "0,5", in units of so many
/// ns: to the nearest one, where a double has lost them. None where it is no number, or beyond
/// 4e18 ns.
[[nodiscard]] std::optional<std::int64_t> decimal_time(std::string_view text, std::int64_t unit);

}  // namespace trussmap::logs
