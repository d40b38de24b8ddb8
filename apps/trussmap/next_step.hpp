// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The command that helps on, as a line to copy.
#pragma once

#include "model_recordings.hpp"
#include "trussmap/pages.hpp"

#include <optional>
#include <string>

namespace trussmap::app {

/// The command as a line, if there is one: of the same recordings, used in the same way, and this
/// model. What it writes has a usual name.
[[nodiscard]] std::optional<NextStep> next_step(const std::optional<NextCommand>& next,
                                                const ModelRecordingsOptions& input,
                                                const std::string& model);

/// The page with it, if there is one.
[[nodiscard]] Page with_next(const Page& page, const std::optional<NextStep>& next);

/// "\nNext, to ... :\n  trussmap ...\n"; empty where there is none.
[[nodiscard]] std::string next_text(const std::optional<NextStep>& next);

}  // namespace trussmap::app
