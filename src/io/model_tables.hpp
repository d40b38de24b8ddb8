// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The tables of a model, in a file that has others, too.
#pragma once

#include "io/model_text.hpp"
#include "io/toml_parser.hpp"
#include "trussmap/model.hpp"

#include <string>

namespace trussmap {

/// Of a table that holds robot, noise and effect, or some of them. Throws InputError as read_model
/// does; `file` is for messages.
[[nodiscard]] Model model_of(const toml::table& root, const std::string& file);

}  // namespace trussmap
