// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Coefficients that change while driving, in lines of text and as a section of a page.
#pragma once

#include "report/page.hpp"
#include "trussmap/diagnose.hpp"

#include <string>

namespace trussmap::report {

/// A line each; empty where none changes.
[[nodiscard]] std::string changing_text(const Diagnosis& diagnosis);

/// A sentence and a chart of each one's course, with its 95 % band; none where none changes.
void add_changes(const Diagnosis& diagnosis, PageContent& page);

}  // namespace trussmap::report
