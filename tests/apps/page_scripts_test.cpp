// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The pages' scripts, by their types: what the type checker says of them, and whether the program
// sends what the types say. The checker is TypeScript's, installed by .ci/page-tools.
#include "apps/browser.hpp"
#include "apps/declared_types.hpp"
#include "apps/served_bench.hpp"
#include "report/some_charts.hpp"
#include "scratch_folder.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::page_scripts_test {
using namespace plot;
namespace {

using nlohmann::json;
using testing::DeclaredTypes;
using testing::ScratchFolder;
using testing::ServedBench;

const std::string kTop = TRUSSMAP_SOURCE_DIR;
const std::string kTypeChecker = TRUSSMAP_PAGE_TOOLS "/node_modules/typescript/bin/tsc";

/// What the checker has to say of a project, line by line; nothing where all is well.
std::string said_of(const std::string& project) {
  return testing::output_of("node '" + kTypeChecker + "' -p '" + project + "' 2>&1");
}

TEST(PageScripts, KeepToTheirTypes) {
  if (!std::filesystem::exists(kTypeChecker)) {
    GTEST_SKIP() << "needs the type checker of the pages' scripts (.ci/page-tools, npm)";
  }
  EXPECT_EQ(said_of(kTop + "/tests/page/tsconfig.json"), "");
  // A script that asks for what is never sent is found.
  const ScratchFolder scratch;
  scratch.write("page/wrong.js",
                "/** @param {BenchState} state */\n"
                "export const wrong = state => state.steps[0].millimetres;\n");
  std::string project = testing::text_in(kTop + "/tests/page/tsconfig.json");
  const std::string own = "\"../../src/report/page/*\"";
  project.replace(project.find(own), own.size(),
                  "\"page/wrong.js\", " + json(kTop + "/src/report/page/types.d.ts").dump());
  const std::string said = said_of(scratch.write("tsconfig.json", project).string());
  EXPECT_NE(said.find("'millimetres' does not exist"), std::string::npos) << said;
}

json answer(const ServedBench& bench, const std::string& path, const json& asked) {
  return json::parse(bench.post(path, asked.dump()).body);
}

/// A status as it is while a step is made.
json status_at_work(const ServedBench& bench) {
  for (int k = 0; k < 1000; ++k) {
    const json status = bench.status();
    if (status.contains("doing")) return status;
  }
  throw std::runtime_error("the work was never under way");
}

TEST(PageScripts, GetWhatTheirTypesSay) {
  DeclaredTypes types(testing::text_of("src/report/page/types.d.ts"));
  for (const Chart& chart : testing::charts_of_every_kind("A")) {
    types.hold(json::parse(chart_json(chart)), "Chart", chart.id);
  }
  Chart ranged = testing::line_like_chart("A");
  ranged.x.range = Range{0.0, 1.0};
  ranged.layers.back().dashed = true;
  ranged.layers.back().size = 3.0;
  types.hold(json::parse(chart_json(ranged)), "Chart", "ranged");

  const ScratchFolder scratch;
  const ServedBench bench({kTop + "/maps/riddle", "--model", kTop + "/maps/riddle/model.toml",
                           "--work", (scratch.path() / "work").string()});
  types.hold(status_at_work(bench), "BenchStatus", "status at work");
  const json status = bench.settled();
  types.hold(status, "BenchStatus", "status");
  const json state = bench.state();
  types.hold(state, "BenchState", "state");
  for (const json& card : state.at("cards")) {
    types.hold(answer(bench, "preview", {{"finding", card.at("finding")}, {"rivals", {0, 1}}}),
               "Preview", "preview of " + card.at("name").get<std::string>());
    types.hold(answer(bench, "explain", {{"finding", card.at("finding")}}), "ExplainReply",
               "explanation of " + card.at("name").get<std::string>());
    json values = json::array();
    for (const json& parameter : card.at("parameters")) values.push_back(parameter.at("value"));
    if (values.empty()) continue;
    types.hold(answer(bench, "best", {{"finding", card.at("finding")}, {"values", values}}),
               "BestReply", "best");
  }
  types.hold(answer(bench, "legs", {{"choice", {{"time", {0.0, 100.0}}}}}), "Selection", "legs");
  types.hold(answer(bench, "noise", {{"factor", 2.0}}), "NoiseReply", "noise");
  types.hold(answer(bench, "noise", {{"factor", -2.0}}), "Refusal", "refusal");
  answer(bench, "step", {{"version", status.at("version")}, {"do", "add"}, {"finding", 0}});
  static_cast<void>(bench.settled());
  types.hold(bench.state(), "BenchState", "state with an effect");
  types.hold(answer(bench, "shown", {{"effect", 0}}), "Preview", "an effect of the model");

  // Without a survey not all can be seen.
  const auto drive = scratch.write("bare/drive.csv", testing::text_of("maps/riddle/drive.csv"));
  scratch.write("bare/sightings.csv", testing::text_of("maps/riddle/sightings.csv"));
  const ServedBench bare({drive.parent_path().string(), "--model", kTop + "/maps/riddle/model.toml",
                          "--work", (scratch.path() / "bare_work").string()});
  static_cast<void>(bare.settled());
  types.hold(bare.state(), "BenchState", "state without a survey");

  EXPECT_EQ(types.lapses, std::vector<std::string>());
  EXPECT_EQ(types.never_sent(), std::set<std::string>());
}

TEST(PageScripts, TypesThatLieAreFound) {
  const std::string text =
      "type Kind = 'a' |\n    'b';\ninterface Inner {\n  kind: Kind;\n}\n"
      "interface Outer {\n  size: number | null;\n  more?: (Inner | string)[];\n  never?: "
      "string;\n}\n";
  DeclaredTypes types(text);
  types.hold({{"size", nullptr}, {"more", {{{"kind", "b"}}, "text"}}}, "Outer", "x");
  EXPECT_EQ(types.lapses, std::vector<std::string>());
  EXPECT_EQ(types.never_sent(), std::set<std::string>{"Outer.never"});
  types.hold({{"more", {{{"kind", "c"}}, 1}}, {"other", 0}}, "Outer", "y");
  const std::vector<std::string> expected{
      "y lacks size of Outer", "y.more[].kind is \"c\", not Kind",
      "y.more[] is 1, not Inner | string", "y.other is not in Outer"};
  EXPECT_EQ(types.lapses, expected);
}

}  // namespace
}  // namespace trussmap::page_scripts_test
