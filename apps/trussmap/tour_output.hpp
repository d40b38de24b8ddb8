// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What tour, and merge of its shards, print and write.
#pragma once

#include "page_runtime.hpp"
#include "trussmap/tour_experiment.hpp"

#include <string>
#include <vector>

namespace trussmap::app {

struct TourOutput {
  std::string world;  ///< "6x6 mesh, walk euler"
  int seeds = 0;
  bool aligned = false;  ///< errors are after the best rotation and translation
  std::string json_file;
  PageOptions page;
  std::vector<FolderOfFiles> maps;  ///< written, too
};

void show_tours(const TourResult& result, const TourOutput& output);

}  // namespace trussmap::app
