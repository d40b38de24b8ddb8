// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// A model as a TOML file: [robot], [noise], [[effect]] (model.hpp).
#pragma once

#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace trussmap {

/// Absent keys keep their defaults; an effect with a catalogue name alone has the catalogue's
/// channel and shapes. Throws InputError with file and line: no TOML, an unknown key, a wrong type,
/// a wheelbase that is not positive, a negative noise, an unknown channel, a shape that cannot be
/// read, a coefficient count that does not match the shapes.
[[nodiscard]] Model read_model(const std::filesystem::path& file);

/// The same for use with these recordings, one per session: throws InputError with file and line
/// also where a shape names a variable that they do not have or is not finite in them, and where a
/// coefficient count does not match the number of sessions, whether the effect has been fitted or
/// not.
[[nodiscard]] Model read_model(const std::filesystem::path& file,
                               const std::vector<Recording>& recordings);

/// The effects of a model file alone, of whatever drive: for a robot that another place states.
/// Throws as read_model does.
[[nodiscard]] std::vector<Effect> read_effects(const std::filesystem::path& file);

/// The model as TOML; numbers read back exactly.
[[nodiscard]] std::string format_model(const Model& model);

void write_model(const std::filesystem::path& file, const Model& model);

}  // namespace trussmap
