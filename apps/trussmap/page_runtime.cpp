// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "page_runtime.hpp"

#include "call_again.hpp"
#include "trussmap/recording_files.hpp"

#include <charconv>
#include <cstdlib>
#include <ctime>
#include <string_view>

#include <fmt/format.h>

// The files as they are, each between two names.
#define TRUSSMAP_EMBED(name, file)                                               \
  __asm__(".pushsection .rodata\n.global " #name "\n" #name ":\n.incbin \"" file \
          "\"\n.global " #name "_end\n" #name "_end:\n.byte 0\n.popsection\n")
TRUSSMAP_EMBED(trussmap_page_script, TRUSSMAP_PAGE_SCRIPT);
TRUSSMAP_EMBED(trussmap_page_style, TRUSSMAP_PAGE_STYLE);
TRUSSMAP_EMBED(trussmap_workbench_script, TRUSSMAP_WORKBENCH_SCRIPT);
TRUSSMAP_EMBED(trussmap_workbench_style, TRUSSMAP_WORKBENCH_STYLE);

extern "C" {
extern const char trussmap_page_script[];
extern const char trussmap_page_script_end[];
extern const char trussmap_page_style[];
extern const char trussmap_page_style_end[];
extern const char trussmap_workbench_script[];
extern const char trussmap_workbench_script_end[];
extern const char trussmap_workbench_style[];
extern const char trussmap_workbench_style_end[];
}

namespace trussmap::app {

PageRuntime page_runtime() {
  return {{trussmap_page_style, trussmap_page_style_end},
          {trussmap_page_script, trussmap_page_script_end}};
}

PageRuntime workbench_runtime() {
  static const std::string style =
      std::string(trussmap_page_style, trussmap_page_style_end) +
      std::string(trussmap_workbench_style, trussmap_workbench_style_end);
  return {style, {trussmap_workbench_script, trussmap_workbench_script_end}};
}

void add_html_option(const Command& command, PageOptions& options) {
  command.add_option("--html", options.html, "Write a page with charts, one file (HTML)")
      .type_name("FILE");
}

void add_plots_option(const Command& command, PageOptions& options) {
  command.add_option("--plots", options.plots, "Folder to write the charts to, one by one (SVG)")
      .type_name("DIR");
}

namespace {

/// The day it is, or that SOURCE_DATE_EPOCH states, for files that are the same whenever they are
/// made; UTC.
std::string day() {
  std::time_t now = std::time(nullptr);
  if (const char* stated = std::getenv("SOURCE_DATE_EPOCH")) {
    long long seconds = 0;
    const std::string_view text = stated;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), seconds);
    if (read.ec == std::errc()) now = static_cast<std::time_t>(seconds);
  }
  std::tm parts{};
  if (gmtime_r(&now, &parts) == nullptr) return "";
  return fmt::format("{:04}-{:02}-{:02}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

}  // namespace

void Files::add_plot(const std::string& folder, const std::string& name, std::string svg) {
  folders.push_back({folder, {{name, std::move(svg)}}, {}});
}

std::vector<std::filesystem::path> Files::paths() const {
  std::vector<std::filesystem::path> all;
  for (const auto& [path, content] : single) all.push_back(path);
  for (const FolderOfFiles& folder : folders) {
    for (const auto& [name, content] : folder.files) all.push_back(folder.folder / name);
  }
  return all;
}

void add_page(Files& files, const Page& page, const PageOptions& options,
              const std::vector<DrivenRecording>& recordings) {
  if (!options.html.empty()) {
    Provenance from{call_with({}), TRUSSMAP_VERSION, day()};
    for (const DrivenRecording& one : recordings) {
      from.data.emplace_back(one.name, fingerprint(one));
    }
    files.emplace_back(options.html, render_page(with_provenance(page, from), page_runtime()));
  }
  if (options.plots.empty()) return;
  FolderOfFiles& plots = files.folders.emplace_back();
  plots.folder = options.plots;
  for (DrawnChart& chart : draw_charts(page)) {
    plots.files.emplace_back(chart.id + ".svg", std::move(chart.svg));
  }
}

std::string subject_of(const std::vector<std::string>& recordings, const std::string& model) {
  constexpr std::size_t kNamed = 3;
  std::string text;
  for (std::size_t k = 0; k < recordings.size() && k < kNamed; ++k) {
    text += (k > 0 ? ", " : "") + recordings[k];
  }
  if (recordings.size() > kNamed) {
    text += " and " + std::to_string(recordings.size() - kNamed) + " more";
  }
  return text + (model.empty() ? "" : " with " + model);
}

}  // namespace trussmap::app
