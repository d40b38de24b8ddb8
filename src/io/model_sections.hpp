// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Sections of a model file. Reading throws TomlFault.
#pragma once

#include "io/toml_values.hpp"
#include "trussmap/model.hpp"

#include <string>

namespace trussmap::io {

/// [robot].
[[nodiscard]] Robot read_robot(const toml::table& robot);
[[nodiscard]] std::string robot_text(const Robot& robot);

/// [noise], with its processes.
[[nodiscard]] Noise read_noise(const toml::table& noise);
[[nodiscard]] std::string noise_text(const Model& model);

}  // namespace trussmap::io
