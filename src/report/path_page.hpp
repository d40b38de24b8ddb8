// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The page of build where there are no landmarks: the path.
#pragma once

#include "trussmap/build_map.hpp"
#include "trussmap/pages.hpp"

#include <string>

namespace trussmap::report {

/// `built` has paths.
[[nodiscard]] Page path_page(const BuiltMap& built, const std::string& subject);

}  // namespace trussmap::report
