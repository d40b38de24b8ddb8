// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// --help, the same for all commands: arguments spelled in one way, lines of at most 100 characters,
// and what a recording is under every command that reads one.
//
//   FILE  DIR     paths                         N   whole number
//   {a,b}         one of these words            X   number; X,X two of them
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace trussmap::app {

/// Positional argument that stands for recordings; finish_help() explains it.
inline constexpr const char* kRecordingArgument = "RECORDING";

/// Before the commands are added: they inherit it.
void begin_help(CLI::App& app);
/// After they have been added.
void finish_help(CLI::App& app);

/// "FILE", "{a,b},...", "X=0.05": what an option takes, as help spells it.
[[nodiscard]] std::string spelled_value(const CLI::Option& option);

/// Words broken into lines of at most `width` characters, each after the first with an indent.
/// Line breaks in the text stay.
[[nodiscard]] std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);

}  // namespace trussmap::app
