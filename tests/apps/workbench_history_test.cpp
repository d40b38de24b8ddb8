// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The workbench's steps with names, set side by side; its effects explained; its progress.
#include "apps/chrome.hpp"
#include "apps/served_bench.hpp"
#include "scratch_folder.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace trussmap::workbench_history_test {
namespace {

using nlohmann::json;
using testing::Chrome;
using testing::ScratchFolder;
using testing::ServedBench;

const std::string kRiddle = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";

std::vector<std::string> riddle(const ScratchFolder& scratch) {
  return {kRiddle, "--model", kRiddle + "/model.toml", "--work",
          (scratch.path() / "work").string()};
}

std::string at_step(int step, int steps) {
  return fmt::format(
      "document.documentElement.dataset.at === '{}' && document.documentElement.dataset.steps === "
      "'{}' && document.documentElement.dataset.busy === 'false'",
      step, steps);
}

json step(const ServedBench& bench, json what) {
  what["version"] = bench.settled().at("version");
  return json::parse(bench.post("step", what.dump()).body);
}

TEST(ServeCommand, NamesOfStepsAreKept) {
  const ScratchFolder scratch;
  auto bench = std::make_unique<ServedBench>(riddle(scratch));
  step(*bench, {{"do", "add"}, {"finding", 0}});
  EXPECT_EQ(step(*bench, {{"do", "name"}, {"step", 1}, {"label", "the <magnet>"}}), json::object());
  EXPECT_EQ(bench->settled().at("failed"), "");
  const json state = bench->state();
  EXPECT_EQ(state.at("steps").at(1).at("label"), "the <magnet>");
  EXPECT_EQ(state.at("steps").at(1).at("has"), json::array({"hard iron"}));
  EXPECT_EQ(state.at("steps").at(0).at("label"), "");
  EXPECT_EQ(state.at("at"), 1);
  EXPECT_TRUE(step(*bench, {{"do", "name"}, {"step", 7}, {"label", "x"}}).contains("error"));
  EXPECT_TRUE(step(*bench, {{"do", "name"}, {"step", 1}, {"label", std::string(500, 'x')}})
                  .contains("error"));
  bench->kill();
  bench = std::make_unique<ServedBench>(riddle(scratch));
  static_cast<void>(bench->settled());
  EXPECT_EQ(bench->state().at("steps"), state.at("steps"));
}

TEST(WorkbenchInBrowser, StepsAreNamedComparedAndGoneBackTo) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  EXPECT_TRUE(chrome.eval("document.getElementById('compare').hidden").get<bool>());
  // The progress is shown until the whole screen is that of the new state.
  chrome.eval(
      "(() => { window.atEnd = []; const doing = document.getElementById('doing'); "
      "new MutationObserver(() => { if (doing.hidden) window.atEnd.push("
      "document.documentElement.dataset.at + document.getElementById('figure-now').textContent); })"
      ".observe(doing, {attributes: true}); })()");
  chrome.click("#parts [data-effect=\"hard iron\"] .act");
  chrome.wait(at_step(1, 2));
  chrome.wait("window.atEnd.length > 0");
  EXPECT_EQ(chrome.eval("window.atEnd"), json::array({"1" + chrome.text("#figure-now")}));
  // Named, and the name lasts.
  chrome.click("#steps li:nth-child(2) .rename");
  chrome.type("with <b>iron</b>");
  chrome.click("#steps li:nth-child(2) .naming button");
  chrome.wait(
      "document.querySelector('#steps li:nth-child(2) .step').textContent === 'with <b>iron</b>'");
  EXPECT_EQ(bench.state().at("steps").at(1).at("label"), "with <b>iron</b>");
  chrome.reload();
  chrome.wait(at_step(1, 2));
  EXPECT_EQ(chrome.text("#steps li:nth-child(2) .step"), "with <b>iron</b>");
  EXPECT_EQ(chrome.text("#steps li:nth-child(1) .step"), "as given");
  // Side by side.
  chrome.click("#compare summary");
  const std::string table = chrome.text("#compared");
  for (const char* text : {"as given", "with <b>iron</b>", "hard iron", "none", " mm"}) {
    EXPECT_NE(table.find(text), std::string::npos) << text << " in " << table;
  }
  // And back.
  chrome.click("#compared tr:last-child td:nth-child(2) button");
  chrome.wait(at_step(0, 2));
  EXPECT_NE(chrome.text("#verdict").find("Missing: hard iron"), std::string::npos);
  EXPECT_EQ(chrome.complaints(), std::vector<std::string>());
}

TEST(WorkbenchInBrowser, EffectsAreExplainedOnTheirCards) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  const std::string card = "#parts [data-effect=\"hard iron\"]";
  const std::string explanation = card + " > .explanation";
  const auto is_open = [&chrome, &explanation] {
    return chrome.eval("document.querySelector('" + explanation + "') !== null").get<bool>();
  };
  EXPECT_FALSE(is_open());
  chrome.click(card + " .explain");
  chrome.wait("document.querySelector('" + explanation + " svg')");
  const std::string text = chrome.text(explanation);
  for (const char* part :
       {"turns with the robot", "Look for magnets", "full turn", "Calibrate the compass"}) {
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
  }
  // As drawn by the library, and drawn as wide as there is room for.
  EXPECT_EQ(chrome.text(explanation + " svg title"), "hard iron");
  EXPECT_GT(chrome.eval("document.querySelector('" + explanation +
                        " svg').getBoundingClientRect().width"),
            150);
  // Within the model it is still explained.
  chrome.click(card + " .act");
  chrome.wait(at_step(1, 2));
  chrome.wait("document.querySelector('#on .explanation svg')");
  chrome.click("#on .explain");
  chrome.wait("!document.querySelector('#on .explanation')");
  EXPECT_EQ(chrome.eval("document.querySelector('#on .explain').getAttribute('aria-expanded')"),
            "false");
  EXPECT_EQ(chrome.complaints(), std::vector<std::string>());
}

}  // namespace
}  // namespace trussmap::workbench_history_test
