// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a terminal shows that a file or a pipe does not: progress and colour. And what Ctrl-C
// leaves.
#include "terminal.hpp"

#include "child_process.hpp"
#include "command_path.hpp"
#include "progress.hpp"
#include "scratch_folder.hpp"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <pty.h>
#include <stdexcept>
#include <string>
#include <sys/stat.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

namespace trussmap::terminal_test {
namespace {

namespace fs = std::filesystem;
using app::ProgressClock;
using testing::run_trussmap;
using testing::ScratchFolder;

const std::string kMaps = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/";
const std::string kSquares = "umbmark " + kMaps + "square_runs.csv --side 4 --wheelbase 0.34";

/// Why this machine has no pseudo-terminal (/dev/pts not mounted, as in a bare chroot); empty if
/// it has one.
std::string no_terminal() {
  int ends[2] = {-1, -1};
  if (::openpty(&ends[0], &ends[1], nullptr, nullptr, nullptr) != 0) return std::strerror(errno);
  for (const int end : ends) ::close(end);
  return {};
}

#define TRUSSMAP_NEEDS_TERMINAL()                                       \
  if (const std::string why = no_terminal(); !why.empty()) {            \
    GTEST_SKIP() << "needs a pseudo-terminal (openpty: " << why << ")"; \
  }

/// The trussmap command in a process of its own. Throws std::runtime_error where the system starts
/// none.
class Running {
 public:
  explicit Running(const std::string& arguments, bool on_terminal = false,
                   const std::string& environment = "TERM=xterm") {
    const std::string line =
        "exec env -u NO_COLOR " + environment + " " + testing::command_path() + " " + arguments;
    pid_ = on_terminal ? ::forkpty(&terminal_, nullptr, nullptr, nullptr) : ::fork();
    if (pid_ < 0) throw std::runtime_error(std::string("no process: ") + std::strerror(errno));
    if (pid_ > 0) return;
    if (!on_terminal) static_cast<void>(std::freopen("/dev/null", "w", stdout));
    ::execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() {
    if (!ended_) end_by(SIGKILL);
    if (terminal_ >= 0) ::close(terminal_);
  }

  /// All that the terminal got.
  std::string output() {
    std::string text;
    std::array<char, 4096> buffer{};
    while (true) {
      const ssize_t count = ::read(terminal_, buffer.data(), buffer.size());
      if (count <= 0) break;
      text.append(buffer.data(), static_cast<std::size_t>(count));
    }
    return text;
  }

  /// The signal that it died of; 0 if it ended by itself.
  int end_by(int signal) {
    testing::send_signal(pid_, signal);
    const int status = testing::wait_for(pid_);
    ended_ = true;
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }

 private:
  pid_t pid_ = -1;
  int terminal_ = -1;
  bool ended_ = false;
};

std::string on_terminal(const std::string& arguments,
                        const std::string& environment = "TERM=xterm") {
  return Running(arguments, true, environment).output();
}

std::string recording(const ScratchFolder& scratch, const std::string& size) {
  const std::string folder = (scratch.path() / "rec").string();
  EXPECT_EQ(run_trussmap("simulate --mesh " + size +
                         " --tours 3 --seed 4 --effect \"hard "
                         "iron=0.06,-0.04\" --out " +
                         folder)
                .status,
            0);
  return folder + " --model " + folder + "/model.toml";
}

TEST(ProgressClock, SaysNothingOfTheEndBeforeItCan) {
  ProgressClock clock({{"fitting", 1.0}, {"looking", 3.0}});
  EXPECT_EQ(clock.line(0.5), "");
  clock.next(0.0);
  EXPECT_EQ(clock.left(2.0), std::nullopt);
  EXPECT_EQ(clock.line(2.0), "fitting (step 1 of 2), 2 s so far");
}

TEST(ProgressClock, TellsTheTimeLeftFromTheStepsBefore) {
  ProgressClock clock({{"fitting", 1.0}, {"looking", 3.0}, {"drawing", 1.0}});
  clock.next(0.0);
  clock.next(10.0);
  EXPECT_DOUBLE_EQ(*clock.left(10.0), 40.0);  // 3 x 10 s and 10 s
  EXPECT_DOUBLE_EQ(*clock.left(25.0), 25.0);
  EXPECT_EQ(clock.line(25.0), "looking (step 2 of 3), 25 s left");
  // A step that takes longer than usual never runs out of time, and the next ones are slower too.
  EXPECT_GT(*clock.left(100.0), 10.0);
  clock.next(50.0);
  EXPECT_DOUBLE_EQ(*clock.left(50.0), 12.5);
  clock.insert({{"looking again", 3.0}});
  EXPECT_DOUBLE_EQ(*clock.left(50.0), 50.0);
  clock.next(60.0);
  EXPECT_EQ(clock.line(60.0), "looking again (step 4 of 4), 36 s left");
}

TEST(ProgressClock, TellsTheTimeLeftFromPartsDone) {
  ProgressClock clock({{"seeds", 1.0}});
  clock.next(0.0);
  clock.report(12, 50);
  EXPECT_DOUBLE_EQ(*clock.left(6.0), 19.0);
  EXPECT_EQ(clock.line(6.0), "12 of 50 seeds, 19 s left");
  EXPECT_EQ(clock.line(1200.0), "12 of 50 seeds, 63 min left");
}

TEST(ProgressClock, FitsIntoALine) {
  ProgressClock clock({{"fitting", 1.0}});
  clock.next(0.0);
  clock.say("fitting \"" + std::string(200, 'x') + "\"");
  EXPECT_LE(clock.line(3.0).size(), 79U);
}

TEST(Terminal, ColoursTheVerdictsWordAlone) {
  EXPECT_EQ(verdict_text(Mood::bad, "misfit: all is off", TextStyle::plain), "misfit: all is off");
  const std::string text = verdict_text(Mood::bad, "misfit: all is off", TextStyle::coloured);
  EXPECT_NE(text.find("\033[31mmisfit\033[0m: all is off"), std::string::npos) << text;
  EXPECT_NE(verdict_text(Mood::good, "fine", TextStyle::coloured).find("\033[32mfine\033[0m"),
            std::string::npos);
  EXPECT_NE(warning_text("old", TextStyle::coloured).find("\033[33mwarning\033[0m: old\n"),
            std::string::npos);
}

TEST(Terminal, DimsTheHeadOfATableAlone) {
  const TextTable table{{Align::left}, {{"head"}, {"row"}}, true, 0};
  EXPECT_EQ(table_text(table, TextStyle::plain), format_table(table));
  EXPECT_EQ(table_text(table, TextStyle::coloured), "\033[2mhead\033[0m\n----\nrow\n");
}

TEST(ChildProcess, SignalsNoProcessWhoseIdIsNotPositive) {
  for (const pid_t nobody : {0, -1, -::getpid()}) {
    // Signal 0 would do nothing even if it were sent.
    EXPECT_THROW(testing::send_signal(nobody, 0), std::invalid_argument) << nobody;
    EXPECT_THROW(static_cast<void>(testing::wait_for(nobody)), std::invalid_argument) << nobody;
  }
}

TEST(TerminalCommand, IsColouredOnATerminalOnly) {
  TRUSSMAP_NEEDS_TERMINAL();
  EXPECT_NE(on_terminal(kSquares).find("\033[33mworth correcting\033[0m"), std::string::npos);
  for (const char* plain : {"TERM=xterm NO_COLOR=1", "TERM=dumb", "-u TERM"}) {
    const std::string text = on_terminal(kSquares, plain);
    EXPECT_EQ(text.rfind("worth correcting: ", 0), 0U) << plain << text;
    EXPECT_EQ(text.find('\033'), std::string::npos) << plain;
  }
  EXPECT_EQ(run_trussmap(kSquares).output.find('\033'), std::string::npos);
}

TEST(TerminalCommand, TellsHowFarItIs) {
  TRUSSMAP_NEEDS_TERMINAL();
  const ScratchFolder scratch;
  const std::string command = "discover " + recording(scratch, "4x4");
  const std::string seen = on_terminal(command);
  EXPECT_NE(seen.find("looking for what is missing"), std::string::npos) << seen;
  EXPECT_NE(seen.find(" s left"), std::string::npos) << seen;
  // Gone in the end, before the verdict.
  const std::size_t last = seen.rfind("\r\033[K");
  ASSERT_NE(last, std::string::npos);
  EXPECT_EQ(seen.find("step", last), std::string::npos) << seen.substr(last);
  EXPECT_GT(seen.find("consistent"), last);
  EXPECT_EQ(on_terminal(command, "TERM=dumb").find(" left"), std::string::npos);
  EXPECT_EQ(run_trussmap(command).output.find(" left"), std::string::npos);
}

TEST(TerminalCommand, InterruptedLeavesNothing) {
  const ScratchFolder scratch;
  const std::string input = recording(scratch, "6x6");
  const auto before = scratch.contents();
  const std::string folder = scratch.path().string();
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Running running("discover " + input + " --html " + folder + "/page.html --json " + folder +
                    "/a.json --out " + folder + "/m.toml");
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_EQ(running.end_by(signal), signal);
    EXPECT_EQ(scratch.contents(), before);
  }
}

TEST(TerminalCommand, InterruptedWhileItWritesLeavesNothing) {
  // The first file is a pipe that nobody reads: there the command waits, the page's temporary file
  // written already.
  const ScratchFolder scratch;
  const fs::path pipe = scratch.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  Running running(kSquares + " --out " + pipe.string() + " --html " +
                  (scratch.path() / "page.html").string());
  for (int tries = 0; tries < 600 && scratch.contents().empty(); ++tries) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  ASSERT_EQ(scratch.contents().size(), 1U);
  EXPECT_EQ(running.end_by(SIGINT), SIGINT);
  EXPECT_TRUE(scratch.contents().empty());
}

}  // namespace
}  // namespace trussmap::terminal_test
