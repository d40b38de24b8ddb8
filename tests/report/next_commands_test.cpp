// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The command that a page tells its reader to run next.
#include "apps/browser.hpp"
#include "scratch_folder.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/discover.hpp"
#include "trussmap/pages.hpp"

#include <filesystem>
#include <memory>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::next_commands_test {
namespace {

using testing::run_trussmap;
using testing::ScratchFolder;
using testing::text_in;

TEST(NextCommands, GoWithTheVerdict) {
  Comparison compared;
  EXPECT_EQ(next_command(compared)->command, "build");
  compared.objection = Objection::chi2;
  EXPECT_EQ(next_command(compared)->command, "diagnose");

  Diagnosis found;
  EXPECT_EQ(next_command(found)->command, "build");
  found.verdict = Diagnosis::Verdict::missing;
  EXPECT_EQ(next_command(found)->command, "discover");
  found.verdict = Diagnosis::Verdict::unexplained_misfit;
  found.objection = Objection::chi2;
  EXPECT_EQ(next_command(found)->command, "check");
  found.objection = Objection::place;
  EXPECT_FALSE(next_command(found));

  Discovery discovery;
  EXPECT_EQ(next_command(discovery, false)->command, "build");
  discovery.found.model.effects.emplace_back();
  EXPECT_EQ(next_command(discovery, false)->command, "discover");
  EXPECT_EQ(next_command(discovery, true)->command, "build");

  Discovery noisy;
  auto under = std::make_shared<FitWithNoise>();
  under->noise.gain = 50.0;
  under->noise.sources.emplace_back();
  under->noise.sources.back().stated = 0.003;
  under->noise.sources.back().sd = 0.006;
  noisy.last.under = under;
  EXPECT_EQ(next_command(noisy, false)->command, "fit");
  EXPECT_EQ(next_command(noisy, true)->command, "build");  // the file has that noise

  discovery.consistent = false;
  discovery.last.verdict = Diagnosis::Verdict::unexplained_misfit;
  discovery.last.objection = Objection::chi2;
  EXPECT_EQ(next_command(discovery, true)->command, "check");
}

/// The line on the page, as a user would paste it.
std::string next_line(const std::string& page) {
  const std::string open = "<dt>Next command</dt>";
  const std::size_t begin = page.find("<pre>trussmap ", page.find(open));
  if (page.find(open) == std::string::npos || begin == std::string::npos) return "";
  const std::size_t from = begin + std::string("<pre>trussmap ").size();
  return page.substr(from, page.find("</pre>", from) - from);
}

TEST(NextCommands, OfPagesLeadFromAMisfitToAMap) {
  const ScratchFolder scratch;
  const std::string at = scratch.path().string() + "/";
  ASSERT_EQ(run_trussmap("simulate --seed 3 --tours 2 --effect wheelbase=0.03 --out " + at + "rec")
                .status,
            0);
  std::string line = "compare " + at + "rec --model " + at + "rec/model.toml";
  for (const std::string expected : {"diagnose ", "discover ", "build "}) {
    const std::string page = at + "page.html";
    // Written where the test may write.
    const std::size_t out = line.find("--out ");
    if (out != std::string::npos) line.insert(out + std::string("--out ").size(), at);
    const auto ran = run_trussmap(line + " --html " + page);
    ASSERT_EQ(ran.status, 0) << line << "\n" << ran.output;
    line = next_line(text_in(page));
    EXPECT_EQ(line.substr(0, expected.size()), expected) << line;
  }
  EXPECT_NE(line.find("found.toml"), std::string::npos) << line;
  line.insert(line.find("--out ") + std::string("--out ").size(), at);
  EXPECT_EQ(run_trussmap(line).status, 0) << line;
  EXPECT_TRUE(std::filesystem::exists(at + "map.graphml"));
}

}  // namespace
}  // namespace trussmap::next_commands_test
