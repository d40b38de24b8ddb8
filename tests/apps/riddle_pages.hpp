// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The pages of compare, diagnose, fit and discover on maps/riddle, for tests that look at them.
#pragma once

#include "apps/chrome.hpp"
#include "scratch_folder.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace trussmap::testing {

inline std::filesystem::path page_made_by(const ScratchFolder& scratch,
                                          const std::string& command) {
  const std::string riddle = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";
  std::string model = riddle + "/model.toml";
  const auto run = [](const std::string& words) {
    const Ran ran = run_trussmap(words);
    if (ran.status != 0) throw std::runtime_error(ran.output);
  };
  if (command == "fit") {
    const std::string with = (scratch.path() / "with.toml").string();
    run("add " + model + " \"hard iron\" --out " + with);
    model = with;
  }
  const std::filesystem::path page = scratch.path() / (command + ".html");
  run(command + " " + riddle + " --model " + model + " --html " + page.string());
  return page;
}

/// Opens a page, and waits until its charts are drawn.
inline void open_page(Chrome& chrome, const std::filesystem::path& page) {
  chrome.go("file://" + page.string());
  chrome.wait("document.documentElement.dataset.charts");
}

}  // namespace trussmap::testing
