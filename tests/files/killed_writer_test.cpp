// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A writer that is killed: files and folders are old or new, and the next run leaves nothing
// behind. TRUSSMAP_KILLS is how often it is killed at random (100 where it is not set).
#include "child_process.hpp"
#include "command_path.hpp"
#include "scratch_folder.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <functional>
#include <iostream>
#include <map>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <sys/ptrace.h>
#include <thread>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::killed_writer_test {
namespace {

namespace fs = std::filesystem;
using testing::ScratchFolder;
using testing::send_signal;
using testing::wait_for;
using Contents = std::map<std::string, std::string>;

/// Runs `work` in a process of its own, which ends with it.
pid_t begin_child(const std::function<void()>& work) {
  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error(std::string("no process: ") + std::strerror(errno));
  if (child > 0) return child;
  try {
    work();
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

/// A tracer's requests.
bool traced_on(pid_t child) {
  return ::ptrace(PTRACE_SYSCALL, child, nullptr, nullptr) == 0;
}

/// As the command does.
void end_by(int signal) {
  discard_temporaries();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// Runs `work` up to its `stops`-th entry into or return from the system, and sends it a signal
/// there. True if it had ended by itself before; nothing where the system lets nobody trace.
std::optional<bool> ended_at(int stops, int signal, const std::function<void()>& work) {
  const pid_t child = begin_child([&work] {
    std::signal(SIGINT, end_by);
    if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(77);
    ::raise(SIGSTOP);
    work();
  });
  int status = wait_for(child);
  if (WIFEXITED(status)) return std::nullopt;
  for (int k = 0; k < stops; ++k) {
    if (!traced_on(child)) break;
    status = wait_for(child);
    if (WIFEXITED(status)) return true;
  }
  send_signal(child, signal);
  ::ptrace(PTRACE_DETACH, child, nullptr, nullptr);
  static_cast<void>(wait_for(child));
  return false;
}

std::optional<bool> killed_at(int stops, const std::function<void()>& work) {
  return ended_at(stops, SIGKILL, work);
}

struct Seen {
  int kills = 0;
  int old_ones = 0;
  int new_ones = 0;
  int with_leftovers = 0;
};

/// Everything but temporaries, which only kills may leave.
Contents without_temporaries(const Contents& all, bool* any = nullptr) {
  Contents rest;
  for (const auto& [name, content] : all) {
    const bool temporary = name.find(".trussmap-part") != std::string::npos;
    if (temporary && any != nullptr) *any = true;
    if (!temporary) rest[name] = content;
  }
  return rest;
}

/// Kills `work` at every step of its, or every so many, from the same start each time.
Seen killed_at_every_step(const ScratchFolder& scratch, const std::function<void()>& prepare,
                          const std::function<void()>& work, int stride = 1) {
  Seen seen;
  prepare();
  const Contents before = scratch.contents();
  work();
  const Contents after = scratch.contents();
  EXPECT_NE(before, after);
  EXPECT_EQ(without_temporaries(after), after);
  for (int stops = 1; stops < 10000; stops += stride) {
    for (const auto& entry : fs::directory_iterator(scratch.path())) fs::remove_all(entry);
    prepare();
    const std::optional<bool> ended = killed_at(stops, work);
    if (!ended) return {};
    if (*ended) break;
    bool leftovers = false;
    const Contents now = without_temporaries(scratch.contents(), &leftovers);
    ++seen.kills;
    seen.old_ones += now == before ? 1 : 0;
    seen.new_ones += now == after ? 1 : 0;
    seen.with_leftovers += leftovers ? 1 : 0;
    EXPECT_TRUE(now == before || now == after) << "killed at step " << stops;
    work();
    EXPECT_EQ(scratch.contents(), after) << "killed at step " << stops;
    for (const auto& entry : fs::directory_iterator(scratch.path())) {
      EXPECT_FALSE(entry.path().filename().string().ends_with(".trussmap-part")) << entry;
    }
  }
  return seen;
}

/// Whether two folders can change their names in one step there.
bool can_exchange(const ScratchFolder& scratch) {
  const fs::path a = scratch.path() / "a";
  const fs::path b = scratch.path() / "b";
  fs::create_directory(a);
  fs::create_directory(b);
  const bool can = ::renameat2(AT_FDCWD, a.c_str(), AT_FDCWD, b.c_str(), RENAME_EXCHANGE) == 0;
  fs::remove(a);
  fs::remove(b);
  return can;
}

#define TRUSSMAP_NEEDS_TRACE(seen) \
  if ((seen).kills == 0) GTEST_SKIP() << "needs a system that lets a process trace its child"

FolderOfFiles some_folder(const fs::path& folder, const std::string& version) {
  return {folder,
          {{"drive.csv", "drive " + version}, {"survey.csv", "survey " + version}},
          {"truth.csv"}};
}

TEST(KilledWriter, LeavesAFileOldOrNew) {
  const ScratchFolder scratch;
  const fs::path file = scratch.path() / "map";
  const Seen seen = killed_at_every_step(
      scratch, [&] { write_file(file, "old"); }, [&] { write_file(file, "new"); });
  TRUSSMAP_NEEDS_TRACE(seen);
  EXPECT_GT(seen.old_ones, 10);
  EXPECT_GT(seen.new_ones, 0);
  EXPECT_GT(seen.with_leftovers, 0);
}

TEST(SlowKilledWriter, LeavesNoFolderOrAWholeOne) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "r";
  const Seen seen = killed_at_every_step(
      scratch, [] {}, [&] { write_files({}, {some_folder(folder, "new")}); });
  TRUSSMAP_NEEDS_TRACE(seen);
  EXPECT_GT(seen.old_ones, 10);
  EXPECT_GT(seen.new_ones, 0);
}

void expect_used_folder_old_or_new(int stride) {
  const ScratchFolder scratch;
  if (!can_exchange(scratch)) GTEST_SKIP() << "needs a file system that exchanges names";
  const fs::path folder = scratch.path() / "r";
  const auto prepare = [&] {
    write_files({}, {some_folder(folder, "old")});
    scratch.write("r/truth.csv", "old truth");
    scratch.write("r/notes.txt", "mine");
  };
  const Seen seen = killed_at_every_step(
      scratch, prepare, [&] { write_files({}, {some_folder(folder, "new")}); }, stride);
  TRUSSMAP_NEEDS_TRACE(seen);
  EXPECT_GT(seen.old_ones, 3);
  EXPECT_GT(seen.new_ones, 0);
  EXPECT_EQ(scratch.contents().at("r/notes.txt"), "mine");
}

TEST(KilledWriter, LeavesAUsedFolderOldOrNew) {
  expect_used_folder_old_or_new(9);
}

TEST(SlowKilledWriter, LeavesAUsedFolderOldOrNewAtEveryStep) {
  expect_used_folder_old_or_new(1);
}

/// A folder that stays the one that it is cannot be old or new as a whole; but it is never taken
/// for a recording while it is neither.
TEST(SlowKilledWriter, LeavesNoMixtureThatReadsLikeARecording) {
  const ScratchFolder scratch;
  const fs::path folder = scratch.path() / "r";
  for (int stops = 1; stops < 10000; ++stops) {
    write_files({}, {some_folder(folder, "old")});
    scratch.write("r/sub/notes.txt", "a folder in it keeps it from being exchanged");
    const std::optional<bool> ended =
        killed_at(stops, [&] { write_files({}, {some_folder(folder, "new")}); });
    if (!ended) GTEST_SKIP() << "needs a system that lets a process trace its child";
    if (*ended) break;
    const Contents now = scratch.contents();
    const auto drive = now.find("r/drive.csv");
    if (drive == now.end()) continue;
    EXPECT_EQ(drive->second.substr(6), now.at("r/survey.csv").substr(7)) << "at step " << stops;
  }
  write_files({}, {some_folder(folder, "last")});
  const Contents last = scratch.contents();
  EXPECT_EQ(without_temporaries(last), last);
  EXPECT_EQ(last.size(), 3U);
}

/// Ctrl-C leaves all that a call writes old, or all of it new, and nothing beside it.
TEST(SlowKilledWriter, InterruptedLeavesEverythingOldOrEverythingNew) {
  const ScratchFolder scratch;
  const bool exchange = can_exchange(scratch);
  const fs::path folder = scratch.path() / "r";
  const auto write = [&](const std::string& version) {
    std::vector<FolderOfFiles> folders;
    if (exchange) folders.push_back(some_folder(folder, version));
    write_files({{scratch.path() / "a", "a " + version}, {scratch.path() / "b", "b " + version}},
                folders);
  };
  write("new");
  const Contents after = scratch.contents();
  write("old");
  const Contents before = scratch.contents();
  int old_ones = 0;
  for (int stops = 1; stops < 10000; ++stops) {
    const std::optional<bool> ended = ended_at(stops, SIGINT, [&] { write("new"); });
    if (!ended) GTEST_SKIP() << "needs a system that lets a process trace its child";
    const Contents now = scratch.contents();
    EXPECT_TRUE(now == before || now == after) << "interrupted at step " << stops;
    for (const auto& entry : fs::directory_iterator(scratch.path())) {
      EXPECT_FALSE(entry.path().filename().string().ends_with(".trussmap-part")) << entry;
    }
    if (*ended) break;
    old_ones += now == before ? 1 : 0;
    write("old");
  }
  EXPECT_GT(old_ones, 10);
}

int wanted_kills() {
  constexpr int kUsual = 100;
  const char* text = std::getenv("TRUSSMAP_KILLS");
  return text == nullptr ? kUsual : std::atoi(text);
}

/// Content that shows its version in every line.
std::string content_of(int version) {
  std::string text;
  for (int k = 0; k < 5000; ++k) text += std::to_string(version) + "\n";
  return text;
}

/// The version of a content that is whole, -1 of any other.
int version_of(const std::string& content) {
  const int version = std::atoi(content.c_str());
  return content == content_of(version) ? version : -1;
}

void sleep_up_to(std::chrono::microseconds longest, std::mt19937& random) {
  std::uniform_int_distribution<long> span(0, static_cast<long>(longest.count()));
  std::this_thread::sleep_for(std::chrono::microseconds(span(random)));
}

/// Kills a child that writes one version after the other, at random, again and again. `versions`
/// are those of all files that belong together.
void kill_at_random(const ScratchFolder& scratch, const std::function<void(int)>& write,
                    const std::function<std::set<int>()>& versions) {
  std::mt19937 random(5);
  const int kills = wanted_kills();
  int leftovers = 0;
  int mixtures = 0;
  int last = 0;
  write(last);
  // A disk takes its time: as long as the slowest of some writes, and as long again.
  auto longest = std::chrono::microseconds(1000);
  for (int k = 0; k < 5; ++k) {
    const auto begun = std::chrono::steady_clock::now();
    write(last);
    longest = std::max(longest, std::chrono::duration_cast<std::chrono::microseconds>(
                                    std::chrono::steady_clock::now() - begun));
  }
  const std::size_t entries = scratch.contents().size();
  for (int k = 0; k < kills; ++k) {
    const pid_t child = begin_child([&] {
      for (int version = last + 1;; ++version) write(version);
    });
    sleep_up_to(2 * longest, random);
    send_signal(child, SIGKILL);
    static_cast<void>(wait_for(child));
    const std::set<int> found = versions();
    const bool whole = found.size() == 1 && *found.begin() >= last;
    EXPECT_TRUE(whole) << "kill " << k;
    mixtures += whole ? 0 : 1;
    bool any = false;
    static_cast<void>(without_temporaries(scratch.contents(), &any));
    leftovers += any ? 1 : 0;
    last = *found.rbegin();
  }
  write(last + 1);
  EXPECT_EQ(scratch.contents().size(), entries);
  EXPECT_EQ(versions(), std::set<int>{last + 1});
  std::cout << kills << " kills, " << last << " versions, " << mixtures << " mixtures, "
            << leftovers << " with leftovers\n";
}

TEST(SlowKilledWriter, LeavesAFileOldOrNewAtRandom) {
  const ScratchFolder scratch;
  const fs::path file = scratch.path() / "map";
  kill_at_random(
      scratch, [&](int version) { write_file(file, content_of(version)); },
      [&] { return std::set<int>{version_of(scratch.contents().at("map"))}; });
}

TEST(SlowKilledWriter, LeavesAFolderOldOrNewAtRandom) {
  const ScratchFolder scratch;
  if (!can_exchange(scratch)) GTEST_SKIP() << "needs a file system that exchanges names";
  const fs::path folder = scratch.path() / "r";
  fs::create_directory(folder);
  scratch.write("r/notes.txt", "mine");
  const std::array<std::string, 3> names = {"drive.csv", "sightings.csv", "model.toml"};
  kill_at_random(
      scratch,
      [&](int version) {
        FolderOfFiles whole{folder, {}, {"truth.csv"}};
        for (const std::string& name : names) {
          whole.files.emplace_back(name, content_of(version));
        }
        write_files({}, {whole});
      },
      [&] {
        const Contents all = scratch.contents();
        EXPECT_EQ(all.at("r/notes.txt"), "mine");
        std::set<int> found;
        for (const std::string& name : names) found.insert(version_of(all.at("r/" + name)));
        return found;
      });
}

/// The command itself, over its own earlier recording.
TEST(SlowKilledWriter, LeavesASimulatedRecordingOldOrNew) {
  const ScratchFolder scratch;
  if (!can_exchange(scratch)) GTEST_SKIP() << "needs a file system that exchanges names";
  const std::string arguments =
      "simulate --mesh 4x4 --tours 1 --out " + (scratch.path() / "r").string() + " --seed ";
  std::array<Contents, 2> recordings;
  auto taken = std::chrono::steady_clock::duration::zero();
  for (std::size_t seed = 0; seed < 2; ++seed) {
    const auto begun = std::chrono::steady_clock::now();
    ASSERT_EQ(testing::run_trussmap(arguments + std::to_string(seed)).status, 0);
    taken = std::chrono::steady_clock::now() - begun;
    recordings[seed] = scratch.contents();
  }
  ASSERT_NE(recordings[0], recordings[1]);
  std::mt19937 random(6);
  std::array<int, 2> found{};
  std::size_t there = 1;
  for (int k = 0; k < wanted_kills(); ++k) {
    const std::string line =
        "exec " + testing::command_path() + " " + arguments + std::to_string(1 - there);
    const pid_t child = begin_child([&line] {
      static_cast<void>(std::freopen("/dev/null", "w", stdout));
      ::execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
      ::_exit(127);
    });
    sleep_up_to(std::chrono::duration_cast<std::chrono::microseconds>(taken * 3 / 2), random);
    send_signal(child, SIGKILL);
    static_cast<void>(wait_for(child));
    const Contents now = without_temporaries(scratch.contents());
    ASSERT_TRUE(now == recordings[0] || now == recordings[1]) << "kill " << k;
    const std::size_t which = now == recordings[0] ? 0 : 1;
    ++found[which == there ? 0 : 1];
    there = which;
  }
  ASSERT_EQ(testing::run_trussmap(arguments + "0").status, 0);
  EXPECT_EQ(scratch.contents(), recordings[0]);
  std::cout << wanted_kills() << " kills, " << found[0] << " old, " << found[1] << " new\n";
}

}  // namespace
}  // namespace trussmap::killed_writer_test
