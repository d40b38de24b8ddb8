// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What shells and man take: held against --help, and tried in a real shell.
#include "child_process.hpp"
#include "scratch_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::completion_test {
namespace {

using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

std::vector<std::string> commands() {
  const std::string help = run_trussmap("--help").output;
  std::vector<std::string> names;
  const std::regex line("\n  ([a-z]+) +[A-Z]");
  const std::string list = help.substr(help.find("Subcommands"));
  for (auto at = std::sregex_iterator(list.begin(), list.end(), line); at != std::sregex_iterator();
       ++at) {
    names.push_back((*at)[1]);
  }
  return names;
}

std::set<std::string> options_of(const std::string& command) {
  const std::string help = run_trussmap(command + " --help").output;
  std::set<std::string> names;
  const std::regex option("\n  (?:-[a-z],)?(--[a-z0-9-]+)");
  for (auto at = std::sregex_iterator(help.begin(), help.end(), option);
       at != std::sregex_iterator(); ++at) {
    names.insert((*at)[1]);
  }
  return names;
}

std::string text_in(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null").c_str()) == 0;
}

TEST(Completion, OfEveryShellHasAllCommandsAndOptions) {
  const std::vector<std::string> names = commands();
  ASSERT_GT(names.size(), 15U);
  for (const char* shell : {"bash", "zsh", "fish"}) {
    const Ran ran = run_trussmap(std::string("completion ") + shell);
    ASSERT_EQ(ran.status, 0) << ran.output;
    for (const std::string& name : names) {
      EXPECT_NE(ran.output.find(name), std::string::npos) << shell << " " << name;
      for (const std::string& option : options_of(name)) {
        const std::string word = shell == std::string("fish") ? "-l " + option.substr(2) : option;
        EXPECT_NE(ran.output.find(word), std::string::npos) << shell << " " << name << option;
      }
    }
  }
  EXPECT_EQ(run_trussmap("completion csh").status, 2);
}

TEST(Completion, BashCompletesCommandsOptionsAndWords) {
  if (!has_program("bash")) GTEST_SKIP() << "needs bash";
  const ScratchFolder scratch;
  const auto script = scratch.write("completion", run_trussmap("completion bash").output);
  const auto completed = [&](const std::string& words) {
    const auto out = scratch.path() / "out";
    const auto test = scratch.write(
        "try.sh",
        ". " + script.string() + "\nCOMP_WORDS=(" + words +
            ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_trussmap\necho ${COMPREPLY[@]}\n");
    EXPECT_EQ(std::system(("bash " + test.string() + " > " + out.string() + " 2>&1").c_str()), 0);
    std::string text = text_in(out);
    while (text.ends_with('\n')) text.pop_back();
    return text;
  };
  EXPECT_EQ(completed("trussmap diag"), "diagnose");
  EXPECT_EQ(completed("trussmap co"), "compare completion contrast convert");
  EXPECT_EQ(completed("trussmap diagnose rec --exc"), "--exclude");
  EXPECT_EQ(completed("trussmap diagnose rec --without su"), "survey");
  EXPECT_EQ(completed("trussmap completion ''"), "bash zsh fish");
  EXPECT_EQ(completed("trussmap fleet mer"), "merge");
  EXPECT_EQ(completed("trussmap fleet add --met"), "--meta");
  EXPECT_EQ(completed("trussmap diagnose " + scratch.path().string() + "/comp"), script.string());
}

TEST(Completion, OtherShellsReadTheirs) {
  const ScratchFolder scratch;
  int tried = 0;
  for (const char* shell : {"zsh", "fish"}) {
    if (!has_program(shell)) continue;
    const auto script =
        scratch.write(shell, run_trussmap(std::string("completion ") + shell).output);
    EXPECT_EQ(std::system((std::string(shell) + " -n " + script.string()).c_str()), 0) << shell;
    ++tried;
  }
  if (tried == 0) GTEST_SKIP() << "needs zsh or fish";
}

TEST(Manual, HasAPagePerCommandWithAllItsOptions) {
  const ScratchFolder scratch;
  const std::filesystem::path folder = scratch.path() / "man1";
  const Ran ran = run_trussmap("manual --out " + folder.string());
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(text_in(folder / "trussmap.1").find("trussmap\\-diagnose (1)"), std::string::npos);
  for (const std::string& name : commands()) {
    const std::string page = text_in(folder / ("trussmap-" + name + ".1"));
    ASSERT_FALSE(page.empty()) << name;
    EXPECT_EQ(page.rfind(".TH TRUSSMAP", 0), 0U);
    for (const std::string& option : options_of(name)) {
      std::string escaped;
      for (const char one : option)
        escaped += one == '-' ? std::string("\\-") : std::string(1, one);
      EXPECT_NE(page.find(escaped), std::string::npos) << name << " " << option;
    }
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "trussmap-fleet-report.1"));
  if (!has_program("man")) return;
  const std::string checked = "LC_ALL=C.UTF-8 MANROFFSEQ= man --warnings -E UTF-8 -l -Tutf8 -Z " +
                              (folder / "trussmap-simulate.1").string() +
                              " 2>&1 >/dev/null | grep . ";
  EXPECT_NE(std::system(checked.c_str()), 0);  // no warning
}

}  // namespace
}  // namespace trussmap::completion_test
