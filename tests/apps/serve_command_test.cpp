// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "apps/served_bench.hpp"
#include "command_path.hpp"
#include "formula_limits.hpp"
#include "scratch_folder.hpp"
#include "trussmap/model_file.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::serve_command_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HttpAnswer;
using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;
using testing::sent_to;
using testing::ServedBench;

const std::string kRiddle = std::string(TRUSSMAP_SOURCE_DIR) + "/maps/riddle";

std::vector<std::string> riddle(const ScratchFolder& scratch) {
  return {kRiddle, "--model", kRiddle + "/model.toml", "--work",
          (scratch.path() / "work").string()};
}

std::size_t finding_named(const json& state, const std::string& id) {
  for (const json& card : state.at("cards")) {
    if (card.at("id") == id) return card.at("finding").get<std::size_t>();
  }
  throw std::runtime_error("no card " + id);
}

TEST(ServeCommand, FromMisfitToModelByRequests) {
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  const json first = bench.settled();
  const json given = bench.state();
  EXPECT_EQ(given.at("cards").at(0).at("id"), "hard iron");
  const std::size_t finding = finding_named(given, "hard iron");
  const HttpAnswer preview = bench.post("preview", json{{"finding", finding}}.dump());
  ASSERT_EQ(preview.status, 200) << preview.body;
  const double promised = json::parse(preview.body).at("leaves_mm").get<double>();
  EXPECT_EQ(
      bench
          .post("step",
                json{{"version", first.at("version")}, {"do", "add"}, {"finding", finding}}.dump())
          .status,
      202);
  const json after = bench.settled();
  EXPECT_EQ(after.at("failed"), "");
  const json with = bench.state();
  EXPECT_LT(with.at("figure").at("now_mm").get<double>(),
            0.15 * given.at("figure").at("now_mm").get<double>());
  EXPECT_EQ(with.at("steps").at(1).at("predicted_mm").get<double>(), promised);
  EXPECT_EQ(with.at("verdict").at("tone"), "good");
  // What can be taken along.
  const auto file = scratch.write("model.toml", bench.get("export/model.toml").body);
  const Model model = read_model(file);
  ASSERT_EQ(model.effects.size(), 1U);
  EXPECT_NEAR(model.effects[0].coefficients.at(0), 0.04, 0.002);
  EXPECT_NE(bench.get("export/constants.toml").body.find("no constant undoes hard iron"),
            std::string::npos);
  EXPECT_NE(bench.get("export/odometry.cpp").body.find("CorrectedOdometry"), std::string::npos);
  EXPECT_NE(bench.get("export/report.html").body.find("</html>"), std::string::npos);
  EXPECT_EQ(bench.get("export/../../etc/passwd").status, 404);
}

TEST(ServeCommand, AStepThatIsStoppedLeavesAllAsItWas) {
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  const json first = bench.settled();
  EXPECT_FALSE(first.at("stops").get<bool>());
  const json given = bench.state();
  const std::size_t finding = finding_named(given, "hard iron");
  const json add = {{"version", first.at("version")}, {"do", "add"}, {"finding", finding}};
  ASSERT_EQ(bench.post("step", add.dump()).status, 202);
  EXPECT_EQ(bench.status().at("step"), "Adding hard iron");
  ASSERT_EQ(bench.post("stop", "{}").status, 202);
  const json after = bench.settled();
  EXPECT_EQ(after.at("failed"), "");
  EXPECT_EQ(after.at("step"), "");
  EXPECT_EQ(bench.state().at("steps"), given.at("steps"));
  // And it can be made then; nothing is there to stop any more.
  ASSERT_EQ(bench.post("stop", "{}").status, 202);
  json again = add;
  again["version"] = after.at("version");
  ASSERT_EQ(bench.post("step", again.dump()).status, 202);
  EXPECT_EQ(bench.settled().at("failed"), "");
  EXPECT_EQ(bench.state().at("steps").size(), 2U);
}

