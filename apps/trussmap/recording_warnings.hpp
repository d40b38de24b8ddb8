// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What trussmap check finds, as warnings before a command works with the recordings.
#pragma once

#include "trussmap/check.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <string>
#include <vector>

namespace trussmap::app {

/// A line each, on standard error.
void print_warnings(const std::vector<CheckFinding>& findings);

/// A line each, on standard error: they are seen although the command may fail.
void warn_of_mistakes(const std::vector<Recording>& recordings, const Model& model,
                      const std::string& model_file, bool to_be_fitted = true);

}  // namespace trussmap::app
