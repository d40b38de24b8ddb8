// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// trussmap schema: what commands write with --json.
#include "commands.hpp"
#include "results/calibration.hpp"
#include "results/catalogue.hpp"
#include "results/checks.hpp"
#include "results/common.hpp"
#include "results/criticism.hpp"
#include "results/experiments.hpp"
#include "results/exploration.hpp"
#include "results/fleet.hpp"
#include "results/maps.hpp"
#include "results/plans.hpp"
#include "results/pose_graphs.hpp"
#include "results/schema.hpp"
#include "results/simulation.hpp"
#include "results/tours.hpp"
#include "results/watch.hpp"
#include "trussmap/write_files.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>

namespace trussmap::app {
namespace {

using results::Json;
using results::Reported;
using results::WithConstants;

Json schema() {
  results::SchemaMaker maker;
  maker.define<Reported<ComparisonReport>>("compare");
  maker.define<Reported<DiagnosisReport>>("diagnose");
  maker.define<Reported<DiscoveryReport>>("discover");
  maker.define<Reported<FitReport>>("fit");
  maker.define<results::StoreReport>("build-store");
  maker.define<results::AdjustReport>("adjust");
  maker.define<results::DistributedReport>("adjust-solver");
  maker.define<WithConstants<results::CalibrationReport>>("calibrate");
  maker.define<WithConstants<results::SquareReport>>("umbmark");
  maker.define<results::NoiseReport>("noise");
  maker.define<results::TapeReport>("tape");
  maker.define<results::CheckReport>("check");
  maker.define<results::CatalogueReport>("effects");
  maker.define<results::ExploreReport>("explore");
  maker.define<FleetReport>("fleet-report");
  maker.define<RunContrast>("contrast");
  maker.define<results::PlanReport>("plan");
  maker.define<results::Revealed>("reveal");
  maker.define<results::SimulationReport>("simulate");
  maker.define<results::TourReport>("tour", "means over the seeds");
  maker.define<results::TourReport>("merge", "means over the seeds");
  maker.define<results::WatchReport>("watch");
  return {{"$schema", "http://json-schema.org/draft-07/schema#"},
          {"title", "What the commands of trussmap write with --json"},
          {"description",
           "A definition per command, under its name, and their common parts. Keys are stable: "
           "some may be added, none is renamed. Names end in the unit; numbers without one are "
           "counts, ratios or chi2. sd_X is the standard error of X."},
          {"definitions", maker.definitions()}};
}

void run_schema(const std::string& out) {
  const std::string text = schema().dump(2) + "\n";
  if (out.empty()) {
    fmt::print("{}", text);
  } else {
    write_file(out, text);
  }
}

}  // namespace

void setup_schema(const Command& app) {
  auto out = std::make_shared<std::string>();
  const Command command =
      app.add_subcommand("schema", "Print the JSON Schema of what commands write with --json");
  command.add_option("--out", *out, "Write it to a file instead").type_name("FILE");
  command.callback([out] { run_schema(*out); });
}

}  // namespace trussmap::app
