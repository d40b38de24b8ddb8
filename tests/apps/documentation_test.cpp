// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What README and docs show of the command: every example "$ build/trussmap ..." is run, from a
// copy of the project's examples, and must print what the page has below it.
#include "scratch_folder.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::documentation_test {
namespace {

namespace fs = std::filesystem;
using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

struct Example {
  std::string arguments;
  std::string shown;     ///< of the output
  bool complete = true;  ///< false: "..." stands for the rest
};

std::vector<Example> examples_of(std::istream& page) {
  const std::string prompt = "$ build/trussmap ";
  std::vector<Example> examples;
  bool code = false;
  bool open = false;
  for (std::string line; std::getline(page, line);) {
    if (line.rfind("```", 0) == 0) {
      code = !code;
      open = false;
    } else if (code && line.rfind(prompt, 0) == 0) {
      examples.push_back({line.substr(prompt.size()), "", true});
      open = true;
    } else if (open && line == "...") {
      examples.back().complete = false;
      open = false;
    } else if (open) {
      examples.back().shown += line + '\n';
    }
  }
  return examples;
}

/// The process stands in another folder for as long as this lives.
class WorkingFolder {
 public:
  explicit WorkingFolder(const fs::path& folder) : before_(fs::current_path()) {
    fs::current_path(folder);
  }
  ~WorkingFolder() {
    std::error_code ignored;
    fs::current_path(before_, ignored);
  }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;

 private:
  fs::path before_;
};

TEST(DocumentedCommands, PrintWhatThePagesShow) {
  const fs::path top(TRUSSMAP_SOURCE_DIR);
  std::vector<fs::path> pages{top / "README.md"};
  for (const auto& entry : fs::directory_iterator(top / "docs")) {
    if (entry.path().extension() == ".md") pages.push_back(entry.path());
  }

  int ran_examples = 0;
  for (const fs::path& page : pages) {  // each begins anew
    const ScratchFolder scratch;
    fs::copy(top / "maps", scratch.path() / "maps", fs::copy_options::recursive);
    const WorkingFolder here(scratch.path());
    std::ifstream text(page);
    for (const Example& example : examples_of(text)) {
      const Ran ran = run_trussmap(example.arguments);
      EXPECT_EQ(ran.status, 0) << page << ": " << example.arguments << '\n' << ran.output;
      const std::string printed =
          example.complete ? ran.output : ran.output.substr(0, example.shown.size());
      EXPECT_EQ(printed, example.shown) << page << ": " << example.arguments;
      ++ran_examples;
    }
  }
  EXPECT_GE(ran_examples, 5);
}

TEST(DocumentedCommands, AreFoundInCodeAlone) {
  std::istringstream page("$ build/trussmap x\n```\n$ build/trussmap fit a\nb\n\n...\nc\n```\n");
  const std::vector<Example> examples = examples_of(page);
  ASSERT_EQ(examples.size(), 1U);
  EXPECT_EQ(examples[0].arguments, "fit a");
  EXPECT_EQ(examples[0].shown, "b\n\n");
  EXPECT_FALSE(examples[0].complete);
}

}  // namespace
}  // namespace trussmap::documentation_test
