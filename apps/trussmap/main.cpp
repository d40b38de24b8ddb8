// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "call_again.hpp"
#include "commands.hpp"
#include "help.hpp"
#include "read_limits.hpp"
#include "threads_option.hpp"
#include "trussmap/error.hpp"
#include "trussmap/table.hpp"
#include "trussmap/write_files.hpp"

#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>

#include <CLI/CLI.hpp>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace {

constexpr int kFailed = 1;
constexpr int kBadInput = 2;

int complain(const std::string& what, int status) {
  const std::string message = trussmap::escaped_controls(what, true);
  std::fprintf(stderr, "trussmap: %s\n", trussmap::shortened_words(message).c_str());
  return status;
}

int complain(const std::exception& error, int status) {
  return complain(std::string(error.what()), status);
}

/// Its own words name functions of the C++ library.
std::string in_words(const std::filesystem::filesystem_error& error) {
  return error.path1().string() + ": " + error.code().message();
}

/// Ctrl-C, a closed terminal: nothing half written stays behind, and the program ends as if it had
/// not been asked.
extern "C" void end_by(int signal) {
  trussmap::discard_temporaries();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

void clean_up_on_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    if (std::signal(signal, end_by) == SIG_IGN) std::signal(signal, SIG_IGN);  // nohup
  }
}

/// The first word must be a command: CLI11 would only miss one.
void check_command(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return;
  std::string names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == argv[1]) return;
    names += (names.empty() ? "" : ", ") + command->get_name();
  }
  throw trussmap::app::UsageError("\"" + std::string(argv[1]) +
                                  "\" is no command, expected one of " + names);
}

/// With the first thing that the command was given, which mostly is what was read.
std::string out_of_memory(const CLI::App& app) {
  std::string name;
  std::string what;
  for (const CLI::App* command : app.get_subcommands()) {
    name = command->get_name();
    for (const CLI::Option* option : command->get_options()) {
      if (!option->get_positional() || option->count() == 0) continue;
      for (const std::string& one : option->results()) what += (what.empty() ? "" : ", ") + one;
      break;
    }
  }
  return (what.empty() ? name : what) +
         ": there is not enough memory for it, expected less data or a larger machine";
}

/// Large matrices are made and dropped by the thousand: their memory is kept instead of being
/// fetched anew, zeroed, from the system, which took a fifth of the time of a week's recording.
void keep_memory() {
#if defined(__GLIBC__)
  mallopt(M_MMAP_THRESHOLD, 1 << 30);
  mallopt(M_TRIM_THRESHOLD, 1 << 28);
#endif
}

/// What was said has to have arrived: a full disk must not look like success.
int with_output_written(int status) {
  std::cout.flush();
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return status;
  std::fprintf(stderr, "trussmap: standard output could not be written\n");
  return kFailed;
}

int run(int argc, char** argv) {
  clean_up_on_signals();
  keep_memory();
  trussmap::app::remember_call(argc, argv);
  CLI::App app{"trussmap builds landmark maps for mobile robots as elastic trusses.", "trussmap"};
  trussmap::app::begin_help(app);
  app.require_subcommand(1);
  app.set_version_flag("--version", "trussmap " TRUSSMAP_VERSION);
  const trussmap::app::Command commands(&app);
  trussmap::app::setup_add(commands);
  trussmap::app::setup_adjust(commands);
  trussmap::app::setup_apply(commands);
  trussmap::app::setup_build(commands);
  trussmap::app::setup_calibrate(commands);
  trussmap::app::setup_check(commands);
  trussmap::app::setup_compare(commands);
  trussmap::app::setup_completion(commands, app);
  trussmap::app::setup_contrast(commands);
  trussmap::app::setup_convert(commands);
  trussmap::app::setup_diagnose(commands);
  trussmap::app::setup_discover(commands);
  trussmap::app::setup_effects(commands);
  trussmap::app::setup_explore(commands);
  trussmap::app::setup_fit(commands);
  trussmap::app::setup_fleet(commands);
  trussmap::app::setup_manual(commands, app);
  trussmap::app::setup_merge(commands);
  trussmap::app::setup_noise(commands);
  trussmap::app::setup_plan(commands);
  trussmap::app::setup_reveal(commands);
  trussmap::app::setup_schema(commands);
  trussmap::app::setup_serve(commands);
  trussmap::app::setup_simulate(commands);
  trussmap::app::setup_tape(commands);
  trussmap::app::setup_tour(commands);
  trussmap::app::setup_umbmark(commands);
  trussmap::app::setup_watch(commands);
  trussmap::app::add_read_limits(app);
  trussmap::app::add_threads_option(app);
  trussmap::app::finish_help(app);
  try {
    check_command(app, argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::Success& wanted) {  // --help, --version
    return app.exit(wanted);
  } catch (const trussmap::app::AnswerIsNo&) {
    return kFailed;
  } catch (const trussmap::app::AlreadySaid& other) {
    return other.status();
  } catch (const CLI::ParseError& error) {
    return complain(error, kBadInput);
  } catch (const trussmap::InputError& error) {  // a line, whatever the file holds
    return complain(trussmap::escaped_controls(error.what()), kBadInput);
  } catch (const trussmap::app::UsageError& error) {
    return complain(error, kBadInput);
  } catch (const std::filesystem::filesystem_error& error) {  // an output folder, mostly
    return complain(in_words(error), kBadInput);
  } catch (const std::bad_alloc&) {
    return complain(out_of_memory(app), kFailed);
  } catch (const std::length_error&) {  // more than any machine has
    return complain(out_of_memory(app), kFailed);
  } catch (const std::exception& error) {
    return complain(error, kFailed);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  return with_output_written(run(argc, argv));
} catch (const std::exception& error) {  // while setting up, or while printing help
  return complain(error, kFailed);
}
