// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What can be taken along from a workbench: the model, its constants to paste, the commands that do
// the same work again, a piece of C++ that uses the model on the robot, and the report.
#pragma once

#include "bench_requests.hpp"

#include <optional>
#include <string>

namespace trussmap::app {

/// "model.toml", "constants.toml", "commands.sh", "odometry.cpp" or "report.html"; nothing of
/// another name.
[[nodiscard]] std::optional<LocalReply> bench_export(const std::string& name, const BenchView& view,
                                                     const BenchOrigin& origin);

}  // namespace trussmap::app
