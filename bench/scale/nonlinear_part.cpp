// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "ceres_rivals.hpp"
#include "measure.hpp"
#include "parts.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/pose_graph.hpp"

#include <string>

#include <fmt/format.h>

namespace trussmap::bench {
namespace {

struct Known {
  const char* file;
  double chi2;  ///< the lowest that anybody has reported
  bool must_be_fast;
};

constexpr Known kGraphs[] = {{"manhattanOlson3500.g2o.xz", 146.0766, true},
                             {"intel.g2o.xz", 45.0047, true},
                             {"MIT.g2o.xz", 41.1633, false},
                             {"FR079_P_toro.graph.xz", 37.5991, false},
                             {"kitti_05.g2o.xz", 157.1044, false}};

}  // namespace

void nonlinear_part(const std::filesystem::path& folder, int repetitions) {
  for (const Known& known : kGraphs) {
    const PoseGraph graph = read_g2o((folder / known.file).string());
    fmt::print("\n{}: {} poses, {} edges (ms of processor time, least of {})\n", known.file,
               graph.vertices.size(), graph.pose_edges.size(), repetitions);
    const std::vector<Rival> rivals{
        {"Ceres, the file's start, to 1e-6",
         [&](Stages& s) { return fit_with_ceres(graph, known.chi2, 1e-6, s); }},
        {"trussmap, any start, to 1e-13",
         [&](Stages& s) {
           const PoseGraphAdjustment fit = adjust(graph);
           s.end("adjust");
           return fit.chi2;
         }},
        {"trussmap, its own start, to 1e-7", [&](Stages& s) {
           AdjustmentOptions options;
           options.start = StartFrom::odometry;
           options.tolerance = 1e-7;
           const PoseGraphAdjustment fit = adjust(graph, options);
           s.end("adjust");
           return fit.chi2;
         }}};
    const std::vector<Run> runs = race(rivals, repetitions);
    print(rivals, runs);
    const double ratio = runs[2].stages.total() / runs[0].stages.total();
    if (known.must_be_fast) verdict("own start over Ceres", ratio, 0.7);
    verdict("chi2 over the lowest known, less one, 1e-5", 1e5 * (runs[2].answer / known.chi2 - 1.0),
            1.0);
  }
}

}  // namespace trussmap::bench
