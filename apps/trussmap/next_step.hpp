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

/// The page with the command, if there is one: of the same recordings and what of them is used, and
/// this model. What it writes has a usual name.
[[nodiscard]] Page with_next(const Page& page, const std::optional<NextCommand>& next,
                             const ModelRecordingsOptions& input, const std::string& model);

}  // namespace trussmap::app
