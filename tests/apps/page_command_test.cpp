// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// --html of every command that has it, as a browser sees it.
#include "apps/browser.hpp"
#include "report/large_pages.hpp"
#include "report/some_charts.hpp"
#include "scratch_folder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::page_command_test {
using namespace report;
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

const std::string kMaps = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/";
const std::string kRiddle = kMaps + "riddle --model " + kMaps + "riddle/model.toml";

/// Runs a command with --html and has the page tried out.
json page_of(const ScratchFolder& scratch, const std::string& command) {
  const fs::path page = scratch.path() / "page.html";
  const Ran ran = run_trussmap(command + " --html " + page.string());
  EXPECT_EQ(ran.status, 0) << ran.output;
  EXPECT_LT(fs::file_size(page), 2'000'000U) << command;
  return testing::checked_page(page);
}

/// A robot whose wheels are 2 % farther apart than its model has them, on a winding way, with
/// truth.
std::string winding_drive(const ScratchFolder& scratch) {
  std::ostringstream drive, truth;
  drive << "t,left,right\n";
  truth << "t,x,y,heading\n";
  double x = 0.0, y = 0.0, heading = 0.0;
  for (int k = 1; k <= 600; ++k) {
    const double turn = 0.06 * std::sin(0.02 * k) + 0.002 * std::sin(1.7 * k);
    const double ahead = 0.03 + 0.001 * std::sin(2.3 * k);
    drive << 0.1 * k << "," << ahead - 0.17 * 1.02 * turn << "," << ahead + 0.17 * 1.02 * turn
          << "\n";
    x += ahead * std::cos(heading + 0.5 * turn);
    y += ahead * std::sin(heading + 0.5 * turn);
    heading += turn;
    truth << 0.1 * k << "," << x + 0.002 * std::sin(3.1 * k) << "," << y + 0.002 * std::cos(2.9 * k)
          << "," << heading + 0.004 * std::sin(3.7 * k) << "\n";
  }
  scratch.write("winding/drive.csv", drive.str());
  scratch.write("winding/truth.csv", truth.str());
  const fs::path model = scratch.write("winding/model.toml", "[robot]\nwheelbase = 0.34\n");
  return (scratch.path() / "winding").string() + " --model " + model.string();
}

/// What must be so of every page.
void expect_alive(const json& found, const std::string& command) {
  EXPECT_TRUE(found["errors"].empty()) << command << ": " << found["errors"].dump();
  EXPECT_TRUE(found["labelled"]) << command;
  EXPECT_EQ(found["images"], 0) << command;
  EXPECT_FALSE(found["charts"].empty()) << command;
  for (const json& chart : found["charts"]) {
    const std::string where = command + ", chart " + chart["id"].get<std::string>();
    EXPECT_GT(chart["marks"], 0) << where;
    EXPECT_NE(chart["hover"], "") << where;
    EXPECT_NE(chart["said"], "") << where;
    EXPECT_TRUE(chart["svg_valid"]) << where;
    EXPECT_TRUE(chart["svg_plain"]) << where;
    EXPECT_GT(chart["svg_shapes"], 5) << where;
    EXPECT_GT(chart["csv_rows"], 1) << where;
    EXPECT_GT(chart["table_rows"], 1) << where;
    if (chart.contains("zoom")) {
      EXPECT_TRUE(chart["zoom"]["nearer"]) << where;
      EXPECT_TRUE(chart["zoom"]["back"]) << where;
    }
  }
}

bool has_chart(const json& found, const std::string& id) {
  return std::any_of(found["charts"].begin(), found["charts"].end(),
                     [&id](const json& chart) { return chart["id"] == id; });
}

