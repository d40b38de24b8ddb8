// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// The program of the build that makes the catalogue: what is wrong with an effect's file is one
// line that names file and line, and no source is written.
#include "effects/catalogue_record.hpp"
#include "scratch_folder.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <sys/wait.h>

#include <gtest/gtest.h>

namespace trussmap::catalogue_maker_test {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;

constexpr const char* kEffect = R"(name = "load scrub"
rank = 185
channel = "turn"
pattern = ["{}"]
cause = "tyres that scrub"
remedy = "inflate the tyres"
detectable = 0.004
drawing = { of = "turn scrub" }

[explanation]
does = "A loaded robot turns less far."
look = "Look at the tyres."
drive = "Ten full turns."

[hidden]
columns = ["payload_kg"]

[gallery]
group = "Turning"
happens = "Wide patches scrub."
look = "Turn ten times."
effect = "load scrub (payload_kg)=-0.004"
)";

struct Made {
  int status = 0;
  std::string said;
};

Made make(const ScratchFolder& scratch, const std::string& files) {
  const std::string command = std::string(TRUSSMAP_CATALOGUE_MAKER) + " " +
                              (scratch.path() / "out.cpp").string() + " " + files + " 2>&1";
  FILE* pipe = ::popen(command.c_str(), "r");
  Made made;
  std::array<char, 256> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) made.said += part.data();
  made.status = WEXITSTATUS(::pclose(pipe));
  return made;
}

/// The effect with one thing changed.
std::string with(const std::string& from, const std::string& to) {
  const std::string text = kEffect;
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return std::string(text).replace(at, from.size(), to);
}

TEST(CatalogueMaker, WritesARecordOfEachFile) {
  const ScratchFolder scratch;
  const std::string file = scratch.write("load-scrub.toml", kEffect);
  const Made made = make(scratch, file);
  ASSERT_EQ(made.status, 0) << made.said;
  const std::string source = scratch.contents().at("out.cpp");
  for (const char* text :
       {".name = \"load scrub\"", ".channel = Channel::turn", ".pattern = {\"{}\"}",
        ".detectable = 0.004", ".drawing = {\"turn scrub\", \"\"}"}) {
    EXPECT_NE(source.find(text), std::string::npos) << text << "\n" << source;
  }
}

TEST(CatalogueMaker, SaysInOneLineWhatIsWrong) {
  struct Fault {
    const char* from;
    const char* to;
    const char* said;  ///< after the file's name
  };
  const Fault faults[] = {
      {"\"turn\"", "\"spin\"", ":3: channel \"spin\" is unknown, expected one of travel, left"},
      {"[\"{}\"]", "[\"{}+\"]", ":4: shape \"column+\""},
      {"[\"{}\"]", "\"{}\"", ":4: \"pattern\" is something else, expected a list of texts"},
      {"rank = 185", "rank = \"185\"", ":2: \"rank\" is something else, expected a whole number"},
      {"remedy = \"inflate the tyres\"\n", "", ":1: \"remedy\" is missing or empty"},
      {"[explanation]", "[explanations]", ": \"does\" in [explanation] is missing or empty"},
      {"detectable", "detectible", ":7: unknown key \"detectible\", expected one of also_of"},
      {"look = \"Turn", "lok = \"Turn", ":18: \"look\" in [gallery] is missing or empty"},
      {"effect = \"load scrub", "effect = \"scrub", ":22: \"effect\" in [gallery] is another"},
      {"drive = \"Ten full turns.\"", "drive = \"Ten full turns.\"\nsign = -1",
       ":14: \"sign\" and \"otherwise\" in [explanation] go together"},
      {"\"load scrub\"", "\"load slip\"", ":1: \"load slip\" stands in a file of another name"},
      {"columns = [\"payload_kg\"]", "", ":15: \"columns\" in [hidden] is missing"},
      {"[explanation]", "[[parameters]]\nname = \"v0\"\nunit = \"1\"\n\n[explanation]",
       ":4: \"pattern\" has a column ({}) and parameters"},
      {"rank = 185", "rank == 185", ":2: "}};
  const ScratchFolder scratch;
  for (const Fault& one : faults) {
    const fs::path file = scratch.write("load-scrub.toml", with(one.from, one.to));
    const Made made = make(scratch, file.string());
    EXPECT_EQ(made.status, 1) << one.to;
    EXPECT_TRUE(made.said.starts_with(file.string() + one.said)) << made.said;
    EXPECT_EQ(std::count(made.said.begin(), made.said.end(), '\n'), 1) << made.said;
    EXPECT_FALSE(scratch.contents().contains("out.cpp")) << one.to;
  }
}

TEST(CatalogueMaker, GivesEachEffectItsOwnPlace) {
  const ScratchFolder scratch;
  const std::string one = scratch.write("load-scrub.toml", kEffect);
  std::string text = with("\"load scrub\"", "\"load slip\"");
  text.replace(text.find("effect = \"load scrub"), 20, "effect = \"load slip");
  const std::string other = scratch.write("load-slip.toml", text);
  const Made made = make(scratch, one + " " + other);
  EXPECT_EQ(made.status, 1);
  EXPECT_NE(made.said.find("rank 185 is that of \"load s"), std::string::npos) << made.said;
}

/// Each file of the folder is in the catalogue, and nothing else.
TEST(CatalogueMaker, HasTakenEveryFile) {
  std::set<std::string> files, records;
  for (const auto& one : fs::directory_iterator(TRUSSMAP_SOURCE_DIR "/src/effects/catalogue")) {
    if (one.path().extension() == ".toml") files.insert(one.path().stem().string());
  }
  for (const effects::CatalogueRecord& one : effects::catalogue_records()) {
    std::string name(one.entry.name);
    std::replace(name.begin(), name.end(), ' ', '-');
    records.insert(name);
  }
  EXPECT_GT(files.size(), 50U);
  EXPECT_EQ(files, records);
}

}  // namespace
}  // namespace trussmap::catalogue_maker_test
