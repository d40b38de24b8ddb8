// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Rooms build on each other in one direction, and what is behind their doors stays there. Every
// #include of the project is read:
//
//   src/ROOM          rooms further up in the table of rooms, and public headers of these
//   include/trussmap  public headers and the libraries that users have to have
//   apps, bench       public headers, and the lists of what results consist of (src/results)
#include "policy/source_files.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::include_direction_test {
namespace {

namespace fs = std::filesystem;
using testing::source_files;
using testing::text_of;

/// From the foundations up; a room includes from itself and from those before it: the table of
/// docs/reading-the-code.md.
const std::vector<std::string>& rooms() {
  static const std::vector<std::string> all = [] {
    static const std::regex kRow(R"(\n\| `(\w+)` \|)");
    std::string text = text_of("docs/reading-the-code.md");
    text.erase(0, text.find("| room | subject |"));
    text.erase(text.find("\n\n"));
    std::vector<std::string> found;
    for (std::sregex_iterator row(text.begin(), text.end(), kRow), end; row != end; ++row) {
      found.push_back((*row)[1].str());
    }
    return found;
  }();
  return all;
}

/// Rooms that must not know of all before them. A simulator that shared the estimators' formulas
/// would prove nothing about them; the truss is structural mechanics and knows no robots.
const std::map<std::string, std::set<std::string>> kOnly = {
    {"simulation", {"geometry", "text", "statistics", "recording", "effects", "simulation"}},
    {"truss", {"geometry", "text", "linalg", "truss"}},
    {"store", {"geometry", "text", "files", "linalg", "truss", "map", "store"}},
    {"linalg", {"parallel", "geometry", "linalg"}},
};

/// The room that each public header belongs to.
const std::map<std::string, std::string> kDoors = {{"running", "parallel"},
                                                   {"error", "geometry"},
                                                   {"gate", "geometry"},
                                                   {"planar", "geometry"},
                                                   {"recording", "recording"},
                                                   {"robot", "drive"},
                                                   {"test_path", "recording"},
                                                   {"catalogue", "effects"},
                                                   {"channel", "effects"},
                                                   {"model", "effects"},
                                                   {"shape", "effects"},
                                                   {"arc", "odometry"},
                                                   {"dead_reckoning", "odometry"},
                                                   {"truss", "truss"},
                                                   {"landmark_map", "map"},
                                                   {"map_builder", "map"},
                                                   {"map_store", "store"},
                                                   {"survey_comparison", "map"},
                                                   {"pose_graph", "pose_graph"},
                                                   {"corrected_odometry", "fit"},
                                                   {"fit_model", "fit"},
                                                   {"noise_fit", "fit"},
                                                   {"monitor", "monitor"},
                                                   {"build_map", "build_map"},
                                                   {"calibrate", "calibration"},
                                                   {"umbmark", "calibration"},
                                                   {"wheel_noise", "calibration"},
                                                   {"held_out", "validation"},
                                                   {"compare", "criticism"},
                                                   {"diagnose", "criticism"},
                                                   {"discover", "criticism"},
                                                   {"workbench", "workbench"},
                                                   {"evidence", "criticism"},
                                                   {"fleet", "fleet"},
                                                   {"wording", "wording"},
                                                   {"check", "check"},
                                                   {"session", "session"},
                                                   {"simulation", "simulation"},
                                                   {"simulated_recording", "simulation"},
                                                   {"tour_experiment", "experiment"},
                                                   {"pages", "report"},
                                                   {"texts", "report"},
                                                   {"table", "text"},
                                                   {"log_files", "logs"},
                                                   {"datasets", "datasets"},
                                                   {"map_files", "io"},
                                                   {"model_file", "io"},
                                                   {"recording_files", "io"},
                                                   {"write_files", "files"},
                                                   {"distributed", "distributed"}};

/// The umbrella includes all of them.
constexpr const char* kUmbrella = "trussmap";

/// Files outside of src/ that include private headers: benches that look into a fit. A file that
/// has come clean must be struck off.
const std::set<std::string> kNotYetClean = {
    "bench/bench_worlds.cpp",       "bench/bench_worlds.hpp",
    "bench/criticism_bench.cpp",    "bench/changing_bench.cpp",
    "bench/explanations_bench.cpp", "bench/criticism_parts.cpp",
    "bench/monitor_bench.cpp",      "bench/noise_bench.cpp",
    "bench/scale/ceres_rivals.cpp", "bench/scale/covariances_part.cpp",
    "bench/scale/grid_part.cpp",    "bench/scale/online_part.cpp",
    "bench/threads_bench.cpp",      "bench/truss_bench.cpp",
    "bench/places_bench.cpp"};

struct Include {
  int line = 0;
  std::string target;
  bool quoted = false;
};

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*(["<])([^">]+)[">])re");
  std::vector<Include> found;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::smatch match;
    if (!std::regex_search(line, match, kInclude)) continue;
    found.push_back({number, match[2].str(), match[1] == "\""});
  }
  return found;
}