TEST(PageInBrowser, OfCompareAndFitIsAlive) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const json compared = page_of(scratch, "compare " + kRiddle);
  expect_alive(compared, "compare");
  EXPECT_NE(compared["verdict"].get<std::string>().find("does not explain"), std::string::npos);
  EXPECT_TRUE(has_chart(compared, "quantiles"));
  EXPECT_NE(testing::text_in(scratch.path() / "page.html").find("<dd>Give trussmap diagnose"),
            std::string::npos);
  const std::string model = (scratch.path() / "m.toml").string();
  ASSERT_EQ(run_trussmap("add " + kMaps + "riddle/model.toml \"hard iron\" --out " + model).status,
            0);
  const json fitted = page_of(scratch, "fit " + kMaps + "riddle --model " + model);
  expect_alive(fitted, "fit");
  EXPECT_NE(fitted["verdict"].get<std::string>().find("hard iron"), std::string::npos);
}

/// maps/riddle with a landmark of another name.
std::string renamed_riddle(const ScratchFolder& scratch, const std::string& landmark,
                           const std::string& name) {
  for (const char* file : {"drive.csv", "sightings.csv", "survey.csv", "model.toml"}) {
    std::string text = testing::text_in(kMaps + "riddle/" + file);
    for (const auto& [before, after] : {std::pair{",", "\n"}, std::pair{"\n", ","}}) {
      const std::string old = before + landmark + after;
      for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + 1)) {
        text.replace(at + 1, landmark.size(), name);
      }
    }
    scratch.write(std::string("riddle/") + file, text);
  }
  const std::string folder = (scratch.path() / "riddle").string();
  return folder + " --model " + folder + "/model.toml";
}

TEST(PageInBrowser, OfDiagnoseSaysWhatIsMissing) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const std::string hostile = "<script>document.title = 1</script>";
  const json found = page_of(scratch, "diagnose " + renamed_riddle(scratch, "L0_1", hostile));
  expect_alive(found, "diagnose");
  const std::string verdict = found["verdict"];
  EXPECT_NE(verdict.find("Missing: hard iron"), std::string::npos) << verdict;
  EXPECT_NE(verdict.find("2.9\u00b0"), std::string::npos) << verdict;
  EXPECT_TRUE(std::any_of(found["charts"].begin(), found["charts"].end(),
                          [](const json& chart) { return chart.contains("zoom"); }));
  EXPECT_NE(verdict.find("21 cm"), std::string::npos) << verdict;
  for (const char* id :
       {"effect-1", "ladder", "changes", "noise", "quantiles-1", "quantiles-2", "map-1", "map-2"}) {
    EXPECT_TRUE(has_chart(found, id)) << id;
  }
  const std::string html = testing::text_in(scratch.path() / "page.html");
  EXPECT_EQ(html.find(hostile), std::string::npos);
  EXPECT_NE(html.find("\\u003cscript>document.title = 1"), std::string::npos);
  EXPECT_TRUE(found["title"].get<std::string>().starts_with("trussmap diagnose")) << found["title"];
  EXPECT_NE(html.find("body tilt (a body that is tilted"), std::string::npos);
  EXPECT_NE(verdict.find("or body tilt"), std::string::npos) << verdict;
  for (const char* question :
       {"What is missing?", "How large?", "How sure?", "How far off is the robot?",
        "What else could it be?", "What to do next?"}) {
    EXPECT_NE(html.find(std::string("<dt>") + question + "</dt>"), std::string::npos) << question;
  }
  EXPECT_NE(html.find("To tell them apart, "), std::string::npos);
  for (const char* part : {"wheels", "turning", "floor", "compass", "sighting", "noise"}) {
    const bool good = html.find(std::string(">") + part + "</td>") != std::string::npos;
    const bool bad = html.find(std::string(">! ") + part + "</td>") != std::string::npos;
    EXPECT_TRUE(good || bad) << part;
  }
}

