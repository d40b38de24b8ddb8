// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/datasets.hpp"

#include "datasets/formats.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <stdexcept>

namespace trussmap {
using namespace datasets;

namespace {

constexpr DatasetFormat kFormats[] = {
    {"MRCLAM", "DIR/RobotN of an MRCLAM data set", &is_mrclam, &read_mrclam},
    {"OptiOdom", "an OptiOdom run (..._run-NN.csv)", &is_optiodom, &read_optiodom},
    {"ranges to radio beacons", "DIR/NAME of ranges to radio beacons (NAME_DR.txt, NAME_TD.txt)",
     &is_radio_ranges, &read_radio_ranges},
    {"places that look alike", "DIR/NAME of places that look alike (TUC SLAM, NAME_Input.txt)",
     &is_place_loops, &read_place_loops},
    {"PHIL", "DIR/trial_N of PHIL's Turtlebot (a folder with kobuki_data.csv)", &is_phil,
     &read_phil},
    {"a truck with steering and GPS",
     "DIR/NAME of a truck with steering and GPS (Victoria Park, NAME_dr.mat, NAME_gpsx.mat)",
     &is_steered_truck, &read_steered_truck},
    {"a robot on a line", "a robot on a line (dataset1.csv)", &is_line_robot, &read_line_robot},
    {"a tricycle's encoders", "a log of a tricycle's encoders (.txt)", &is_encoder_log,
     &read_encoder_log},
    {"the pose graph", "a pose graph (.g2o)", &is_graph_recording, &read_graph_recording},
};

}  // namespace

double Dataset::figure(std::string_view key) const {
  const auto found = std::find_if(figures.begin(), figures.end(),
                                  [key](const DatasetFigure& one) { return one.key == key; });
  if (found == figures.end()) {
    throw std::out_of_range("no figure \"" + std::string(key) + "\" of this data set");
  }
  return found->value;
}

std::span<const DatasetFormat> dataset_formats() {
  return kFormats;
}

const DatasetFormat* dataset_format(const std::filesystem::path& path) {
  const auto* found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                   [&path](const DatasetFormat& one) { return one.is(path); });
  return found == std::end(kFormats) ? nullptr : found;
}

Dataset read_dataset(const std::filesystem::path& path) {
  const DatasetFormat* const format = dataset_format(path);
  if (format != nullptr) return format->read(path);
  std::string expected;
  for (const DatasetFormat& one : kFormats) {
    expected += (expected.empty() ? "" : ", ") + std::string(one.expected);
  }
  throw InputError(path.string(), 0, "is no data set that is known, expected " + expected);
}

}  // namespace trussmap
