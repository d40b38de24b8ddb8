// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The workbench as a person uses it: a real browser, real pointer and keys.
#include "apps/chrome.hpp"
#include "apps/served_bench.hpp"
#include "scratch_folder.hpp"
#include "trussmap/model_file.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace trussmap::workbench_in_browser_test {
namespace {

using nlohmann::json;
using testing::Chrome;
using testing::run_trussmap;
using testing::ScratchFolder;
using testing::ServedBench;

const std::string kRiddle = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";

std::vector<std::string> served(const ScratchFolder& scratch, const std::string& recording,
                                const std::string& model) {
  return {recording, "--model", model, "--work", (scratch.path() / "work").string()};
}

/// So many steps were made, the work is at this one, and none is under way.
std::string at_step(int step, int steps) {
  return fmt::format(
      "document.documentElement.dataset.at === '{}' && document.documentElement.dataset.steps === "
      "'{}' && document.documentElement.dataset.busy === 'false'",
      step, steps);
}
std::string looked_at(const std::string& effect) {
  return "document.documentElement.dataset.looked === " + json(effect).dump();
}
std::string card(const std::string& effect) {
  return "#parts [data-effect=\"" + effect + "\"]";
}

TEST(WorkbenchInBrowser, FromMisfitToModel) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const ServedBench bench(served(scratch, kRiddle, kRiddle + "/model.toml"));
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  EXPECT_NE(chrome.text("#verdict").find("Missing: hard iron"), std::string::npos);
  const double before = chrome.eval("window.trussmap.state().figure.now_mm").get<double>();
  // Pointing previews, and fits nothing.
  chrome.click("[data-part=\"wheels\"] > .act");
  chrome.point_at(card("spin loss"));
  chrome.wait(looked_at("spin loss"));
  EXPECT_EQ(chrome.text("#looked-name"), "spin loss");
  chrome.point_at(card("hard iron"));
  chrome.wait(looked_at("hard iron"));
  EXPECT_NE(chrome.text("#looked-saves").find("mm with it, as predicted"), std::string::npos);
  chrome.wait("document.querySelectorAll('#plot .mark-line path').length > 0");
  EXPECT_EQ(bench.state().at("steps").size(), 1U);
  // A duel with its look-alike.
  chrome.click(card("hard iron") + " .name");
  chrome.eval(
      "(() => { const duel = document.getElementById('duel'); duel.selectedIndex = 1; "
      "duel.dispatchEvent(new Event('change')); })()");
  chrome.wait(
      "document.getElementById('duel-words').textContent.includes('cannot tell the two apart')");
  // The noise by its handle.
  chrome.eval(
      "(() => { const handle = document.getElementById('handle'); handle.value = '3'; "
      "handle.dispatchEvent(new Event('input')); })()");
  chrome.wait("document.getElementById('handle-words').textContent.includes('of ')");
  EXPECT_NE(chrome.text("#handle-factor").find("8"), std::string::npos);
  // Added, the error falls, and the others lose what it took from them.
  chrome.click(card("hard iron") + " .act");
  chrome.wait(at_step(1, 2));
  EXPECT_NE(chrome.text("#verdict").find("Nothing missing"), std::string::npos);
  const double after = chrome.eval("window.trussmap.state().figure.now_mm").get<double>();
  EXPECT_LT(after, 0.15 * before);
  EXPECT_NE(chrome.text("#steps").find("predicted"), std::string::npos);
  EXPECT_EQ(chrome.eval("document.querySelectorAll('#on .card').length"), 1);
  EXPECT_TRUE(
      chrome.eval("document.querySelector('" + card("body tilt") + "') === null").get<bool>());
  // A reload in the middle keeps everything.
  chrome.reload();
  chrome.wait(at_step(1, 2));
  EXPECT_EQ(chrome.eval("document.querySelectorAll('#steps li').length"), 2);
  // Undo, redo.
  chrome.click("#undo");
  chrome.wait(at_step(0, 2));
  EXPECT_NE(chrome.text("#verdict").find("Missing: hard iron"), std::string::npos);
  chrome.click("#redo");
  chrome.wait(at_step(1, 2));
  // Taken along.
  const std::string exported =
      chrome.eval("fetch('export/model.toml').then(reply => reply.text())").get<std::string>();
  EXPECT_EQ(read_model(scratch.write("exported.toml", exported)).effects.size(), 1U);
  // Removed again.
  chrome.click("#on .card .act");
  chrome.wait(at_step(2, 3));
  EXPECT_EQ(chrome.eval("document.querySelectorAll('#on .card').length"), 0);
  EXPECT_EQ(chrome.complaints(), std::vector<std::string>());
}