TEST(ServeCommand, ItsCommandsDoTheSameWorkAgain) {
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  const json first = bench.settled();
  const json own = {{"version", first.at("version")},
                    {"do", "add"},
                    {"effect",
                     {{"name", "it's mine; rm -rf"},
                      {"channel", "compass"},
                      {"shape", {"sin(heading)", "cos(heading)"}}}}};
  ASSERT_EQ(bench.post("step", own.dump()).status, 202);
  ASSERT_EQ(bench.settled().at("failed"), "");
  const auto script = scratch.write("commands.sh", bench.get("export/commands.sh").body);
  const std::string command = "cd " + scratch.path().string() + " && ln -s " +
                              testing::command_path() + " trussmap && PATH=.:$PATH sh " +
                              script.string() + " > out 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const Model again = read_model(scratch.path() / "model.toml");
  const Model here = read_model(scratch.write("here.toml", bench.get("export/model.toml").body));
  ASSERT_EQ(again.effects.size(), 1U);
  EXPECT_EQ(again.effects[0].name, "it's mine; rm -rf");
  for (std::size_t k = 0; k < 2; ++k) {  // standard errors are 0.6 mrad
    EXPECT_NEAR(again.effects[0].coefficients.at(k), here.effects[0].coefficients.at(k), 1e-4);
  }
}

TEST(ServeCommand, AnswersItsOwnPageAlone) {
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  const auto asked = [&bench](const std::string& path, const std::string& headers) {
    return sent_to(bench.port(), "GET " + path + " HTTP/1.1\r\n" + headers + "\r\n\r\n");
  };
  const std::string here = "Host: " + bench.host();
  const std::string there = bench.path() + "status";
  EXPECT_EQ(asked(there, here).status, 200);
  EXPECT_EQ(asked(there, "Host: localhost:" + std::to_string(bench.port())).status, 200);
  EXPECT_EQ(asked(there, here + "\r\nOrigin: http://" + bench.host()).status, 200);
  // Names of elsewhere that lead here, pages of elsewhere, no token, a wrong one, half of one.
  EXPECT_EQ(asked(there, "Host: evil.example").status, 403);
  EXPECT_EQ(asked(there, "Host: evil.example:" + std::to_string(bench.port())).status, 403);
  EXPECT_EQ(asked(there, here + "\r\nOrigin: https://evil.example").status, 403);
  EXPECT_EQ(asked(there, here + "\r\nOrigin: null").status, 403);
  EXPECT_EQ(asked(there, here + "\r\nSec-Fetch-Site: cross-site").status, 403);
  EXPECT_EQ(asked("/status", here).status, 403);
  EXPECT_EQ(asked("/" + std::string(32, '0') + "/status", here).status, 403);
  EXPECT_EQ(asked(bench.path().substr(0, 10) + "/status", here).status, 403);
  EXPECT_EQ(asked("/", here).body.find(bench.path().substr(1, 32)), std::string::npos);
  // A form of elsewhere can send no JSON.
  const HttpAnswer form =
      sent_to(bench.port(), "POST " + bench.path() + "step HTTP/1.1\r\n" + here +
                                "\r\nContent-Type: text/plain\r\nContent-Length: 2\r\n\r\n{}");
  EXPECT_EQ(form.status, 415);
  const std::string head = bench.get("").head;
  EXPECT_NE(head.find("nosniff"), std::string::npos);
  EXPECT_NE(head.find("frame-ancestors 'none'"), std::string::npos);
}

TEST(ServeCommand, ListensToThisMachineAlone) {
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  // /proc/net/tcp has the local address of whatever listens: 0100007F is 127.0.0.1.
  std::ostringstream text;
  text << std::ifstream("/proc/net/tcp").rdbuf();
  char place[32];
  std::snprintf(place, sizeof(place), "0100007F:%04X 00000000:0000 0A", bench.port());
  EXPECT_NE(text.str().find(place), std::string::npos);
  std::snprintf(place, sizeof(place), "00000000:%04X", bench.port());
  EXPECT_EQ(text.str().find(place), std::string::npos);
}