TEST(PageInBrowser, OfDiscoverHasTheLadder) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const fs::path plots = scratch.path() / "plots";
  const json found = page_of(scratch, "discover " + kRiddle + " --plots " + plots.string());
  expect_alive(found, "discover");
  const std::string verdict = found["verdict"];
  EXPECT_NE(verdict.find("Found: hard iron"), std::string::npos) << verdict;
  EXPECT_NE(testing::text_in(scratch.path() / "page.html").find("as good as its noise allows"),
            std::string::npos);
  EXPECT_TRUE(has_chart(found, "ladder"));
  for (const json& chart : found["charts"]) {
    EXPECT_TRUE(fs::exists(plots / (chart["id"].get<std::string>() + ".svg"))) << chart["id"];
  }
}

TEST(PageInBrowser, ShowsTheMapOfEveryModelOnTheWay) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const std::string folder = (scratch.path() / "two").string();
  ASSERT_EQ(run_trussmap("simulate --mesh 5x5 --tours 3 --seed 3 --effect \"hard iron=0.06,-0.04\" "
                         "--effect wheelbase=-0.03 --out " +
                         folder)
                .status,
            0);
  const json found = page_of(scratch, "discover " + folder + " --model " + folder + "/model.toml");
  expect_alive(found, "discover");
  const std::string verdict = found["verdict"];
  EXPECT_NE(verdict.find("hard iron (\u00b1"), std::string::npos) << verdict;
  EXPECT_NE(verdict.find("wheelbase ("), std::string::npos) << verdict;
  for (const char* id : {"map-1", "map-2", "map-3", "effect-1", "effect-2"}) {
    EXPECT_TRUE(has_chart(found, id)) << id;
  }
  EXPECT_FALSE(has_chart(found, "map-4"));
}

TEST(PageInBrowser, SaysPlainlyThatNothingExplainsTheErrors) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const std::string folder = (scratch.path() / "noisy").string();
  ASSERT_EQ(run_trussmap("simulate --mesh 4x4 --tours 3 --seed 3 --out " + folder).status, 0);
  std::string model = testing::text_in(folder + "/model.toml");
  for (const char* key : {"left = ", "right = ", "compass = ", "sighting = "}) {
    const std::size_t at = model.find(std::string("\n") + key);
    ASSERT_NE(at, std::string::npos) << key;
    const std::size_t value = at + 1 + std::string(key).size();
    const std::size_t end = model.find_first_of(" \n#", value);
    model.replace(value, end - value, std::to_string(std::stod(model.substr(value)) / 3.0));
  }
  const fs::path doubtful = scratch.write("doubtful.toml", model);
  const json found =
      page_of(scratch, "diagnose --stated-noise " + folder + " --model " + doubtful.string());
  expect_alive(found, "diagnose");
  const std::string verdict = found["verdict"];
  EXPECT_NE(verdict.find("no effect explains"), std::string::npos) << verdict;
  EXPECT_NE(verdict.find("More noise than the model states"), std::string::npos) << verdict;
  const std::string html = testing::text_in(scratch.path() / "page.html");
  EXPECT_NE(html.find("Check the noise in the model. Errors beside what it states: "),
            std::string::npos);
  // Judged by the noise as estimated there is nothing wrong but the noise.
  const json judged = page_of(scratch, "diagnose " + folder + " --model " + doubtful.string());
  const std::string again = judged["verdict"];
  EXPECT_NE(again.find("The noise is not as the model states it: wheels "), std::string::npos)
      << again;
  EXPECT_NE(again.find("No effect is missing"), std::string::npos) << again;
}

TEST(PageInBrowser, SaysPlainlyThatNothingIsMissing) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const std::string folder = (scratch.path() / "faultless").string();
  ASSERT_EQ(run_trussmap("simulate --mesh 4x4 --tours 2 --seed 3 --out " + folder).status, 0);
  const json found = page_of(scratch, "diagnose " + folder + " --model " + folder + "/model.toml");
  expect_alive(found, "diagnose");
  EXPECT_TRUE(found["verdict"].get<std::string>().starts_with("Nothing is missing"))
      << found["verdict"];
  const std::string html = testing::text_in(scratch.path() / "page.html");
  EXPECT_NE(html.find("Larger effects would have been seen: "), std::string::npos);
}