TEST(WorkbenchInBrowser, AShapeOfOnesOwnIsPreviewedAsItIsTyped) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const ServedBench bench(served(scratch, kRiddle, kRiddle + "/model.toml"));
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  chrome.click("#own summary");
  chrome.eval("document.getElementById('own-channel').value = 'compass'");
  chrome.click("#own-shape");
  chrome.type("sin(headi");
  chrome.wait("document.getElementById('own-fault').textContent.includes('cannot be read')");
  EXPECT_TRUE(chrome.eval("document.getElementById('own-add').disabled").get<bool>());
  EXPECT_TRUE(chrome.eval("document.getElementById('plot').hidden").get<bool>());
  EXPECT_TRUE(chrome
                  .eval("[...document.querySelectorAll('#own-words option')]"
                        ".some(one => one.value === 'sin(heading')")
                  .get<bool>());
  chrome.type("ng)");
  chrome.wait(looked_at("my effect"));
  EXPECT_EQ(chrome.text("#own-fault"), "");
  EXPECT_FALSE(chrome.eval("document.getElementById('own-add').disabled").get<bool>());
  // A sine and a cosine: a coefficient each.
  chrome.click("#own-term");
  chrome.type("cos(heading)");
  chrome.wait("document.getElementById('looked-saves').textContent.includes('2 coefficients')");
  // A name that would be markup is text.
  chrome.click("#own-name");
  chrome.eval("document.getElementById('own-name').value = '<img src=x onerror=alert(1)>'");
  chrome.type("!");
  chrome.wait("document.getElementById('looked-name').textContent.includes('<img')");
  chrome.click("#own-add");
  chrome.wait(at_step(1, 2));
  EXPECT_NE(chrome.text("#on").find("<img src=x"), std::string::npos);
  EXPECT_EQ(chrome.eval("document.querySelectorAll('img').length"), 0);
  EXPECT_EQ(chrome.complaints(), std::vector<std::string>());
}

/// How red the map's reddest route is, 0 to 1.
double reddest(Chrome& chrome) {
  return chrome
      .eval(
          "Math.max(0, ...window.trussmap.state().map.layers.filter(one => one.shade)"
          ".flatMap(one => one.shade))")
      .get<double>();
}

TEST(WorkbenchInBrowser, TheErrorIsInSightAtEveryWidthAndTheMapPalesWithIt) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const ServedBench bench(served(scratch, kRiddle, kRiddle + "/model.toml"));
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  for (const bool dark : {false, true}) {
    for (const int width : {1440, 1024, 420}) {
      chrome.look_as(width, 800, dark);
      chrome.eval("window.scrollTo(0, document.body.scrollHeight)");
      for (const char* what : {"#figure-now", "#figure-floor", "#bar-steps svg"}) {
        const std::string inside = fmt::format(
            "(() => {{ const box = document.querySelector('{}').getBoundingClientRect(); return "
            "box.top >= 0 && box.left >= 0 && box.bottom < 200 && box.right <= {} && box.width > "
            "0; "
            "}})()",
            what, width);
        EXPECT_TRUE(chrome.eval(inside).get<bool>()) << what << " at " << width;
      }
    }
  }
  chrome.look_as(1440, 1000, false);
  const double before = reddest(chrome);
  EXPECT_GT(before, 0.4);
  chrome.click(card("hard iron") + " .act");
  chrome.wait(at_step(1, 2));
  EXPECT_LT(reddest(chrome), 0.4 * before);
  EXPECT_NE(chrome.text("#figure-floor").find("noise alone"), std::string::npos);
  EXPECT_EQ(chrome.complaints(), std::vector<std::string>());
}

TEST(WorkbenchInBrowser, TwoEffectsOneAfterTheOther) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const std::string folder = (scratch.path() / "two").string();
  const testing::Ran made = run_trussmap(
      "simulate --out " + folder +
      " --mesh 4x4 --spacing 5 --tours 2 --seed 5 --effect \"hard iron=0.05,0.02\" --effect "
      "wheelbase=0.02");
  ASSERT_EQ(made.status, 0) << made.output;
  const ServedBench bench(served(scratch, folder, folder + "/model.toml"));
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  std::vector<std::string> added;
  for (int step = 1; step <= 2; ++step) {
    const std::string name =
        chrome.eval("document.querySelector('#parts .tag.bad').closest('.card').dataset.effect")
            .get<std::string>();
    added.push_back(name);
    chrome.click(card(name) + " .act");
    chrome.wait(at_step(step, step + 1));
  }
  std::sort(added.begin(), added.end());
  EXPECT_EQ(added, (std::vector<std::string>{"hard iron", "wheelbase"}));
  EXPECT_NE(chrome.text("#verdict").find("Nothing missing"), std::string::npos);
  EXPECT_EQ(chrome.complaints(), std::vector<std::string>());
}

TEST(WorkbenchInBrowser, WhereNothingIsMissingItSaysSo) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const std::string folder = (scratch.path() / "clean").string();
  ASSERT_EQ(run_trussmap("simulate --out " + folder + " --mesh 4x4 --spacing 5 --seed 7").status,
            0);
  const ServedBench bench(served(scratch, folder, folder + "/model.toml"));
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  EXPECT_NE(chrome.text("#verdict").find("Nothing missing"), std::string::npos);
  EXPECT_EQ(chrome.eval("document.querySelectorAll('#parts .tag.bad').length"), 0);
  EXPECT_EQ(chrome.eval("document.getElementById('head').className"), "good");
}

