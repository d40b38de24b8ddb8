// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#pragma once

#include "trussmap/model.hpp"

#include <string>

namespace trussmap {

/// Of a model file's text. Throws InputError as read_model() does; `file` is for messages.
[[nodiscard]] Model model_from_text(const std::string& text, const std::string& file);

}  // namespace trussmap