TEST(PageInBrowser, OfBuildAndTourIsAlive) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  expect_alive(page_of(scratch, "build " + kRiddle + " --method adjustment"), "build");
  const json grown = page_of(scratch, "build " + kRiddle + " --method elastic");
  expect_alive(grown, "build --method elastic");
  for (const char* id : {"tours-stretch", "tours-orientation", "tours-position"}) {
    EXPECT_TRUE(has_chart(grown, id)) << id;
  }
  expect_alive(page_of(scratch, "tour --mesh 3x3 --tours 4 --seeds 3"), "tour");
}

TEST(PageInBrowser, OfCalibrationsIsAlive) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  expect_alive(page_of(scratch, "umbmark " + kMaps + "square_runs.csv " + kMaps +
                                    "square_runs_2.csv --side 4 --wheelbase 0.34"),
               "umbmark");
  expect_alive(page_of(scratch, "noise --simulate --true-k-left 0.001 --true-k-right 0.0005"),
               "noise");
  expect_alive(page_of(scratch, "calibrate " + winding_drive(scratch)), "calibrate");
}

TEST(PageInBrowser, HostileNamesStayText) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  const std::string name = testing::kHostile;
  PageContent page;
  page.command = "compare";
  page.verdict = name;
  page.sections = {{name, {name, testing::charts_of_every_kind(name)}}};
  const std::string script = testing::text_in(TRUSSMAP_PAGE_SCRIPT);
  const fs::path file = scratch.write("page.html", render_page(page, {"", script}));
  const json found = testing::checked_page(file);
  expect_alive(found, "hostile");
  EXPECT_EQ(found["verdict"], name);
  EXPECT_EQ(found["title"], "trussmap compare: " + name);
  // The page's own, the two of the test, and one of data per chart.
  EXPECT_EQ(found["scripts"], 3 + testing::charts_of_every_kind(name).size());
  EXPECT_NE(found["charts"][0]["hover"].get<std::string>().find("</script>"), std::string::npos);
}

/// A script that came into the file later, and one in an attribute, do not run; the page's own
/// does.
TEST(PageInBrowser, RunsNoScriptButItsOwn) {
  TRUSSMAP_NEEDS_BROWSER();
  const ScratchFolder scratch;
  PageContent page;
  page.command = "compare";
  page.verdict = "nothing ran";
  page.sections = {{"charts", {testing::charts_of_every_kind("A")}}};
  const std::string script = testing::text_in(TRUSSMAP_PAGE_SCRIPT);
  std::string html = render_page(page, {"", script});
  html.insert(
      html.find("<main>"),
      "<script>document.title = 'a script ran'</script>"
      "<img src=\"x\" onerror=\"document.title = 'a handler ran'\">"
      "<script src=\"other.js\"></script>"
      "<iframe srcdoc=\"<script>parent.document.title = 'a frame ran'</script>\"></iframe>");
  scratch.write("other.js", "document.title = 'a file ran'");
  const std::string dom = testing::dom_of(scratch.write("page.html", html), true);
  EXPECT_NE(dom.find("<title>trussmap compare: nothing ran</title>"), std::string::npos);
  EXPECT_NE(dom.find("data-charts="), std::string::npos);
  // The same file without its policy shows that the attempts are real.
  const std::size_t policy = html.find("<meta http-equiv=\"Content-Security-Policy\"");
  html.erase(policy, html.find('\n', policy) - policy);
  const std::string open = testing::dom_of(scratch.write("open.html", html), true);
  EXPECT_EQ(open.find("<title>trussmap compare: nothing ran</title>"), std::string::npos);
}

}  // namespace
}  // namespace trussmap::page_command_test
