// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A builder that was saved and loaded is the one that goes on: to the last bit, in all that can be
// asked of it and in all that it does. A file with a fault is refused, wherever the fault is.
#include "map/memory_file.hpp"

#include "geometry/index.hpp"
#include "map/builder_memory.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::memory_file_test {
using namespace map;
namespace {

namespace fs = std::filesystem;

std::string name(int k) {
  return k == 2 ? "a lamp, 50 % bright\n" : k == 3 ? "-" : "n" + std::to_string(k);
}

/// Calls of every kind, random and noisy, one landmark in 25 taken for another (seed).
class Robot {
 public:
  Robot(unsigned seed, bool motions, bool compass)
      : random_(seed), motions_(motions), compass_(compass) {
    std::uniform_real_distribution<double> place(0.0, 15.0);
    for (int k = 0; k < kLandmarks; ++k) truth_.emplace_back(place(random_), place(random_));
  }

  /// The next call, for as many builders as there are: what each said of it must be the same.
  void call(const std::vector<MapBuilder*>& builders) {
    if (calls_++ == 0) {
      for (MapBuilder* one : builders) one->start(name(0), {1.0, -2.0});
      return;
    }
    std::uniform_int_distribution<int> any(0, kLandmarks - 1);
    const bool aside = calls_ % 9 == 0;
    const bool wrong = !motions_ && calls_ % 25 == 0;
    const int next = any(random_);
    const int label = wrong ? any(random_) : next;
    const int stands = builders.front()->here();
    const std::string standing = builders.front()->map().landmark(stands).name;
    if (next == here_ || name(label) == standing) return;
    if (compass_ && calls_ % 3 == 0) {
      const double reading = heading_ + 0.02 * normal_(random_);
      for (MapBuilder* one : builders) one->compass(reading, 0.02);
    }
    std::vector<Arrival> said;
    if (motions_) {
      const Motion motion = motion_to(next);
      const LandmarkOffset seen{{0.3 * normal_(random_), 0.2}, 0.0004 * Matrix2::Identity()};
      for (MapBuilder* one : builders) {
        said.push_back(aside ? one->observe(name(label),
                                            LandmarkOffset{offset_to(next), seen.covariance_robot})
                             : one->arrive(name(label), shifted(motion, seen), seen));
      }
      if (!aside) {
        heading_ += motion.displacement.heading;
        seen_ = seen;
      }
    } else {
      const Traversal leg = leg_to(next);
      for (MapBuilder* one : builders) {
        said.push_back(aside ? one->observe(name(label), leg) : one->arrive(name(label), leg));
      }
    }
    if (!aside) here_ = next;
    for (const Arrival& one : said) {
      ASSERT_EQ(one.kind, said.front().kind) << calls_;
      ASSERT_EQ(one.landmark, said.front().landmark);
      ASSERT_EQ(one.route, said.front().route);
      ASSERT_EQ(one.landmarks_moved, said.front().landmarks_moved);
      ASSERT_EQ(one.largest_move, said.front().largest_move) << calls_;
      ASSERT_EQ(one.misfit, said.front().misfit);
      ASSERT_EQ(one.eta, said.front().eta);
      ASSERT_EQ(one.back, said.front().back);
    }
  }

 private:
  static constexpr int kLandmarks = 14;

