// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A whole model as TOML, by itself or in a file that has other tables, too. Its tables: see
// model_sections.hpp.
#pragma once

#include "io/toml_parser.hpp"
#include "trussmap/model.hpp"

#include <string>

namespace trussmap::io {

/// Of a table that holds robot, noise and effect, or some of them. Throws InputError as read_model
/// does; `file` is for messages.
[[nodiscard]] Model model_of(const toml::table& root, const std::string& file);

/// Of a model file's text. Throws as model_of; `file` is for messages.
[[nodiscard]] Model model_from_text(const std::string& text, const std::string& file);

}  // namespace trussmap::io
