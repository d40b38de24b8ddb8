// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Options of the criticism bench, and those of its parts that stand in a file of their own.
#pragma once

#include "trials.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace trussmap::bench {

struct CriticismOptions {
  std::uint64_t first = 1;
  int recordings = 20;  ///< per effect and size
  int clean = 1000;
  std::vector<double> times = {2.0, 3.0};  ///< of the smallest detectable size
  bool loops = false;                      ///< without survey
  bool ladder = true;
  bool verbose = false;
  std::string shard;                ///< "3/16"
  std::string out;                  ///< of the share
  std::vector<std::string> merged;  ///< files of shares
  std::shared_ptr<Trials> trials = std::make_shared<Trials>("trussmap_criticism_bench");
};

// What each measures: criticism_bench.cpp.
void events(const CriticismOptions& options);
void noise(const CriticismOptions& options);
void riddles(const CriticismOptions& options);
void cost();

}  // namespace trussmap::bench