  Traversal leg_to(int next) {
    const Matrix2 R = rotation(normal_(random_));
    const Matrix2 C = R * Vector2(0.04, 0.01).asDiagonal() * R.transpose();
    const Vector2 error = R * Vector2(0.2 * normal_(random_), 0.1 * normal_(random_));
    return {truth_[idx(next)] - truth_[idx(here_)] + error, C};
  }
  /// Straight to the landmark, turned at random in the end; the landmark is below the robot.
  Motion motion_to(int next) {
    Motion motion;
    const Vector2 way = rotation(-heading_) * Vector2(truth_[idx(next)] - truth_[idx(here_)]);
    motion.displacement = {way.x() + 0.1 * normal_(random_), way.y() + 0.1 * normal_(random_),
                           normal_(random_)};
    motion.covariance = Eigen::Vector3d(0.01, 0.01, 0.001).asDiagonal();
    motion.covariance(0, 2) = motion.covariance(2, 0) = 0.001;
    return motion;
  }
  /// The same motion of a robot that has landmarks beside it.
  [[nodiscard]] Motion shifted(const Motion& motion, const LandmarkOffset& seen) const {
    Motion result = motion;
    const Vector2 way = motion.displacement.position() + seen_.offset_robot -
                        rotation(motion.displacement.heading) * seen.offset_robot;
    result.displacement = {way.x(), way.y(), motion.displacement.heading};
    return result;
  }
  [[nodiscard]] Vector2 offset_to(int next) const {
    return seen_.offset_robot +
           rotation(-heading_) * Vector2(truth_[idx(next)] - truth_[idx(here_)]);
  }

  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  bool motions_;
  bool compass_;
  std::vector<Vector2> truth_;
  int calls_ = 0;
  int here_ = 0;
  double heading_ = 0.0;
  LandmarkOffset seen_;
};

/// All that is kept, as text: two builders that are the same have the same.
std::string all_of(const MapBuilder& builder) {
  return format_memory(BuilderAccess::settled_memory(builder), builder.options());
}

std::vector<MapBuilderOptions> many_options() {
  using Kind = RefinementScope::Kind;
  std::vector<MapBuilderOptions> result;
  for (const Method method : {Method::elastic, Method::elastic_printed, Method::gauss_markov}) {
    for (const Kind kind : {Kind::automatic, Kind::nearest, Kind::estimated}) {
      const bool pooled = kind == Kind::nearest;
      result.push_back({.method = method, .scope = {kind, 4, true}, .pooled = pooled});
    }
  }
  result.push_back({.scope = {Kind::nearest, 4, false}, .law = StiffnessLaw::variance});
  result.push_back({.refine = false, .gate = std::numeric_limits<double>::infinity()});
  return result;
}

class MemoryFileTest : public ::testing::Test {
 protected:
  testing::ScratchFolder scratch_;
  fs::path file_ = scratch_.path() / "builder.txt";
};

TEST_F(MemoryFileTest, ALoadedBuilderGoesOnAsTheSavedOneToTheLastBit) {
  unsigned seed = 1;
  int left_out = 0;
  int came_back = 0;
  for (const MapBuilderOptions& options : many_options()) {
    for (const bool motions : {false, true}) {
      for (const bool compass : {false, true}) {
        if (compass && !motions) continue;
        SCOPED_TRACE(name_of(options.method) + ", seed " + std::to_string(seed));
        MapBuilder saved(options);
        Robot robot(seed++, motions, compass);
        for (int k = 0; k < 150; ++k) robot.call({&saved});
        const std::string before = all_of(saved);
        saved.save(file_);
        EXPECT_EQ(read_file(file_), before);
        EXPECT_EQ(all_of(saved), before);
        MapBuilder loaded = MapBuilder::load(file_);
        ASSERT_EQ(all_of(loaded), before);
        const std::size_t out = saved.left_out().size();
        for (int k = 0; k < 300; ++k) {
          robot.call({&saved, &loaded});
          if (HasFatalFailure()) return;
          if (k % 60 == 59) {
            EXPECT_EQ(saved.relax(), loaded.relax());
          }
        }
        left_out += static_cast<int>(out);
        came_back += saved.left_out().size() < out ? 1 : 0;
        EXPECT_EQ(all_of(saved), all_of(loaded));
        EXPECT_EQ(saved.energy(), loaded.energy());
        EXPECT_EQ(saved.covariance_between(0, 5), loaded.covariance_between(0, 5));
        EXPECT_EQ(saved.pose().has_value(), loaded.pose().has_value());
      }
    }
  }
  EXPECT_GT(left_out, 10);
}

/// And as one that was never saved, but for the rounding of a factor that is made anew.
TEST_F(MemoryFileTest, SavingChangesNothingButRounding) {
  for (const bool motions : {false, true}) {
    MapBuilder saved;
    MapBuilder twin;
    Robot robot(77, motions, false);
    for (int k = 0; k < 40; ++k) robot.call({&saved, &twin});
    saved.save(file_);
    const LandmarkGraph map = saved.map();
    ASSERT_EQ(map.landmarks(), twin.landmarks());
    for (int k = 0; k < map.landmarks(); ++k) EXPECT_EQ(saved.position(k), twin.position(k));
    ASSERT_GT(saved.relax(), -1.0);
    static_cast<void>(twin.relax());
    for (int k = 0; k < map.landmarks(); ++k) {
      EXPECT_LE((saved.position(k) - twin.position(k)).norm(), 1e-6) << k;
    }
  }
}

TEST_F(MemoryFileTest, ABuilderThatHasNotBegunIsKeptToo) {
  MapBuilder(MapBuilderOptions{.method = Method::gauss_markov}).save(file_);
  MapBuilder loaded = MapBuilder::load(file_);
  EXPECT_EQ(loaded.options().method, Method::gauss_markov);
  EXPECT_EQ(loaded.here(), -1);
  loaded.start("dock");
  loaded.arrive("door", Traversal{{4.0, 0.3}, 0.01 * Matrix2::Identity()});
  EXPECT_EQ(loaded.landmarks(), 2);
}

MapBuilder with_all_tables() {
  MapBuilder builder;
  Robot reckoned(5, true, true);
  for (int k = 0; k < 25; ++k) reckoned.call({&builder});
  Robot walker(5, false, false);
  builder.start(name(0));
  const Traversal far{{90.0, 90.0}, 0.01 * Matrix2::Identity()};
  builder.arrive(builder.map().landmark(5).name, far);
  builder.arrive(builder.map().landmark(6).name,
                 Traversal{{-3.0, 0.0}, 0.01 * Matrix2::Identity()});
  return builder;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string joined_lines(const std::vector<std::string>& lines, std::size_t count) {
  std::string text;
  for (std::size_t k = 0; k < count; ++k) text += lines[k] + "\n";
  return text;
}

/// What is said of a text that is no builder's; empty where it is taken for one.
std::string refusal(const std::string& text) {
  try {
    const KeptMemory kept = parse_memory(text, "FILE");
    static_cast<void>(BuilderAccess::restored(kept.memory, kept.options));
    return "";
  } catch (const InputError& error) {
    EXPECT_GT(error.line(), 0U);
    return error.what();
  }
}

TEST(MemoryFile, IsRefusedWhereverItEndsTooSoon) {
  const std::string text = all_of(with_all_tables());
  ASSERT_EQ(refusal(text), "");
  for (std::size_t size = 0; size < text.size(); ++size) {
    const std::string said = refusal(text.substr(0, size));
    ASSERT_NE(said, "") << size;
    ASSERT_NE(said.find("expected"), std::string::npos) << said;
  }
  const std::vector<std::string> lines = lines_of(text);
  const std::string number = std::to_string(lines.size());
  EXPECT_EQ(refusal(joined_lines(lines, lines.size() - 1)),
            "FILE:" + number + ": ends here, expected \"end\" and the file's check sum");
}

/// A field that is another number is found by the sum at the end, if not before.
TEST(MemoryFile, IsRefusedWhereverAFieldIsAnother) {
  const std::string text = all_of(with_all_tables());
  const std::vector<std::string> lines = lines_of(text);
  const std::vector<std::string> junk{"",
                                      "x",
                                      "-",
                                      "nan",
                                      "inf",
                                      "-inf",
                                      "1e999",
                                      "-7",
                                      "0.5",
                                      "%4",
                                      "0",
                                      "1",
                                      "999999999999999999999",
                                      "2147483647",
                                      "-2147483648",
                                      "1 1",
                                      "\t",
                                      "1e-320",
                                      "%00"};
  int refused = 0;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    for (std::size_t begin = 0; begin <= lines[n].size();) {
      const std::size_t end = std::min(lines[n].find(' ', begin), lines[n].size());
      const std::string field = lines[n].substr(begin, end - begin);
      for (const std::string& other : junk) {
        if (other == field) continue;
        std::vector<std::string> changed = lines;
        changed[n].replace(begin, end - begin, other);
        ASSERT_NE(refusal(joined_lines(changed, changed.size())), "") << n << ": " << changed[n];
        ++refused;
      }
      begin = end + 1;
    }
  }
  EXPECT_GT(refused, 5000);
}

/// Whoever mends the sum, too, gets no further than a builder that can be asked and driven on.
TEST(MemoryFile, AFieldThatIsAnotherDoesNoHarmEvenWithItsSum) {
  const std::string text = all_of(with_all_tables());
  const std::vector<std::string> lines = lines_of(text);
  int taken = 0;
  for (std::size_t n = 1; n + 1 < lines.size(); ++n) {
    for (std::size_t begin = 0; begin <= lines[n].size();) {
      const std::size_t end = std::min(lines[n].find(' ', begin), lines[n].size());
      for (const char* other : {"-1", "0", "1", "3", "1e300", "-", "-1e-300"}) {
        std::vector<std::string> changed(lines.begin(), lines.end() - 1);
        changed[n].replace(begin, end - begin, other);
        std::string whole = joined_lines(changed, changed.size());
        const std::string said = refusal(whole + "end 0\n");
        const std::size_t at = said.find("expected \"end ");
        if (at == std::string::npos) continue;
        whole += said.substr(at + 10, 20) + "\n";
        try {
          const KeptMemory kept = parse_memory(whole, "FILE");
          MapBuilder builder = BuilderAccess::restored(kept.memory, kept.options);
          ++taken;
          for (const int to : {4, 7, 1}) {
            const Traversal leg{{1.0, 2.0}, 0.01 * Matrix2::Identity()};
            if (builder.find(name(to)) != builder.here()) builder.arrive(name(to), leg);
          }
          static_cast<void>(builder.covariances());
        } catch (const std::invalid_argument&) {
        } catch (const SolveError&) {
        } catch (const InputError&) {
        }
      }
      begin = end + 1;
    }
  }
  EXPECT_GT(taken, 100);
}

TEST(MemoryFile, SaysLineFieldAndWhatWasExpected) {
  const std::string text = all_of(with_all_tables());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string other = text;
    const std::size_t at = other.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    other.replace(at, from.size(), to);
    return refusal(other);
  };
  EXPECT_EQ(refusal("<graphml/>\n"),
            "FILE:1: is no map builder's file, expected \"trussmap map builder 1\"");
  EXPECT_EQ(with("builder 1", "builder 9"), "FILE:1: is of version 9, expected 1");
  EXPECT_EQ(with("elastic", "plastic"),
            "FILE:3: is damaged: it has a method that is unknown, expected one of elastic, "
            "elastic_printed, gauss_markov");
  EXPECT_EQ(with("0 n0 1 -2", "0 n0 1 -2,5"), "FILE:5: y is \"-2,5\", expected a number");
  EXPECT_EQ(with("0 n0 1 -2", "0 n0 1 nan"),
            "FILE:5: is damaged: it has a place that is no number, expected a finite one");
  EXPECT_EQ(with("0 n0 1 -2", "0 n0 1"), "FILE:5: has 4 fields, expected 5");
  EXPECT_NE(with("n0 1 -2", "n0 1 -3").find("what stands above was changed"), std::string::npos);
  EXPECT_NE(refusal(text + "\n").find("expected nothing behind it"), std::string::npos);
}

TEST_F(MemoryFileTest, AFailureLeavesFileAndBuilderAsTheyAre) {
  MapBuilder builder = with_all_tables();
  builder.save(file_);
  const std::string before = read_file(file_);
  EXPECT_THROW(builder.save(scratch_.path() / "missing" / "file"), InputError);
  EXPECT_THROW(builder.save(scratch_.path()), InputError);
  EXPECT_EQ(all_of(builder), before);
  EXPECT_EQ(read_file(file_), before);
  EXPECT_THROW(static_cast<void>(MapBuilder::load(scratch_.path())), InputError);
  EXPECT_THROW(static_cast<void>(MapBuilder::load(scratch_.path() / "other")), InputError);
  write_file(file_, "");
  EXPECT_THROW(static_cast<void>(MapBuilder::load(file_)), InputError);
}

}  // namespace
}  // namespace trussmap::memory_file_test
