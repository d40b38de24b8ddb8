// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// --html: style sheet and script are part of the executable.
#pragma once

#include "command_line.hpp"
#include "trussmap/pages.hpp"
#include "trussmap/robot.hpp"
#include "trussmap/write_files.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace trussmap::app {

[[nodiscard]] PageRuntime page_runtime();
/// Of the workbench's page.
[[nodiscard]] PageRuntime workbench_runtime();

/// --html FILE and --plots DIR.
struct PageOptions {
  std::string html;
  std::string plots;

  [[nodiscard]] bool wanted() const { return !html.empty() || !plots.empty(); }
};

void add_html_option(const Command& command, PageOptions& options);
void add_plots_option(const Command& command, PageOptions& options);

/// What a command writes, all of it when it is done.
struct Files {
  NamedContents single;
  std::vector<FolderOfFiles> folders;

  void emplace_back(const std::filesystem::path& path, std::string content) {
    single.emplace_back(path, std::move(content));
  }
  /// A picture of its own in DIR.
  void add_plot(const std::string& folder, const std::string& name, std::string svg);
  /// Of all files, in the order in which they were added.
  [[nodiscard]] std::vector<std::filesystem::path> paths() const;
  void write() const { write_files(single, folders); }
};

/// The page, and its charts as pictures in DIR, among the files that a command writes. At its foot
/// stand the command, the version, the day, and what tells the recordings from others.
void add_page(Files& files, const Page& page, const PageOptions& options,
              const std::vector<DrivenRecording>& recordings = {});

/// "rec1, rec2 (and 3 more), model.toml".
[[nodiscard]] std::string subject_of(const std::vector<std::string>& recordings,
                                     const std::string& model);

}  // namespace trussmap::app