TEST(ServeCommand, AThousandMalformedRequestsLeaveItRunning) {
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  const json first = bench.settled();
  const std::string version = first.at("version").dump();
  std::mt19937_64 random(11);
  const std::vector<std::string> bodies{
      "",
      "{",
      "[]",
      "null",
      "{\"finding\":-1}",
      "3",
      "{\"do\":1}",
      "\"x\"",
      "{\"finding\":1e99}",
      "{\"finding\":99999999}",
      "{\"version\":" + version + ",\"do\":\"go\",\"step\":77}",
      "{\"version\":" + version + ",\"do\":\"remove\",\"effect\":5}",
      "{\"finding\":0,\"values\":[1,2,3,4,5]}",
      "{\"choice\":3}",
      "{\"choice\":{\"time\":[1]}}",
      "{\"finding\":0,\"choice\":{\"time\":[1e308,-1e308]}}",
      "{\"choice\":{\"area\":[0,0,1,\"x\"]}}",
      "{\"choice\":{\"area\":[1e300,1e300,2e300,2e300]}}",
      "{\"version\":" + version + ",\"do\":\"exclude\",\"choice\":{\"time\":[-2,-1]}}",
      "{\"effect\":{}}",
      "{\"effect\":{\"name\":\"\",\"channel\":\"turn\",\"shape\":[\"1\"]}}",
      "{\"effect\":{\"name\":\"a\",\"channel\":\"no\",\"shape\":[\"1\"]}}",
      "{\"effect\":{\"name\":\"a\",\"channel\":\"turn\",\"shape\":[]}}",
      "{\"effect\":{\"name\":\"a\",\"channel\":\"turn\",\"shape\":[\"1/0\"]}}",
      "{\"effect\":{\"name\":\"a\",\"channel\":\"turn\",\"shape\":[\"system(1)\"]}}",
      "{\"effect\":{\"name\":\"a\\u0000b\",\"channel\":\"turn\",\"shape\":[\"speed\"]}}"};
  const std::vector<std::string> names{"preview", "best", "shown", "step", "legs", "nothing"};
  for (int k = 0; k < 1000; ++k) {
    if (k % 4 == 0) {  // no HTTP at all, or half of it
      std::string bytes = "GET " + bench.path() + "state HTTP/1.1\r\nHost: ";
      for (int c = 0; c < 40; ++c) bytes += static_cast<char>(random() % 256);
      if (k % 8 == 0) bytes += "\r\n\r\n";
      const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
      sockaddr_in place{};
      place.sin_family = AF_INET;
      place.sin_port = htons(bench.port());
      place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      ASSERT_EQ(::connect(socket, reinterpret_cast<sockaddr*>(&place), sizeof(place)), 0);
      static_cast<void>(::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL));
      ::close(socket);
      continue;
    }
    const HttpAnswer answer =
        bench.post(names[random() % names.size()], bodies[random() % bodies.size()]);
    // What happens to be right is answered; everything else in one line.
    EXPECT_TRUE(answer.status == 200 || (answer.status >= 400 && answer.status < 500))
        << answer.status << " " << answer.body;
    if (answer.status != 200) {
      EXPECT_TRUE(json::parse(answer.body).contains("error")) << answer.body;
    }
  }
  const std::string long_header = "GET " + bench.path() +
                                  "state HTTP/1.1\r\nHost: " + bench.host() +
                                  "\r\nX: " + std::string(100'000, 'x') + "\r\n\r\n";
  EXPECT_NE(sent_to(bench.port(), long_header).status, 200);
  EXPECT_NE(bench.post("preview", std::string(1'000'000, ' ')).status, 200);
  EXPECT_EQ(bench.settled(), first);  // and nothing was changed
  EXPECT_EQ(bench.get("state").status, 200);
}

TEST(ServeCommand, FormulasAreShortShallowAndNothingElse) {
  EXPECT_EQ(app::fault_of_formula("max(0, speed-0.5)"), "");
  EXPECT_NE(app::fault_of_formula(""), "");
  EXPECT_NE(app::fault_of_formula(std::string(201, '1')), "");
  EXPECT_EQ(app::fault_of_formula(std::string(12, '(') + "1" + std::string(12, ')')), "");
  EXPECT_NE(app::fault_of_formula(std::string(13, '(') + "1" + std::string(13, ')')), "");
}