TEST(WorkbenchInBrowser, LegsAreChosenExcludedAndTakenBackIn) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const ServedBench bench(served(scratch, kRiddle, kRiddle + "/model.toml"));
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  const auto legs = [&chrome](const std::string& which) {
    return chrome.eval("window.trussmap.state().legs." + which).get<int>();
  };
  const int all = legs("all");
  EXPECT_EQ(legs("shown"), all);
  EXPECT_TRUE(chrome.eval("document.getElementById('exclude').disabled").get<bool>());
  const std::string worst = chrome.text("#figure-more");
  // A stretch of time, by dragging.
  chrome.drag("#strip-speed .picture svg", {0.4, 0.5}, {0.7, 0.5});
  chrome.wait("document.documentElement.dataset.chosen > 0");
  const int chosen = chrome.eval("Number(document.documentElement.dataset.chosen)").get<int>();
  EXPECT_LT(chosen, all);
  EXPECT_NE(chrome.text("#legs-words").find("chosen"), std::string::npos);
  EXPECT_NE(chrome.text("#figure-more"), worst);  // every view shows these alone
  chrome.wait(looked_at("hard iron"));
  // An area of the map: nothing is dragged but a rectangle.
  chrome.click("#choose-area");
  chrome.drag("#map .picture svg", {0.1, 0.1}, {0.95, 0.95});
  chrome.wait(fmt::format("document.documentElement.dataset.chosen !== '{}'", chosen));
  chrome.click("#all-legs");
  chrome.wait("document.documentElement.dataset.chosen === ''");
  EXPECT_EQ(chrome.text("#figure-more"), worst);
  // By keys.
  chrome.click("#time-from");
  chrome.type("0");
  chrome.click("#time-to");
  chrome.type("60");
  chrome.click("#choose-time button");
  chrome.wait("document.documentElement.dataset.chosen > 0");
  EXPECT_NE(chrome.text("#exclude").find("and refit"), std::string::npos);
  chrome.click("#exclude");
  chrome.wait(at_step(1, 2));
  EXPECT_GT(legs("excluded"), 0);
  EXPECT_NE(chrome.text("#steps").find("without"), std::string::npos);
  EXPECT_NE(chrome.text("#legs-words").find("excluded"), std::string::npos);
  const std::string commands =
      chrome.eval("fetch('export/commands.sh').then(reply => reply.text())").get<std::string>();
  EXPECT_NE(commands.find("--exclude"), std::string::npos) << commands;
  chrome.reload();
  chrome.wait(at_step(1, 2));
  EXPECT_GT(legs("excluded"), 0);
  chrome.click("#undo");
  chrome.wait(at_step(0, 2));
  EXPECT_EQ(legs("excluded"), 0);
  chrome.click("#redo");
  chrome.wait(at_step(1, 2));
  chrome.click("#include");
  chrome.wait(at_step(2, 3));
  EXPECT_EQ(legs("excluded"), 0);
  EXPECT_EQ(chrome.complaints(), std::vector<std::string>());
}

/// Held-out legs are locked: choosing them alone offers nothing to exclude.
TEST(WorkbenchInBrowser, HeldOutLegsAreLocked) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const ServedBench bench(served(scratch, kRiddle, kRiddle + "/model.toml"));
  const nlohmann::json status = bench.settled();
  const auto post = [&](const std::string& what, double from, double to) {
    return bench.post(
        what, fmt::format(R"({{"do": "exclude", "version": {}, "choice": {{"time": [{}, {}]}}}})",
                          status.at("version").get<int>(), from, to));
  };
  // The whole recording in steps of a second: where all that is found is held out.
  bool found = false;
  for (double t = 0.0; !found && t < 2000.0; t += 1.0) {
    const testing::HttpAnswer answer = post("legs", t, t + 1.0);
    if (answer.status != 200) continue;
    const json legs = json::parse(answer.body).at("legs");
    if (legs.at("held_out") == 0 || legs.at("free") != 0) continue;
    found = true;
    EXPECT_EQ(post("step", t, t + 1.0).status, 202);
    EXPECT_NE(bench.settled().at("failed").get<std::string>().find("none of these legs"),
              std::string::npos);
    EXPECT_EQ(bench.state().at("steps").size(), 1U);
  }
  EXPECT_TRUE(found);
}

TEST(WorkbenchInBrowser, TwoTabsShowTheSame) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const ServedBench bench(served(scratch, kRiddle, kRiddle + "/model.toml"));
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  const std::size_t other = chrome.open_tab();
  chrome.go(bench.address());
  chrome.wait(at_step(0, 1));
  chrome.click(card("hard iron") + " .act");
  chrome.wait(at_step(1, 2));
  chrome.to_tab(other - 1);
  chrome.wait(at_step(1, 2));
  EXPECT_EQ(chrome.eval("document.querySelectorAll('#on .card').length"), 1);
}

}  // namespace
}  // namespace trussmap::workbench_in_browser_test
