// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// --html: style sheet and script are part of the executable.
#pragma once

#include "command_line.hpp"
#include "trussmap/pages.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::app {

[[nodiscard]] PageRuntime page_runtime();

/// --html FILE and --plots DIR.
struct PageOptions {
  std::string html;
  std::string plots;

  [[nodiscard]] bool wanted() const { return !html.empty() || !plots.empty(); }
};

void add_html_option(const Command& command, PageOptions& options);
void add_plots_option(const Command& command, PageOptions& options);

using Files = std::vector<std::pair<std::filesystem::path, std::string>>;

/// The page, and its charts as pictures, among the files that a command writes. Makes DIR.
void add_page(Files& files, const Page& page, const PageOptions& options);

/// "rec1, rec2 (and 3 more), model.toml".
[[nodiscard]] std::string subject_of(const std::vector<std::string>& recordings,
                                     const std::string& model);

}  // namespace trussmap::app
