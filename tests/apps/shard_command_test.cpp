// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Runs in shares, as job arrays make them: the same bytes as the whole run.
#include "scratch_folder.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace trussmap::shard_command_test {
namespace {

using testing::Ran;
using testing::run_trussmap;

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr const char* kTour = "tour --mesh 3x3 --tours 2 --seeds 18";

TEST(ShardCommand, OneThreeAndSixteenSharesGiveTheWholeRunsBytes) {
  const testing::ScratchFolder scratch;
  const auto path = [&](const std::string& name) { return (scratch.path() / name).string(); };
  const Ran whole = run_trussmap(fmt::format("{} --json {}", kTour, path("whole.json")));
  ASSERT_EQ(whole.status, 0) << whole.output;
  for (const int shares : {1, 3, 16}) {
    std::string parts;
    for (int k = shares; k >= 1; --k) {
      const std::string part = path(fmt::format("{}of{}", k, shares));
      const Ran one =
          run_trussmap(fmt::format("{} --shard {}/{} --out {}", kTour, k, shares, part));
      ASSERT_EQ(one.status, 0) << one.output;
      parts += fmt::format(" {}", part);
    }
    const Ran merged = run_trussmap(fmt::format("merge{} --json {}", parts, path("merged.json")));
    EXPECT_EQ(merged.status, 0);
    EXPECT_EQ(merged.output, whole.output) << shares;
    EXPECT_EQ(content_of(path("merged.json")), content_of(path("whole.json"))) << shares;
  }
  const Ran missing = run_trussmap(fmt::format("merge {} {}", path("1of3"), path("3of3")));
  EXPECT_EQ(missing.status, 2);
  EXPECT_EQ(missing.output,
            fmt::format("trussmap: {}: the run has 3 shards, missing: 2\n", path("1of3")));
}

TEST(ShardCommand, SaysWhatDoesNotFit) {
  for (const char* wrong : {"--shard 1/2", "--out x", "--shard 3/2 --out x",
                            "--shard 1/2 --out x --json y", "--shard 2/2 --out x --maps y"}) {
    const Ran outcome = run_trussmap(fmt::format("{} {}", kTour, wrong));
    EXPECT_EQ(outcome.status, 2) << wrong;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
  }
}

}  // namespace
}  // namespace trussmap::shard_command_test
