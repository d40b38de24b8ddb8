// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Pages as those find them who do not see them well, or not at all, or have no pointer: what axe
// says of them, wide and narrow, light and dark. Axe is installed by .ci/page-tools.
#include "apps/riddle_pages.hpp"
#include "apps/served_bench.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::accessible_pages_test {
namespace {

using nlohmann::json;
using testing::Chrome;
using testing::ScratchFolder;
using testing::ServedBench;

const std::string kAxe = TRUSSMAP_PAGE_TOOLS "/node_modules/axe-core/axe.min.js";

#define TRUSSMAP_NEEDS_AXE() \
  TRUSSMAP_NEEDS_BROWSER();  \
  if (!std::filesystem::exists(kAxe)) GTEST_SKIP() << "needs axe (.ci/page-tools, npm)"

/// "color-contrast: Elements must meet ...: .hint" for each serious or critical fault. Pictures are
/// images with a name: what is within them is for those who see them.
std::vector<std::string> faults(Chrome& chrome) {
  chrome.eval(testing::text_in(kAxe));
  const json found = chrome.eval(
      "axe.run({exclude: ['.picture svg']}, {resultTypes: ['violations']}).then(result => "
      "result.violations"
      ".filter(one => ['serious', 'critical'].includes(one.impact))"
      ".flatMap(one => one.nodes.map(node => one.id + ': ' + one.help + ': ' + node.target.join(' "
      "')"
      " + ' ' + node.failureSummary)))");
  return found.get<std::vector<std::string>>();
}

void expect_no_faults(Chrome& chrome, const std::string& what) {
  for (const bool dark : {false, true}) {
    for (const int width : {1280, 420}) {
      chrome.look_as(width, 900, dark);
      chrome.eval("new Promise(done => setTimeout(done, 400))");  // charts follow the width
      const std::vector<std::string> found = faults(chrome);
      EXPECT_EQ(found, std::vector<std::string>())
          << what << ", " << width << " wide, " << (dark ? "dark" : "light");
    }
  }
}

/// All but the data of the charts: of these the first alone, they are alike and long.
constexpr const char* kOpenAll =
    "(() => { document.querySelectorAll('details:not(.tools details)').forEach("
    "one => { one.open = true; }); "
    "const data = document.querySelector('.tools details'); if (data) data.open = true; })()";

void expect_accessible(const std::string& command) {
  const ScratchFolder scratch;
  const std::filesystem::path page = testing::page_made_by(scratch, command);
  Chrome chrome(scratch.path());
  testing::open_page(chrome, page);
  chrome.eval(kOpenAll);
  expect_no_faults(chrome, command);
}

TEST(AccessibleInBrowser, Compare) {
  TRUSSMAP_NEEDS_AXE();
  expect_accessible("compare");
}

TEST(AccessibleInBrowser, Diagnose) {
  TRUSSMAP_NEEDS_AXE();
  expect_accessible("diagnose");
}

TEST(AccessibleInBrowser, Fit) {
  TRUSSMAP_NEEDS_AXE();
  expect_accessible("fit");
}

TEST(AccessibleInBrowser, Discover) {
  TRUSSMAP_NEEDS_AXE();
  expect_accessible("discover");
}

TEST(AccessibleInBrowser, Workbench) {
  TRUSSMAP_NEEDS_AXE();
  const ScratchFolder scratch;
  const std::string riddle = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";
  const ServedBench bench(
      {riddle, "--model", riddle + "/model.toml", "--work", (scratch.path() / "work").string()});
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait("document.documentElement.dataset.busy === 'false'");
  chrome.click("#parts .card .explain");
  chrome.wait("document.querySelector('#parts .explanation svg')");
  chrome.click("#parts .card .act");
  chrome.wait(
      "document.documentElement.dataset.at === '1' && "
      "document.documentElement.dataset.busy === 'false'");
  chrome.click("#steps .rename");
  chrome.eval(kOpenAll);
  expect_no_faults(chrome, "workbench");
}

/// The check itself is not blind.
TEST(AccessibleInBrowser, FaultsAreFound) {
  TRUSSMAP_NEEDS_AXE();
  const ScratchFolder scratch;
  const auto page = scratch.write(
      "bad.html",
      "<!DOCTYPE html><html lang=\"en\"><head><title>x</title></head><body><main>"
      "<p style=\"color: #bbb; background: #fff\">faint</p><input></main></body></html>");
  Chrome chrome(scratch.path());
  chrome.go("file://" + page.string());
  chrome.wait("document.querySelector('input')");
  const std::vector<std::string> found = faults(chrome);
  ASSERT_EQ(found.size(), 2U) << json(found).dump(1);
  EXPECT_TRUE(found[0].starts_with("color-contrast")) << found[0];
  EXPECT_TRUE(found[1].starts_with("label")) << found[1];
}

}  // namespace
}  // namespace trussmap::accessible_pages_test