bool is_room(const std::string& name) {
  return std::find(rooms().begin(), rooms().end(), name) != rooms().end();
}

/// "planar" of "trussmap/planar.hpp".
std::optional<std::string> door_of(const std::string& target) {
  const fs::path path = target;
  if (path.parent_path() != "trussmap" || path.extension() != ".hpp") return std::nullopt;
  return path.stem().string();
}

bool may_include(const std::string& room, const std::string& other) {
  if (const auto only = kOnly.find(room); only != kOnly.end()) return only->second.contains(other);
  return std::find(rooms().begin(), rooms().end(), other) <=
         std::find(rooms().begin(), rooms().end(), room);
}

/// The room that an include comes from, if it is ours.
std::optional<std::string> room_of(const std::string& target) {
  if (const auto door = door_of(target)) {
    const auto room = kDoors.find(*door);
    return room == kDoors.end() ? "no room" : room->second;
  }
  const std::string first = fs::path(target).begin()->string();
  return is_room(first) ? std::optional(first) : std::nullopt;
}

/// What is wrong with a source of a room, a line each.
std::vector<std::string> wrong_in_room(const fs::path& file, const std::string& text) {
  const std::string room = std::next(file.begin())->string();
  if (!is_room(room)) return {file.string() + ": there is no room " + room};
  std::vector<std::string> wrong;
  for (const Include& one : includes_of(text)) {
    // <map> is the standard library's.
    const bool ours = one.quoted || one.target.find('/') != std::string::npos;
    const std::optional<std::string> other = ours ? room_of(one.target) : std::nullopt;
    if (one.quoted && !other) {
      wrong.push_back(file.string() + ":" + std::to_string(one.line) + ": " + one.target +
                      " is in no room, expected ROOM/name.hpp or trussmap/name.hpp");
    } else if (other && !may_include(room, *other)) {
      wrong.push_back(file.string() + ":" + std::to_string(one.line) + ": " + room +
                      " must not include " + one.target + " (" + *other + ")");
    }
  }
  return wrong;
}

/// What is wrong with a public header, a line each.
std::vector<std::string> wrong_in_door(const fs::path& file, const std::string& text) {
  // Users have Eigen; all else is used in the sources alone.
  static const std::regex kLibrary(R"(^(Eigen/\w+|[a-z0-9_]+)$)");
  const std::string name = file.stem().string();
  const auto room = kDoors.find(name);
  if (name != kUmbrella && room == kDoors.end()) {
    return {file.string() + ": say in kDoors which room it belongs to"};
  }
  std::vector<std::string> wrong;
  for (const Include& one : includes_of(text)) {
    const std::optional<std::string> door = door_of(one.target);
    const bool ours = door && (name == kUmbrella || (kDoors.contains(*door) &&
                                                     may_include(room->second, kDoors.at(*door))));
    const bool library = !one.quoted && std::regex_match(one.target, kLibrary);
    if (!ours && !library) {
      wrong.push_back(file.string() + ":" + std::to_string(one.line) +
                      ": a public header must not include " + one.target);
    }
  }
  return wrong;
}

/// The room that is open: lists for applications, of which the library itself knows nothing.
constexpr const char* kOpenRoom = "results";

/// Private headers that a file outside of src/ includes.
std::vector<std::string> private_in(const std::string& text) {
  std::vector<std::string> found;
  for (const Include& one : includes_of(text)) {
    const fs::path path = one.target;
    const std::string room = path.begin()->string();
    if (std::distance(path.begin(), path.end()) > 1 && is_room(room) && room != kOpenRoom) {
      found.push_back(one.target);
    }
  }
  return found;
}

TEST(IncludeDirection, RoomsIncludeOneWay) {
  int read = 0;
  for (const fs::path& file : source_files({"src"}, {".hpp", ".cpp"})) {
    for (const std::string& complaint : wrong_in_room(file, text_of(file))) {
      ADD_FAILURE() << complaint;
    }
    ++read;
  }
  EXPECT_GT(read, 20);
}

TEST(IncludeDirection, PublicHeadersIncludePublicHeadersAlone) {
  for (const fs::path& file : source_files({"include"}, {".hpp"})) {
    for (const std::string& complaint : wrong_in_door(file, text_of(file))) {
      ADD_FAILURE() << complaint;
    }
  }
}

TEST(IncludeDirection, ThereAreAtMostFiftyPublicHeadersBesideTheUmbrella) {
  EXPECT_LE(source_files({"include"}).size(), 50U + 1U);
}

