// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// --tolerance: how far off legs that no fit has seen may end. Within it a run ends with status 0,
// beyond it with 1.
#pragma once

#include "command_line.hpp"
#include "trussmap/held_out.hpp"
#include "trussmap/pages.hpp"

#include <optional>
#include <string>

namespace trussmap::app {

/// "20mm", "2 cm", "0.02 m" or "0.02".
void add_tolerance(const Command& command, std::string& tolerance);

/// Of these legs; nothing where no tolerance is asked for. Throws UsageError where no leg is held
/// out.
[[nodiscard]] std::optional<Tolerance> judged(const std::string& tolerance,
                                              const HeldOut& held_out);

[[nodiscard]] Page with_tolerance(const Page& page, const std::optional<Tolerance>& tolerance);

/// Prints it as the last line; throws AnswerIsNo where it failed.
void end_by(const std::optional<Tolerance>& tolerance);

}  // namespace trussmap::app
