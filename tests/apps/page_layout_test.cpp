// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Pages on a narrow screen and on paper: nothing slides sideways, headlines are short, tables are
// cards, one sheet holds what is first.
#include "apps/riddle_pages.hpp"
#include "apps/served_bench.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <regex>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::page_layout_test {
namespace {

using nlohmann::json;
using testing::Chrome;
using testing::ScratchFolder;
using testing::ServedBench;

/// What sticks out to the right of the window, or slides sideways within itself.
constexpr const char* kTooWide = R"js((() => {
  const found = [];
  if (document.documentElement.scrollWidth > innerWidth) found.push('page ' + document.documentElement.scrollWidth);
  for (const one of document.querySelectorAll('body *')) {
    const box = one.getBoundingClientRect();
    if (!box.width || one.closest('.unseen, thead, svg, [hidden]')) continue;
    const name = one.tagName + '.' + one.className + ' ' + one.textContent.trim().slice(0, 30);
    if (box.right > innerWidth + 1) found.push('sticks out: ' + name);
    if (one.scrollWidth > one.clientWidth + 1 && ['auto', 'scroll'].includes(getComputedStyle(one).overflowX)) {
      found.push('slides: ' + name);
    }
  }
  return found.slice(0, 8);
})())js";

constexpr const char* kLinesOfHeadline =
    "(() => { const h = document.querySelector('h1'); "
    "return Math.round(h.getBoundingClientRect().height / "
    "parseFloat(getComputedStyle(h).lineHeight)); "
    "})()";

void narrow(Chrome& chrome) {
  chrome.look_as(420, 900, false);
  chrome.eval("new Promise(done => setTimeout(done, 400))");
}

void expect_narrow_enough(Chrome& chrome, const std::string& what) {
  EXPECT_EQ(chrome.eval(kTooWide), json::array()) << what;
  EXPECT_LE(chrome.eval(kLinesOfHeadline).get<int>(), 3) << what << ": " << chrome.text("h1");
}

std::string decoded(const std::string& text) {
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int have = 0;
  for (const char c : text) {
    const std::size_t at = letters.find(c);
    if (at == std::string::npos) continue;
    bits = (bits << 6U) | static_cast<std::uint32_t>(at);
    if ((have += 6) < 8) continue;
    have -= 8;
    bytes += static_cast<char>((bits >> static_cast<unsigned>(have)) & 255U);
  }
  return bytes;
}

/// Pages of a PDF, and the width and height of its first, points.
struct Sheets {
  int count = 0;
  double width = 0.0;
  double height = 0.0;
};

Sheets sheets_of(const std::string& pdf) {
  static const std::regex kPage(R"(/Type\s*/Page[^s])");
  static const std::regex kBox(R"(/MediaBox\s*\[0 0 ([0-9.]+) ([0-9.]+)\])");
  Sheets sheets;
  for (std::sregex_iterator at(pdf.begin(), pdf.end(), kPage), end; at != end; ++at) ++sheets.count;
  std::smatch box;
  if (std::regex_search(pdf, box, kBox)) {
    sheets.width = std::stod(box[1]);
    sheets.height = std::stod(box[2]);
  }
  return sheets;
}

void expect_one_sheet(Chrome& chrome, const std::string& what) {
  chrome.look_as(1280, 900, false);
  chrome.eval("new Promise(done => setTimeout(done, 400))");
  const Sheets sheets = sheets_of(decoded(chrome.print()));
  EXPECT_EQ(sheets.count, 1) << what;
  EXPECT_NEAR(sheets.width, 595.0, 2.0) << what;  // A4
  EXPECT_NEAR(sheets.height, 842.0, 2.0) << what;
}

void expect_well_laid_out(const std::string& command) {
  const ScratchFolder scratch;
  const std::filesystem::path page = testing::page_made_by(scratch, command);
  Chrome chrome(scratch.path());
  testing::open_page(chrome, page);
  expect_one_sheet(chrome, command);
  narrow(chrome);
  expect_narrow_enough(chrome, command);
  chrome.eval("document.querySelectorAll('details.more').forEach(one => { one.open = true; })");
  chrome.eval("new Promise(done => setTimeout(done, 400))");
  expect_narrow_enough(chrome, command + ", with its details");
  // Tables are cards: each cell has its heading beside it.
  EXPECT_TRUE(
      chrome
          .eval("[...document.querySelectorAll('.table:not(.chart .table) tbody tr')].every(row => "
                "getComputedStyle(row).display === 'block' && [...row.cells].every(cell => "
                "cell.dataset.heading !== undefined))")
          .get<bool>())
      << command;
  // Names are wrapped, not cut.
  EXPECT_EQ(
      chrome.eval("[...document.querySelectorAll('.picture svg text')]"
                  ".filter(one => one.textContent.includes('\u2026')).map(one => one.textContent)"),
      json::array())
      << command;
  EXPECT_EQ(chrome.complaints(), std::vector<std::string>());
}

TEST(PageLayoutInBrowser, Compare) {
  TRUSSMAP_NEEDS_BROWSER();
  expect_well_laid_out("compare");
}

TEST(PageLayoutInBrowser, Diagnose) {
  TRUSSMAP_NEEDS_BROWSER();
  expect_well_laid_out("diagnose");
}

TEST(PageLayoutInBrowser, Fit) {
  TRUSSMAP_NEEDS_BROWSER();
  expect_well_laid_out("fit");
}

TEST(PageLayoutInBrowser, Discover) {
  TRUSSMAP_NEEDS_BROWSER();
  expect_well_laid_out("discover");
}

TEST(PageLayoutInBrowser, Workbench) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const std::string riddle = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";
  const ServedBench bench(
      {riddle, "--model", riddle + "/model.toml", "--work", (scratch.path() / "work").string()});
  Chrome chrome(scratch.path());
  chrome.go(bench.address());
  chrome.wait("document.documentElement.dataset.busy === 'false'");
  chrome.click("#parts .card .explain");
  chrome.wait("document.querySelector('#parts .explanation svg')");
  chrome.eval("document.querySelectorAll('details').forEach(one => { one.open = true; })");
  narrow(chrome);
  expect_narrow_enough(chrome, "workbench");
}

TEST(PageLayoutInBrowser, SheetsAreCounted) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const auto page = scratch.write(
      "two.html",
      "<!DOCTYPE html><title>x</title><style>@page { size: A4 } p { break-after: page }</style>"
      "<p>one</p>two<div style=\"width: 2000px\">wide</div>");
  Chrome chrome(scratch.path());
  chrome.go("file://" + page.string());
  chrome.wait("document.querySelector('div')");
  EXPECT_EQ(sheets_of(decoded(chrome.print())).count, 2);
  narrow(chrome);
  EXPECT_FALSE(chrome.eval(kTooWide).empty());
}

}  // namespace
}  // namespace trussmap::page_layout_test
