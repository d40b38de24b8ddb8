// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a workbench's page asks, and the answers.
//
//   GET  ""              the page                 GET  export/NAME   model.toml, ...
//   GET  state           what it shows            GET  status        as of the events
//   POST preview {"finding", "values", "rivals"} or {"effect": {"name", "channel", "shape"}, ...}
//   POST best    {"finding", "values"}            POST shown {"effect"}
//   POST noise   {"factor"}
//   POST explain {"finding"} or {"effect": its place in the model}
//   POST step    {"version", "do": "add" | "remove" | "exclude" | "include" | "go" | "name", ...}
//   POST stop    {}
//
// A "version" that is not the present one is refused, in any of them. Every answer that is none is
// {"error": one line}. Formulas are evaluated by the library's parser alone, and only where they
// are short and shallow.
#pragma once

#include "bench_work.hpp"
#include "local_server.hpp"

#include <string>
#include <vector>

namespace trussmap::app {

/// How the work was begun: for the commands that do it again.
struct BenchOrigin {
  std::vector<std::string> recordings;
  std::string model;
};

[[nodiscard]] LocalReply bench_reply(const LocalRequest& request, BenchWork& work,
                                     const BenchOrigin& origin);

}  // namespace trussmap::app