TEST(ServeCommand, TwoWindowsDoNotFight) {
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  const json first = bench.settled();
  const std::size_t finding = finding_named(bench.state(), "hard iron");
  const std::string add =
      json{{"version", first.at("version")}, {"do", "add"}, {"finding", finding}}.dump();
  EXPECT_EQ(bench.post("step", add).status, 202);
  const HttpAnswer second = bench.post("step", add);
  EXPECT_EQ(second.status, 409) << second.body;  // under way, or of a version that is gone
  static_cast<void>(bench.settled());
  EXPECT_EQ(bench.post("step", add).status, 409);
  // Findings have other numbers now: a preview of the state before is refused, too.
  const json stale = {{"version", first.at("version")}, {"finding", finding}};
  EXPECT_EQ(bench.post("preview", stale.dump()).status, 409);
  EXPECT_EQ(bench.state().at("steps").size(), 2U);
}

TEST(ServeCommand, KilledItGoesOnWhereItsLastStepEnded) {
  const ScratchFolder scratch;
  json before;
  {
    const ServedBench bench(riddle(scratch));
    const json first = bench.settled();
    const std::size_t finding = finding_named(bench.state(), "hard iron");
    EXPECT_EQ(
        bench
            .post(
                "step",
                json{{"version", first.at("version")}, {"do", "add"}, {"finding", finding}}.dump())
            .status,
        202);
    const json second = bench.settled();
    before = bench.state();
    const std::size_t next = finding_named(before, "wheelbase");
    EXPECT_EQ(
        bench
            .post("step",
                  json{{"version", second.at("version")}, {"do", "add"}, {"finding", next}}.dump())
            .status,
        202);
    bench.kill();  // SIGKILL, in the midst of a step
  }
  const ServedBench again(riddle(scratch));
  static_cast<void>(again.settled());
  json after = again.state();
  EXPECT_GE(after.at("steps").size(), 2U);
  if (after.at("steps").size() == 2U) {  // the last step was not done yet
    EXPECT_EQ(after, before);
  }
}

TEST(ServeCommand, OtherWorkIsNotGoneOnWith) {
  const ScratchFolder scratch;
  {
    const ServedBench bench(riddle(scratch));
    static_cast<void>(bench.settled());
  }
  const auto model = scratch.write("other.toml", "[robot]\nwheelbase = 0.4\n");
  const Ran other = run_trussmap("serve " + kRiddle + " --no-browser --model " + model.string() +
                                 " --work " + (scratch.path() / "work").string());
  EXPECT_EQ(other.status, 2) << other.output;
  EXPECT_NE(other.output.find("began with another model"), std::string::npos) << other.output;
  const Ran without =
      run_trussmap("serve " + kRiddle + " --no-browser --model " + kRiddle +
                   "/model.toml --exclude 10:20 --work " + (scratch.path() / "work").string());
  EXPECT_EQ(without.status, 2) << without.output;
  EXPECT_NE(without.output.find("began with other times excluded"), std::string::npos)
      << without.output;
  EXPECT_EQ(
      run_trussmap("serve " + kRiddle + " --no-browser --model " + model.string() + " --port 70000")
          .status,
      2);
}

json add_of(const ServedBench& bench, const json& status, const std::string& id) {
  return {{"version", status.at("version")},
          {"do", "add"},
          {"finding", finding_named(bench.state(), id)}};
}

TEST(ServeCommand, AStepThatCannotBeWrittenIsTakenBack) {
  const ScratchFolder scratch;
  const ServedBench bench(riddle(scratch));
  const json first = bench.settled();
  const fs::path work = scratch.path() / "work";
  fs::rename(work, scratch.path() / "aside");
  scratch.write("work", "a file in the folder's place");
  EXPECT_EQ(bench.post("step", add_of(bench, first, "hard iron").dump()).status, 202);
  const json failed = bench.settled();
  EXPECT_NE(failed.at("failed").get<std::string>(), "");
  EXPECT_EQ(bench.state().at("steps").size(), 1U);
  fs::remove(work);
  fs::rename(scratch.path() / "aside", work);
  // The same step again, not a second one: the first is not in memory either.
  EXPECT_EQ(bench.post("step", add_of(bench, failed, "hard iron").dump()).status, 202);
  EXPECT_EQ(bench.settled().at("failed"), "");
  EXPECT_EQ(bench.state().at("steps").size(), 2U);
}

