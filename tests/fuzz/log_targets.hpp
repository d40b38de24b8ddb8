// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The targets that are readers of logs.
#pragma once

#include "fuzz/targets.hpp"

namespace trussmap::fuzz {

[[nodiscard]] std::map<std::string, Target> log_targets();

}  // namespace trussmap::fuzz
