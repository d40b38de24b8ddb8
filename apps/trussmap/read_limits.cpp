// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "read_limits.hpp"

#include "trussmap/write_files.hpp"

#include <cstddef>
#include <functional>
#include <string>

namespace trussmap::app {
namespace {

void add_to(CLI::App& command) {
  constexpr int kMostMebibytes = 1 << 20;
  constexpr int kMostNesting = 10000;
  const std::function<void(const int&)> set_bytes = [](const int& mebibytes) {
    ReadLimits limits = read_limits();
    limits.bytes = static_cast<std::size_t>(mebibytes) << 20U;
    set_read_limits(limits);
  };
  const std::function<void(const int&)> set_nesting = [](const int& depth) {
    ReadLimits limits = read_limits();
    limits.nesting = depth;
    set_read_limits(limits);
  };
  command
      .add_option_function("--max-input-mib", set_bytes,
                           "Read files of this size [MiB] at most, decompressed and with their "
                           "defaults; without it a compressed file may grow to 64 MiB or 200 times "
                           "its size, a map by its defaults to 16 MiB or 10 times")
      ->check(CLI::Range(1, kMostMebibytes))
      ->type_name("N")
      ->group("Limits");
  command
      .add_option_function("--max-nesting", set_nesting,
                           "Read maps whose elements are nested so deep at most; 100 if left out")
      ->check(CLI::Range(1, kMostNesting))
      ->type_name("N")
      ->group("Limits");
}

}  // namespace

void add_read_limits(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    const bool reads = command->get_name() != "tour" && command->get_name() != "explore";
    if (reads) add_to(*command);
  }
}

}  // namespace trussmap::app