TEST(IncludeDirection, ApplicationsUsePublicHeadersAlone) {
  for (const fs::path& file : source_files({"apps", "bench", "tests/install"}, {".hpp", ".cpp"})) {
    const std::vector<std::string> found = private_in(text_of(file));
    if (kNotYetClean.contains(file.string())) {
      EXPECT_FALSE(found.empty()) << file << " has come clean: strike it off kNotYetClean";
    } else {
      EXPECT_TRUE(found.empty()) << file << " includes " << found.front();
    }
  }
  for (const std::string& file : kNotYetClean) {
    EXPECT_TRUE(fs::exists(fs::path(TRUSSMAP_SOURCE_DIR) / file)) << file << " is gone";
  }
}

/// The sources that a room's CMakeLists.txt gives to the target trussmap_map.
std::vector<std::string> map_library_sources() {
  static const std::regex kSources(R"(target_sources\(trussmap_map PRIVATE([^)]*)\))");
  std::vector<std::string> found;
  for (const std::string& room : rooms()) {
    const fs::path list = fs::path("src") / room / "CMakeLists.txt";
    if (!fs::exists(fs::path(TRUSSMAP_SOURCE_DIR) / list)) continue;
    const std::string text = text_of(list);
    for (auto at = std::sregex_iterator(text.begin(), text.end(), kSources);
         at != std::sregex_iterator(); ++at) {
      std::istringstream names((*at)[1].str());
      for (std::string name; names >> name;) found.push_back("src/" + room + "/" + name);
    }
  }
  return found;
}

/// A file of ours and all that it includes of ours.
void collect(const std::string& file, std::set<std::string>& found) {
  if (!found.insert(file).second) return;
  for (const Include& one : includes_of(text_of(file))) {
    if (door_of(one.target)) collect("include/" + one.target, found);
    if (one.quoted && !door_of(one.target)) collect("src/" + one.target, found);
  }
}

/// trussmap_map is for exploration code, which reads no files.
TEST(IncludeDirection, TheMapLibraryNeedsNoFileFormats) {
  static const std::regex kForbidden(R"(^(fmt/|nlohmann/|toml\+\+|muParser|lzma|expat))");
  const std::vector<std::string> sources = map_library_sources();
  EXPECT_GT(sources.size(), 30U);
  std::set<std::string> files;
  for (const std::string& source : sources) collect(source, files);
  for (const std::string& file : files) {
    for (const Include& one : includes_of(text_of(file))) {
      EXPECT_FALSE(std::regex_search(one.target, kForbidden))
          << file << ":" << one.line << ": includes " << one.target;
    }
  }
}

TEST(IncludeDirection, WrongWaysAreFound) {
  const auto wrong = [](const char* file, const char* include) {
    return wrong_in_room(file, std::string("#include ") + include + "\n").size() == 1;
  };
  EXPECT_TRUE(wrong("src/geometry/x.cpp", "\"trussmap/truss.hpp\""));
  EXPECT_TRUE(wrong("src/linalg/x.hpp", "<trussmap/arc.hpp>"));
  EXPECT_TRUE(wrong("src/map/x.cpp", "\"estimation/recording_problem.hpp\""));
  EXPECT_TRUE(wrong("src/truss/x.cpp", "\"trussmap/recording.hpp\""));
  EXPECT_TRUE(wrong("src/simulation/x.cpp", "\"trussmap/arc.hpp\""));
  EXPECT_TRUE(wrong("src/datasets/x.cpp", "\"number_rows.hpp\""));
  EXPECT_TRUE(wrong("src/map/x.cpp", "\"trussmap/nowhere.hpp\""));
  EXPECT_TRUE(wrong("src/nowhere/x.cpp", "\"trussmap/planar.hpp\""));
  EXPECT_FALSE(wrong("src/map/x.cpp", "\"trussmap/truss.hpp\""));
  EXPECT_FALSE(wrong("src/map/x.cpp", "\"truss/measured_truss.hpp\""));
  EXPECT_FALSE(wrong("src/map/x.cpp", "<fmt/format.h>"));

  const auto wrong_door = [](const char* include) {
    return wrong_in_door("include/trussmap/truss.hpp", std::string("#include ") + include + "\n")
               .size() == 1;
  };
  EXPECT_TRUE(wrong_door("\"linalg/sparse_cholesky.hpp\""));
  EXPECT_TRUE(wrong_door("\"trussmap/map_builder.hpp\""));
  EXPECT_TRUE(wrong_door("<cholmod.h>"));
  EXPECT_TRUE(wrong_door("<fmt/format.h>"));
  EXPECT_FALSE(wrong_door("<Eigen/Core>"));
  EXPECT_FALSE(wrong_door("\"trussmap/planar.hpp\""));
  EXPECT_EQ(wrong_in_door("include/trussmap/nowhere.hpp", "").size(), 1U);

  EXPECT_EQ(private_in("#include \"map/route.hpp\"\n#include \"trussmap/planar.hpp\"\n").size(),
            1U);
  EXPECT_TRUE(private_in("#include \"commands.hpp\"\n#include <map>\n").empty());
}

}  // namespace
}  // namespace trussmap::include_direction_test
