// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Recordings out and in, and the CSV beneath.
#include "io/csv.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

namespace trussmap::recording_csv_test {
namespace {

using testing::ScratchFolder;

bool same(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

/// Numbers of many magnitudes, seed 7.
Recording random_recording() {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  Recording r;
  r.drive.covariates = {{"load", {}}, {"T_1", {}}};
  for (int k = 0; k < 200; ++k) {
    r.drive.t.push_back(1e9 + 0.1 * k);
    r.drive.left.push_back(normal(random) * std::pow(10.0, k % 14 - 8));
    r.drive.right.push_back(normal(random));
    r.drive.heading.push_back(k % 3 == 0 ? kAbsent : normal(random));
    r.drive.yaw_rate.push_back(k % 5 == 0 ? kAbsent : normal(random));
    r.drive.covariates[0].values.push_back(normal(random));
    r.drive.covariates[1].values.push_back(k);
  }
  r.sightings = {{1e9, "plain", kAbsent, kAbsent},       {1e9, "with, comma", 1.25, -0.5},
                 {1e9 + 3, "with \"quotes\"", 0.0, 3.0}, {1e9 + 4, "<script>", kAbsent, kAbsent},
                 {1e9 + 5, "#hash", kAbsent, kAbsent},   {1e9 + 6, "Tür 12 ✓", 7.5, 0.1}};
  r.survey = {{"plain", 0.1, -2.0, kAbsent}, {"with, comma", 1e-17, 1.0 / 3.0, 0.002}};
  r.truth = {{1e9, 0.0, 1.0, 2.0}, {1e9 + 1, 0.1, 0.2, -3.1}};
  return r;
}

TEST(RecordingCsv, FixesAndLoopsComeBackAndNeedNoSightings) {
  const ScratchFolder scratch;
  Recording out = random_recording();
  out.sightings.clear();
  out.truth.clear();
  out.fixes = {{1e9 - 5.0, 1.0 / 3.0, -2.0, 0.5, 4.0}, {1e9 + 0.25, 0.1, 1e-17, kAbsent, kAbsent}};
  out.loops = {{1e9 + 3.0, 1e9 + 0.1, 0.1, -0.2, 3.0, 0.02, kAbsent},
               {1e9 + 0.1, 1e9 + 5.0, 1.0, 2.0, -3.0, kAbsent, 0.001}};
  write_recording(scratch.path() / "r", out);
  const Recording in = read_recording(scratch.path() / "r");
  EXPECT_TRUE(in.sightings.empty());
  ASSERT_EQ(in.fixes.size(), 2U);
  ASSERT_EQ(in.loops.size(), 2U);
  for (std::size_t k = 0; k < 2; ++k) {
    const Fix& a = in.fixes[k];
    const Fix& b = out.fixes[k];
    EXPECT_TRUE(a.t == b.t && a.x == b.x && a.y == b.y);
    EXPECT_TRUE(same(a.sd, b.sd) && same(a.quality, b.quality));
    const Loop& c = in.loops[k];
    const Loop& d = out.loops[k];
    EXPECT_TRUE(c.t == d.t && c.t2 == d.t2 && c.dx == d.dx && c.dy == d.dy);
    EXPECT_TRUE(c.dtheta == d.dtheta && same(c.sd, d.sd) && same(c.sd_heading, d.sd_heading));
  }
  EXPECT_EQ(fingerprint(in), fingerprint(out));
  Recording other = in;
  other.loops[0].dx += 1e-12;
  EXPECT_NE(fingerprint(in), fingerprint(other));
  // An earlier recording's streams go with it.
  out.loops.clear();
  write_recording(scratch.path() / "r", out);
  EXPECT_TRUE(read_recording(scratch.path() / "r").loops.empty());
}

TEST(RecordingCsv, ReadsBackExactlyWhatItWrote) {
  const ScratchFolder scratch;
  const Recording out = random_recording();
  write_recording(scratch.path() / "r", out, "two lines\nof comment");
  const Recording in = read_recording(scratch.path() / "r");
  ASSERT_EQ(in.drive.rows(), out.drive.rows());
  EXPECT_EQ(in.drive.t, out.drive.t);
  EXPECT_EQ(in.drive.left, out.drive.left);
  EXPECT_EQ(in.drive.right, out.drive.right);
  for (std::size_t k = 0; k < in.drive.rows(); ++k) {
    EXPECT_TRUE(same(in.drive.heading[k], out.drive.heading[k]));
    EXPECT_TRUE(same(in.drive.yaw_rate[k], out.drive.yaw_rate[k]));
  }
  ASSERT_EQ(in.drive.covariates.size(), 2U);
  EXPECT_EQ(in.drive.covariates[1].name, "T_1");
  EXPECT_EQ(in.drive.covariates[0].values, out.drive.covariates[0].values);
  ASSERT_EQ(in.sightings.size(), out.sightings.size());
  for (std::size_t k = 0; k < in.sightings.size(); ++k) {
    EXPECT_EQ(in.sightings[k].landmark, out.sightings[k].landmark);
    EXPECT_TRUE(same(in.sightings[k].range, out.sightings[k].range));
    EXPECT_TRUE(same(in.sightings[k].bearing, out.sightings[k].bearing));
  }
  ASSERT_EQ(in.survey.size(), 2U);
  EXPECT_EQ(in.survey[1].y, 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(in.survey[0].sd));
  EXPECT_EQ(in.truth[1].heading, -3.1);
}

TEST(RecordingCsv, TakesWhatRfc4180Takes) {
  const ScratchFolder scratch;
  scratch.write(
      "r/drive.csv",
      "\xEF\xBB\xBF# a comment\r\n\"right\",\"t\",left\r\n\r\n\"1.5\",+0.1,-2e-3\r\n# more\r\n"
      "2,0.2,3");
  scratch.write("r/sightings.csv", "landmark,t\n\"A, \"\"B\"\"\",0.2\n\"two\nlines\",0.2\n");
  try {
    (void)read_recording(scratch.path() / "r");
    FAIL() << "a name of two lines was taken";
  } catch (const InputError& error) {
    EXPECT_EQ(error.line(), 3U);
  }
  scratch.write("r/sightings.csv", "landmark,t\n\"A, \"\"B\"\"\",0.2\n");
  const Recording in = read_recording(scratch.path() / "r");
  EXPECT_EQ(in.drive.left, (std::vector<double>{-2e-3, 3.0}));
  EXPECT_EQ(in.drive.right, (std::vector<double>{1.5, 2.0}));
  EXPECT_EQ(in.sightings[0].landmark, "A, \"B\"");
  EXPECT_FALSE(in.drive.has_compass());
}

TEST(RecordingCsv, ARecordingWithTruthNeedsNoSightings) {
  const ScratchFolder scratch;
  scratch.write("r/drive.csv", "t,left,right\n0.1,0,0\n0.2,0,0\n");
  scratch.write("r/truth.csv", "t,x,y,heading\n0.1,0,0,0\n");
  EXPECT_TRUE(read_recording(scratch.path() / "r").sightings.empty());
}

TEST(CsvNumber, ReadsBackToTheSameNumber) {
  std::mt19937_64 random(11);
  for (int k = 0; k < 1000; ++k) {
    double value = 0.0;
    const std::uint64_t bits = random();
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    EXPECT_EQ(std::stod(io::csv_number(value) == "-0" ? "-0.0" : io::csv_number(value)), value);
  }
}

TEST(AtomicFile, AFailedWriteLeavesEverythingAsItWas) {
  const ScratchFolder scratch;
  scratch.write("a", "old a");
  const auto before = scratch.contents();
  EXPECT_THROW(write_files({{scratch.path() / "a", "new a"},
                            {scratch.path() / "no" / "such" / "folder", "b"}}),
               InputError);
  EXPECT_EQ(scratch.contents(), before);
  write_files({{scratch.path() / "a", "new a"}, {scratch.path() / "b", "b"}});
  EXPECT_EQ(scratch.contents(), (std::map<std::string, std::string>{{"a", "new a"}, {"b", "b"}}));
}

TEST(AtomicFile, FollowsLinksWritesToDevicesAndRefusesFoldersAndTwins) {
  const ScratchFolder scratch;
  const auto file = scratch.write("file", "old");
  std::filesystem::create_directory(scratch.path() / "folder");
  std::filesystem::create_symlink("file", scratch.path() / "link");
  EXPECT_THROW(write_files({{file, "new"}, {scratch.path() / "folder", "x"}}), InputError);
  EXPECT_THROW(write_files({{file, "new"}, {scratch.path() / "link", "x"}}), InputError);
  EXPECT_EQ(scratch.contents().at("file"), "old");
  write_file(scratch.path() / "link", "through the link");
  EXPECT_TRUE(std::filesystem::is_symlink(scratch.path() / "link"));
  EXPECT_EQ(scratch.contents().at("file"), "through the link");
  write_file("/dev/null", "nobody reads this");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST(RecordingCsv, WritingIntoAUsedFolderLeavesNoStrangersStreams) {
  const ScratchFolder scratch;
  write_recording(scratch.path() / "r", random_recording());
  Recording bare = random_recording();
  bare.truth.clear();
  bare.survey.clear();
  write_recording(scratch.path() / "r", bare, "", {{"model.toml", "[robot]\n"}});
  const auto files = scratch.contents();
  EXPECT_EQ(files.count("r/truth.csv") + files.count("r/survey.csv"), 0U);
  EXPECT_EQ(files.at("r/model.toml"), "[robot]\n");
}

TEST(AtomicFile, RefusesWhatIsNoXzFile) {
  const ScratchFolder scratch;
  const auto file = scratch.write("x.xz", "this is not compressed");
  EXPECT_THROW((void)read_file(file), InputError);
  EXPECT_THROW((void)read_file(scratch.path()), InputError);
  EXPECT_THROW((void)read_file(scratch.path() / "absent"), InputError);
}

}  // namespace
}  // namespace trussmap::recording_csv_test
