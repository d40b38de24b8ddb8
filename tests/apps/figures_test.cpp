// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// maps/figures, and the README's pictures: commands make them again.
#include "scratch_folder.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::figures_test {
namespace {

namespace fs = std::filesystem;
using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

const fs::path kFigures = fs::path(TRUSSMAP_SOURCE_DIR) / "maps" / "figures";

std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// What a text says but for its numbers, and these. Colours (#7e5109) are words.
struct Parts {
  std::string words;
  std::vector<double> numbers;
};

Parts parts_of(const std::string& text) {
  static const std::regex number("#[0-9a-fA-F]+|[-+]?[0-9]+([.][0-9]+)?(e[-+]?[0-9]+)?");
  Parts parts;
  auto from = text.begin();
  for (auto at = std::sregex_iterator(text.begin(), text.end(), number);
       at != std::sregex_iterator(); ++at) {
    if ((*at)[0].str().front() == '#') continue;
    parts.words.append(from, (*at)[0].first);
    parts.words += '#';
    parts.numbers.push_back(std::strtod((*at)[0].str().c_str(), nullptr));
    from = (*at)[0].second;
  }
  parts.words.append(from, text.end());
  return parts;
}

/// Numbers may differ as other compilers round: the last digit drawn, and 1e-9 of a map's.
void expect_same(const fs::path& kept, const fs::path& made) {
  SCOPED_TRACE(kept.string());
  ASSERT_TRUE(fs::exists(made));
  const Parts expected = parts_of(text_of(kept));
  const Parts found = parts_of(text_of(made));
  EXPECT_EQ(found.words, expected.words);
  ASSERT_EQ(found.numbers.size(), expected.numbers.size());
  EXPECT_GT(found.numbers.size(), 40U);
  const double drawn = kept.extension() == ".svg" ? 0.011 : 0.0;
  for (std::size_t k = 0; k < found.numbers.size(); ++k) {
    const double close = drawn + 1e-9 * (1.0 + std::abs(expected.numbers[k]));
    ASSERT_NEAR(found.numbers[k], expected.numbers[k], close) << "number " << k;
  }
}

TEST(Figures, AreWhatTheirCommandsMake) {
  const ScratchFolder scratch;
  static const std::regex command("[$] build/trussmap (.*) (figure_[0-9]+)");
  const std::string readme = text_of(kFigures / "README.md");
  std::set<std::string> told;
  for (auto at = std::sregex_iterator(readme.begin(), readme.end(), command);
       at != std::sregex_iterator(); ++at) {
    const std::string folder = (*at)[2];
    told.insert(folder);
    const Ran ran = run_trussmap((*at)[1].str() + " " + (scratch.path() / folder).string());
    ASSERT_EQ(ran.status, 0) << (*at)[0] << "\n" << ran.output;
    for (const auto& kept : fs::directory_iterator(kFigures / folder)) {
      expect_same(kept.path(), scratch.path() / folder / kept.path().filename());
    }
  }
  std::set<std::string> there;
  for (const auto& entry : fs::directory_iterator(kFigures)) {
    if (entry.is_directory()) there.insert(entry.path().filename().string());
  }
  EXPECT_EQ(told, there);
  EXPECT_GE(told.size(), 4U);
}

/// By the commands that docs/exploration.md and docs/criticism.md show.
TEST(Figures, OfTheReadmeAreWhatCommandsMake) {
  const ScratchFolder scratch;
  const fs::path top(TRUSSMAP_SOURCE_DIR);
  const fs::path riddle = top / "maps" / "riddle";
  const fs::path map = scratch.path() / "exploring.svg";
  const fs::path charts = scratch.path() / "charts";
  const Ran explored = run_trussmap(
      "explore --mesh 4x3 --no-compass --wheels 0.01 --tours 1 --seed 4 --svg " + map.string());
  EXPECT_EQ(explored.status, 0) << explored.output;
  const Ran diagnosed =
      run_trussmap("diagnose " + riddle.string() + " --model " + (riddle / "model.toml").string() +
                   " --plots " + charts.string());
  EXPECT_EQ(diagnosed.status, 0) << diagnosed.output;
  expect_same(top / "docs" / "exploring.svg", map);
  expect_same(top / "docs" / "compass-error.svg", charts / "trend-1.svg");
}

TEST(Figures, AreReadAsWordsAndNumbers) {
  const Parts one = parts_of("<a x=\"1.5\" fill=\"#7e5109\"/><b y=\"-2e-3\"/>");
  EXPECT_EQ(one.words, "<a x=\"#\" fill=\"#7e5109\"/><b y=\"#\"/>");
  EXPECT_EQ(one.numbers, (std::vector<double>{1.5, -2e-3}));
}

/// The true map, the corrected one and its routes; what first sight was given, too.
TEST(TourMaps, HaveAPictureBesideEachMap) {
  const ScratchFolder scratch;
  const std::string folder = (scratch.path() / "maps").string();
  ASSERT_EQ(
      run_trussmap("tour --mesh 3x3 --tours 3 --seeds 2 --maps " + folder + " --maps-after 1,3")
          .status,
      0);
  const auto files = scratch.contents();
  EXPECT_EQ(files.size(), 22U);  // five methods after two tours, first sight after one; each twice
  const auto count = [](const std::string& text, const std::string& what) {
    int found = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) {
      ++found;
    }
    return found;
  };
  constexpr int kRoutes = 12;
  for (const char* name : {"elastic_1", "elastic_3", "elastic_printed_3", "gauss_markov_1",
                           "adjustment_3", "dead_reckoning_1", "first_sight_1"}) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(files.contains("maps/" + std::string(name) + ".svg"));
    ASSERT_TRUE(files.contains("maps/" + std::string(name) + ".graphml"));
    const std::string& picture = files.at("maps/" + std::string(name) + ".svg");
    const bool first = std::string(name) == "first_sight_1";
    EXPECT_EQ(count(picture, "<line class=\"true\""), kRoutes + 1);  // and one in the legend
    EXPECT_EQ(count(picture, "<line class=\"after\""), kRoutes + 1);
    EXPECT_EQ(count(picture, "<line class=\"measured\""), first ? kRoutes + 1 : 0);
    EXPECT_EQ(count(picture, "<path class=\"truth\""), first ? 9 + 1 : 0);
    EXPECT_EQ(count(files.at("maps/" + std::string(name) + ".graphml"), "<edge "), kRoutes);
  }
  EXPECT_NE(files.at("maps/elastic_3.svg").find("Elastic, after 3 tours: routes "),
            std::string::npos);
}

