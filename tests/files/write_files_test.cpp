// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Files and folders that appear whole: what is left, what stays, and whose temporaries go.
#include "trussmap/write_files.hpp"

#include "scratch_folder.hpp"
#include "trussmap/error.hpp"

#include <fcntl.h>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <gtest/gtest.h>

namespace trussmap::write_files_test {
namespace {

namespace fs = std::filesystem;
using testing::run_trussmap;
using testing::ScratchFolder;
using Contents = std::map<std::string, std::string>;

const std::string kLeft = ".map.abcdefghijkl.trussmap-part";

ino_t inode(const fs::path& path) {
  struct stat found {};
  EXPECT_EQ(::lstat(path.c_str(), &found), 0) << path;
  return found.st_ino;
}

FolderOfFiles two_files(const fs::path& folder) {
  return {folder, {{"drive.csv", "new drive"}, {"model.toml", "new model"}}, {"truth.csv"}};
}

TEST(WriteFiles, RemovesWhatAKilledRunLeft) {
  const ScratchFolder scratch;
  scratch.write(kLeft, "half");
  scratch.write(".r.234567abcdef.trussmap-part/drive.csv", "half");
  write_file(scratch.path() / "other", "whole");
  EXPECT_EQ(scratch.contents(), (Contents{{"other", "whole"}}));
  EXPECT_FALSE(fs::exists(scratch.path() / ".r.234567abcdef.trussmap-part"));
}

TEST(WriteFiles, LeavesTheTemporariesOfARunThatLives) {
  const ScratchFolder scratch;
  const fs::path held = scratch.write(kLeft, "half");
  const int lock = ::open(held.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_EQ(::flock(lock, LOCK_EX | LOCK_NB), 0);
  write_file(scratch.path() / "map", "whole");
  EXPECT_EQ(scratch.contents(), (Contents{{kLeft, "half"}, {"map", "whole"}}));
  ::close(lock);
  write_file(scratch.path() / "map", "again");
  EXPECT_EQ(scratch.contents(), (Contents{{"map", "again"}}));
}

TEST(WriteFiles, LeavesWhatOnlyLooksLikeATemporary) {
  const ScratchFolder scratch;
  const Contents mine = {{"mine", "1"},
                         {"map.abcdefghijkl.trussmap-part", "2"},
                         {".map.abcdefghijk.trussmap-part", "3"},
                         {".map.ABCDEFGHIJKL.trussmap-part", "4"},
                         {".map.abcdefghijkl.trussmap-part.txt", "5"},
                         {"map.part1", "6"}};
  for (const auto& [name, content] : mine) scratch.write(name, content);
  const fs::path link = scratch.path() / kLeft;
  fs::create_symlink("mine", link);
  const fs::path with_folder = scratch.path() / ".r.234567abcdef.trussmap-part";
  fs::create_directories(with_folder / "sub");
  write_file(scratch.path() / "map", "whole");
  Contents expected = mine;
  expected["map"] = "whole";
  EXPECT_EQ(scratch.contents(), expected);
  EXPECT_TRUE(fs::is_symlink(link));
  EXPECT_TRUE(fs::exists(with_folder / "sub"));
}

TEST(WriteFiles, TakesTheLongestNameThereIs) {
  const ScratchFolder scratch;
  const std::string name(255, 'n');
  write_file(scratch.path() / name, "x");
  std::string umlauts;
  for (int k = 0; k < 127; ++k) umlauts += "\u00e4";
  write_file(scratch.path() / umlauts, "y");
  EXPECT_EQ(scratch.contents(), (Contents{{name, "x"}, {umlauts, "y"}}));
}

TEST(WriteFiles, GivesFilesAndFoldersTheRightsOfNewOnes) {
  const ScratchFolder scratch;
  const mode_t before = ::umask(027);
  write_file(scratch.path() / "file", "x");
  write_files({}, {two_files(scratch.path() / "folder")});
  ::umask(before);
  EXPECT_EQ(fs::status(scratch.path() / "file").permissions(), fs::perms(0640));
  EXPECT_EQ(fs::status(scratch.path() / "folder").permissions(), fs::perms(0750));
  EXPECT_EQ(fs::status(scratch.path() / "folder" / "drive.csv").permissions(), fs::perms(0640));
}

TEST(WriteFiles, AUsedFolderKeepsItsRightsAndTheFilesOfOthers) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "r";
  const fs::path notes = scratch.write("r/notes.txt", "mine");
  scratch.write("r/drive.csv", "old drive");
  scratch.write("r/truth.csv", "old truth");
  fs::create_symlink("nowhere", folder / "dangling");
  fs::permissions(folder, fs::perms(0710));
  const ino_t same = inode(notes);
  write_files({}, {two_files(folder)});
  EXPECT_EQ(scratch.contents(), (Contents{{"r/drive.csv", "new drive"},
                                          {"r/model.toml", "new model"},
                                          {"r/notes.txt", "mine"}}));
  EXPECT_EQ(inode(notes), same);
  EXPECT_EQ(fs::read_symlink(folder / "dangling"), "nowhere");
  EXPECT_EQ(fs::status(folder).permissions(), fs::perms(0710));
}

TEST(WriteFiles, AFolderStaysWhereSomebodyStandsInItOrItHasFolders) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "r";
  scratch.write("r/sub/notes.txt", "mine");
  scratch.write("r/truth.csv", "old truth");
  const ino_t same = inode(folder);
  write_files({}, {two_files(folder)});
  EXPECT_EQ(inode(folder), same);
  EXPECT_EQ(scratch.contents(), (Contents{{"r/drive.csv", "new drive"},
                                          {"r/model.toml", "new model"},
                                          {"r/sub/notes.txt", "mine"}}));
  fs::create_directory(scratch.path() / "here");
  const ino_t here = inode(scratch.path() / "here");
  const fs::path before = fs::current_path();
  fs::current_path(scratch.path() / "here");
  write_files({}, {two_files(".")});
  fs::current_path(before);
  EXPECT_EQ(inode(scratch.path() / "here"), here);
  EXPECT_EQ(scratch.contents().at("here/drive.csv"), "new drive");
}

TEST(WriteFiles, LinksAreFollowedInFoldersAndToFolders) {
  const ScratchFolder scratch;
  scratch.write("elsewhere", "old drive");
  fs::create_directory(scratch.path() / "r");
  fs::create_symlink("../elsewhere", scratch.path() / "r" / "drive.csv");
  fs::create_directory_symlink("r", scratch.path() / "link");
  write_files({}, {two_files(scratch.path() / "link/")});
  EXPECT_TRUE(fs::is_symlink(scratch.path() / "link"));
  EXPECT_TRUE(fs::is_symlink(scratch.path() / "r" / "drive.csv"));
  EXPECT_EQ(scratch.contents().at("elsewhere"), "new drive");
}

TEST(WriteFiles, FilesMayGoIntoAFolderOfTheSameCall) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "a" / "r";
  write_files({{folder / "summary.json", "{}"}}, {two_files(folder)});
  EXPECT_EQ(scratch.contents(), (Contents{{"a/r/drive.csv", "new drive"},
                                          {"a/r/model.toml", "new model"},
                                          {"a/r/summary.json", "{}"}}));
  EXPECT_THROW(write_files({{folder / "drive.csv", "{}"}}, {two_files(folder)}), InputError);
}

