// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "tour_output.hpp"

#include "results/json.hpp"
#include "results/tours.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

std::string counted(std::size_t count, const char* what) {
  return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
}

/// Which tours a table shows: the first few, then fewer and fewer, and the last.
std::vector<std::size_t> shown_tours(std::size_t count) {
  std::vector<std::size_t> shown;
  for (const std::size_t tour : {1, 2, 3, 4, 5, 10, 20, 50, 100, 200, 500, 1000}) {
    if (tour <= count) shown.push_back(tour);
  }
  if (shown.back() != count) shown.push_back(count);
  return shown;
}

template <class Pick>
void print_block(const TourResult& result, const char* title, int digits, const Pick& pick) {
  fmt::print("\n{}\n  tour", title);
  std::vector<std::string> methods;
  for (const std::string& method : tour_methods()) {
    if (pick(result.tours.front().at(method))) methods.push_back(method);
  }
  for (const std::string& method : methods) fmt::print("  {:>16}", method);
  fmt::print("\n");
  for (const std::size_t tour : shown_tours(result.tours.size())) {
    fmt::print("  {:>4}", tour);
    for (const std::string& method : methods) {
      const double mean = pick(result.tours[tour - 1].at(method))->mean;
      constexpr double kLong = 1e6;  // diverged
      if (mean < kLong) {
        fmt::print("  {:>16.{}f}", mean, digits);
      } else {
        fmt::print("  {:>16.{}g}", mean, digits);
      }
    }
    fmt::print("\n");
  }
}

}  // namespace

void show_tours(const TourResult& result, const TourOutput& output) {
  Files files;
  files.folders = output.maps;
  if (!output.json_file.empty()) {
    files.emplace_back(output.json_file,
                       results::json_text(results::TourReport{&result, output.aligned}));
  }
  if (output.page.wanted()) {
    add_page(files, tour_page(result, output.seeds, output.world), output.page);
  }
  files.write();
  const MethodMetrics& last = result.tours.back();
  const double raw = last.at("raw").stretch_error.mean;
  fmt::print(
      "after {} the elastic map's mean error is {:.2f} % of a route's stretch and {:.4f} rad "
      "of its orientation\n"
      "(single measurements: {:.2f} %, {:.4f} rad; the best possible, the adjustment: {:.2f} %, "
      "{:.4f} rad);\nmeans over {}\n",
      counted(result.tours.size(), "tour"), 100.0 * last.at("elastic").stretch_error.mean,
      last.at("elastic").orientation_error.mean, 100.0 * raw, last.at("raw").orientation_error.mean,
      100.0 * last.at("adjustment").stretch_error.mean,
      last.at("adjustment").orientation_error.mean,
      counted(static_cast<std::size_t>(output.seeds), "seed"));
  print_block(result, "stretch error, mean of |s - s_true|/s_true over the routes", 4,
              [](const TourMetrics& f) { return std::optional<SeedMean>(f.stretch_error); });
  print_block(result, "orientation error, mean of |theta - theta_true| over the routes [rad]", 4,
              [](const TourMetrics& f) { return std::optional<SeedMean>(f.orientation_error); });
  print_block(result,
              output.aligned
                  ? "position error, mean distance of the landmarks from the truth after the best "
                    "rotation and translation [m]"
                  : "position error, mean distance of the landmarks from the truth [m]",
              4, [](const TourMetrics& f) { return f.position_error; });
  fmt::print(
      "\nfirst sight, tour 1: before {:.3f} / {:.3f} rad, after {:.3f} / {:.3f} rad "
      "(the paper's Table I, one map: 0.049 / 0.033, then 0.046 / 0.032)\n",
      result.first_sight_before.stretch_error.mean,
      result.first_sight_before.orientation_error.mean, result.first_sight_after.stretch_error.mean,
      result.first_sight_after.orientation_error.mean);
}

}  // namespace trussmap::app