/// Where only the shape is known, the map is laid over the truth.
TEST(TourMaps, OfARobotWithoutACompassLieOnTheTruth) {
  const ScratchFolder scratch;
  ASSERT_EQ(
      run_trussmap("tour --polygon 5 --wheels 0.001 --no-compass --tours 2 --seeds 1 --maps " +
                   scratch.path().string() + " --maps-after 2")
          .status,
      0);
  const std::string picture = scratch.contents().at("adjustment_2.svg");
  static const std::regex line(
      "<line class=\"(true|after)\" x1=\"([0-9.]+)\" y1=\"([0-9.]+)\" x2=\"([0-9.]+)\"");
  std::vector<double> truth;
  std::vector<double> map;
  for (auto at = std::sregex_iterator(picture.begin(), picture.end(), line);
       at != std::sregex_iterator(); ++at) {
    if ((*at)[3] == "0") continue;  // the legend's
    for (const int k : {2, 3}) ((*at)[1] == "true" ? truth : map).push_back(std::stod((*at)[k]));
  }
  ASSERT_EQ(truth.size(), 10U);
  ASSERT_EQ(map.size(), truth.size());
  for (std::size_t k = 0; k < map.size(); ++k) EXPECT_NEAR(map[k], truth[k], 3.0);  // of 800 pixels
}

}  // namespace
}  // namespace trussmap::figures_test