TEST(ServeCommand, AFolderThatCannotBeWrittenEndsItAtOnce) {
  const ScratchFolder scratch;
  scratch.write("file", "no folder");
  const std::string work = (scratch.path() / "file" / "work").string();
  const Ran ran = run_trussmap("serve " + kRiddle + " --no-browser --model " + kRiddle +
                               "/model.toml --work " + work);
  EXPECT_EQ(ran.status, 2);
  EXPECT_NE(ran.output.find(work + ": cannot be written"), std::string::npos) << ran.output;
}

/// The browser gets a page that its user alone may read, and no secret by its command line.
TEST(ServeCommand, TheTokenIsOnNoCommandLine) {
  const ScratchFolder scratch;
  const fs::path opened = scratch.path() / "opened";
  fs::permissions(
      scratch.write("xdg-open", "#!/bin/sh\necho \"$@\" > " + opened.string() + ".part\nmv " +
                                    opened.string() + ".part " + opened.string() + "\n"),
      fs::perms::owner_all);
  const testing::ChildProcess child([&] {
    ::setenv("PATH", (scratch.path().string() + ":/usr/bin:/bin").c_str(), 1);
    ::setenv("DISPLAY", ":0", 1);
    std::vector<std::string> words{testing::command_path(), "serve"};
    for (const std::string& word : riddle(scratch)) words.push_back(word);
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    ::freopen((scratch.path() / "said").c_str(), "w", stdout);
    ::execv(pointers.front(), pointers.data());
  });
  for (int k = 0; k < 1000 && !fs::exists(opened); ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  std::string argument;
  std::getline(std::ifstream(opened) >> std::ws, argument);
  std::string address;
  std::getline(std::ifstream(scratch.path() / "said") >> std::ws, address);
  ASSERT_EQ(address.rfind("http://127.0.0.1:", 0), 0U) << address;
  EXPECT_EQ(argument.find("http"), std::string::npos) << argument;
  ASSERT_TRUE(fs::exists(argument)) << argument;
  EXPECT_EQ(fs::status(argument).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  std::ostringstream page;
  page << std::ifstream(argument).rdbuf();
  EXPECT_NE(page.str().find("url=" + address + "\""), std::string::npos) << page.str();
}

int half_a_request(std::uint16_t port) {
  const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket, reinterpret_cast<sockaddr*>(&place), sizeof(place)) != 0) return -1;
  const std::string half = "GET / HTTP/1.1\r\nHost: ";
  static_cast<void>(::send(socket, half.data(), half.size(), MSG_NOSIGNAL));
  return socket;
}

/// Whether the other side closes it within so many ms.
bool is_closed_within(int socket, int wait) {
  pollfd ready{socket, POLLIN, 0};
  char byte = 0;
  return ::poll(&ready, 1, wait) > 0 && ::recv(socket, &byte, 1, MSG_DONTWAIT) <= 0;
}

TEST(SlowServeCommand, NobodyKeepsTheOwnerOut) {
  const ScratchFolder scratch;
  rlimit files{};
  ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &files), 0);
  if (files.rlim_max < 2000) GTEST_SKIP() << "too few open files are allowed: " << files.rlim_max;
  files.rlim_cur = std::max<rlim_t>(files.rlim_cur, 2000);
  ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &files), 0);
  const ServedBench bench(riddle(scratch));
  static_cast<void>(bench.settled());
  std::vector<int> sockets;
  for (int k = 0; k < 1000; ++k) sockets.push_back(half_a_request(bench.port()));
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_EQ(bench.get("status").status, 200);
  EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(1));
  EXPECT_TRUE(is_closed_within(sockets.front(), 1000));  // the oldest went first
  EXPECT_FALSE(is_closed_within(sockets.back(), 0));
  EXPECT_TRUE(is_closed_within(sockets.back(), 7000));  // and none lasts
  for (const int socket : sockets) ::close(socket);
}

}  // namespace
}  // namespace trussmap::serve_command_test