TEST(WriteFiles, AFailedWriteLeavesNoFolder) {
  const ScratchFolder scratch;
  scratch.write("file", "x");
  const Contents before = scratch.contents();
  const fs::path folder = scratch.path() / "a" / "r";
  EXPECT_THROW(write_files({{scratch.path() / "no" / "map", ""}}, {two_files(folder)}), InputError);
  EXPECT_FALSE(fs::exists(scratch.path() / "a"));
  EXPECT_THROW(write_files({}, {two_files(scratch.path() / "file")}), InputError);
  EXPECT_THROW(write_files({}, {two_files(scratch.path() / "file" / "r")}), InputError);
  EXPECT_THROW(write_files({}, {two_files("")}), InputError);
  EXPECT_THROW(write_files({}, {{folder, {{"../x", ""}}, {}}}), std::invalid_argument);
  EXPECT_EQ(scratch.contents(), before);
  EXPECT_FALSE(fs::exists(scratch.path() / "a"));
}

TEST(WriteFiles, NobodyCanLayALinkInTheWay) {
  const ScratchFolder scratch;
  scratch.write("secret", "mine");
  fs::create_symlink("secret", scratch.path() / ("map.part" + std::to_string(::getpid())));
  write_file(scratch.path() / "map", "new");
  EXPECT_EQ(scratch.contents().at("secret"), "mine");
}

TEST(WriteFiles, ASimulatedRecordingAndItsSummaryComeTogether) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "r";
  const auto ran = run_trussmap("simulate --mesh 2x2 --tours 1 --seed 1 --out " + folder.string() +
                                " --json " + (scratch.path() / "no" / "s.json").string());
  EXPECT_EQ(ran.status, 2) << ran.output;
  EXPECT_TRUE(scratch.contents().empty());
  EXPECT_FALSE(fs::exists(folder));
}

}  // namespace
}  // namespace trussmap::write_files_test
