// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A bench of several parts, of which those named on the command line run, or all.
#pragma once

#include <algorithm>
#include <cstdio>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace trussmap::bench {

template <typename Options>
struct Part {
  std::string name;
  std::function<void(const Options&)> run;
};

/// What a bench does before its parts run, to options and the parts asked for, and after.
template <typename Options>
struct Around {
  std::function<void(Options&, std::vector<std::string>&)> before = [](auto&, auto&) {};
  std::function<void(const Options&, const std::vector<std::string>&)> after = [](auto&, auto&) {};
};

/// Body of main. `add_options` adds those of its own; what a part throws is told in one line.
template <typename Options>
int run_bench(int argc, char** argv, const std::string& description,
              const std::vector<Part<Options>>& parts,
              const std::function<void(CLI::App&, Options&)>& add_options,
              const Around<Options>& around = {}) {
  try {
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // a long run is watched
    CLI::App app(description);
    Options options;
    std::vector<std::string> names;
    for (const Part<Options>& one : parts) names.push_back(one.name);
    std::vector<std::string> asked;
    app.add_option("parts", asked, "What to measure (default: all)")->check(CLI::IsMember(names));
    add_options(app, options);
    CLI11_PARSE(app, argc, argv);
    around.before(options, asked);
    for (const Part<Options>& one : parts) {
      if (asked.empty() || std::find(asked.begin(), asked.end(), one.name) != asked.end()) {
        one.run(options);
      }
    }
    around.after(options, asked);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace trussmap::bench
