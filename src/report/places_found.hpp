// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Channels that differ from place to place, in lines of text and as maps on a page.
#pragma once

#include "report/page.hpp"
#include "trussmap/diagnose.hpp"

#include <string>

namespace trussmap::report {

/// A line each; empty where none differs.
[[nodiscard]] std::string places_text(const Diagnosis& diagnosis);

/// A sentence and a map of each; none where none differs.
void add_places(const Diagnosis& diagnosis, PageContent& page);

}  // namespace trussmap::report
