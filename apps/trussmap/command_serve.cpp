// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap serve: a workbench in the browser.
#include "bench_requests.hpp"
#include "bench_work.hpp"
#include "commands.hpp"
#include "local_server.hpp"
#include "model_recordings.hpp"
#include "option_checks.hpp"
#include "page_runtime.hpp"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <iterator>
#include <memory>
#include <spawn.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

namespace fs = std::filesystem;

struct ServeCommand {
  ModelRecordingsOptions input;
  std::string work;
  int port = 0;
  bool no_browser = false;
};

/// A page that leads to the address, for the user alone: an address on a command line is everyone's
/// to read (ps). Empty where it cannot be written.
fs::path page_that_leads_to(const std::string& address, const fs::path& folder) {
  fs::path page = fs::absolute(folder) / "open.html";
  ::unlink(page.c_str());
  constexpr mode_t kOwnerAlone = 0600;
  const int file =
      ::open(page.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kOwnerAlone);
  if (file < 0) return {};
  const std::string text = fmt::format(
      "<!DOCTYPE html><meta charset=\"utf-8\"><meta name=\"referrer\" content=\"no-referrer\">"
      "<meta http-equiv=\"refresh\" content=\"0; url={0}\"><a href=\"{0}\">The workbench</a>\n",
      address);
  const bool whole = ::write(file, text.data(), text.size()) == std::ssize(text);
  ::close(file);
  return whole ? page : fs::path();
}

/// In the user's browser, where there is a screen; whether that works or not.
void open_in_browser(const std::string& address, const fs::path& folder) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return;
  const fs::path page = page_that_leads_to(address, folder);
  if (page.empty()) return;
  std::string program = "xdg-open";
  std::string argument = page.string();
  char* arguments[] = {program.data(), argument.data(), nullptr};
  pid_t child = 0;
  posix_spawn_file_actions_t quiet;
  posix_spawn_file_actions_init(&quiet);
  posix_spawn_file_actions_addopen(&quiet, 1, "/dev/null", 1, 0);  // for writing
  posix_spawn_file_actions_addopen(&quiet, 2, "/dev/null", 1, 0);
  const bool begun =
      posix_spawnp(&child, program.c_str(), &quiet, nullptr, arguments, environ) == 0;
  posix_spawn_file_actions_destroy(&quiet);
  if (!begun) return;
  std::thread([child] {  // no zombie
    while (::waitpid(child, nullptr, 0) < 0 && errno == EINTR) {
    }
  })
      .detach();
}

/// "riddle.workbench" for maps/riddle/.
std::string usual_folder(const std::string& recording) {
  std::filesystem::path path = std::filesystem::path(recording).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  return path.filename().string() + ".workbench";
}

void run_serve(const ServeCommand& options) {
  Session session = read_session(options.input);
  for (Effect& effect : session.model.effects) effect.coefficients.clear();  // they are fitted
  LocalServer server(static_cast<std::uint16_t>(options.port));
  const std::string folder =
      options.work.empty() ? usual_folder(options.input.recordings.front()) : options.work;
  const std::vector<std::string> notes = session.rows.notes;
  BenchWork work({std::move(session.rows), std::move(session.model),
                  diagnose_options(session.options),
                  subject_of(options.input.recordings, options.input.model), folder});
  const BenchOrigin origin{options.input.recordings, options.input.model};
  fmt::print(
      "{}\nOpen this address in a browser on this machine. Steps are kept in {}; Ctrl-C "
      "ends it.\n",
      server.address(), folder);
  for (const std::string& note : notes) fmt::print("{}\n", note);
  std::fflush(stdout);
  if (!options.no_browser) open_in_browser(server.address(), folder);
  server.run([&](const LocalRequest& request) { return bench_reply(request, work, origin); },
             [&work] { return work.status(); });
}

}  // namespace

void setup_serve(const Command& app) {
  auto options = std::make_shared<ServeCommand>();
  const Command command =
      app.add_subcommand("serve", "Try effects out in the browser and watch the error fall");
  add_fitted_recordings(command, options->input);
  add_stated_noise(command, options->input);
  command
      .add_option("--work", options->work,
                  "Folder that keeps the steps (default: NAME.workbench, of the first recording)")
      .type_name("DIR");
  command.add_option("--port", options->port, "Port on 127.0.0.1 (default: any that is free)")
      .type_name("PORT")
      .check(between(0, 65535));
  command.add_flag("--no-browser", options->no_browser, "Open no browser");
  command.footer(
      "Serves a page to this machine alone, under an address that holds a secret. Every step is\n"
      "kept when it is done: the same command goes on where it ended.");
  command.callback([options] { run_serve(*options); });
}

}  // namespace trussmap::app
