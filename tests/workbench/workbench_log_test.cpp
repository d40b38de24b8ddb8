// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "driven.hpp"
#include "scratch_folder.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/error.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/workbench.hpp"

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::workbench_log_test {
namespace {

using testing::ScratchFolder;

std::vector<DrivenRecording> riddle() {
  return {
      testing::driven(read_recording(std::filesystem::path(TRUSSMAP_SOURCE_DIR) / "maps/riddle"))};
}

WorkbenchLog some_log() {
  WorkbenchLog log;
  log.steps.resize(3);
  log.steps[0].model.robot.wheelbase = 0.1 + 0.2;  // no short number
  log.steps[0].arrival_rms = 1.0 / 3.0;
  log.steps[1].kind = WorkbenchStep::Kind::add;
  log.steps[1].effect = "hard iron";
  log.steps[1].model = log.steps[0].model;
  log.steps[1].model.effects.push_back(catalogue_effect("hard iron"));
  log.steps[1].predicted_rms = 0.0123456789012345678;
  log.steps[1].expected_rms = 1e-3;
  log.steps[1].chi2 = 118.25;
  log.steps[1].dof = 116;
  log.steps[1].excluded = {{{1.0 / 3.0, 2.5}, {7.0, 9.0}}};
  log.steps[1].excluded_legs = 4;
  log.steps[1].could_be = {catalogue_effect("body tilt")};
  log.steps[2].kind = WorkbenchStep::Kind::remove;
  log.steps[2].effect = "hard iron";
  log.steps[2].from = 1;
  log.steps[2].label = "without \"it\"";
  log.steps[2].model = log.steps[0].model;
  log.at = 2;
  return log;
}

std::string fault_of(const std::filesystem::path& file,
                     const std::vector<DrivenRecording>& recordings) {
  try {
    static_cast<void>(read_workbench_log(file, recordings));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(WorkbenchLog, ReadsBackExactly) {
  const ScratchFolder scratch;
  const std::vector<DrivenRecording> recordings = riddle();
  const WorkbenchLog log = some_log();
  const std::string text = format_workbench_log(log, recordings);
  const WorkbenchLog read = read_workbench_log(scratch.write("steps.json", text), recordings);
  EXPECT_EQ(read.at, 2U);
  ASSERT_EQ(read.steps.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(read.steps[k].kind, log.steps[k].kind);
    EXPECT_EQ(read.steps[k].effect, log.steps[k].effect);
    EXPECT_EQ(read.steps[k].from, log.steps[k].from);
    EXPECT_EQ(read.steps[k].label, log.steps[k].label);
    EXPECT_EQ(read.steps[k].arrival_rms, log.steps[k].arrival_rms);
    EXPECT_EQ(read.steps[k].expected_rms, log.steps[k].expected_rms);
    EXPECT_EQ(read.steps[k].predicted_rms, log.steps[k].predicted_rms);
    EXPECT_EQ(read.steps[k].chi2, log.steps[k].chi2);
    EXPECT_EQ(read.steps[k].dof, log.steps[k].dof);
    EXPECT_EQ(read.steps[k].excluded_legs, log.steps[k].excluded_legs);
    ASSERT_EQ(read.steps[k].excluded.size(), log.steps[k].excluded.size());
    EXPECT_EQ(format_model(read.steps[k].model), format_model(log.steps[k].model));
  }
  EXPECT_EQ(read.steps[1].excluded[0][0].from, 1.0 / 3.0);
  EXPECT_EQ(format_workbench_log(read, recordings), text);
}

TEST(WorkbenchLog, OfOtherRecordingsIsRefused) {
  const ScratchFolder scratch;
  std::vector<DrivenRecording> recordings = riddle();
  const auto file = scratch.write("steps.json", format_workbench_log(some_log(), recordings));
  recordings.front().drive.pair.left.front() += 1e-9;
  EXPECT_NE(fault_of(file, recordings).find("other recordings"), std::string::npos);
}

TEST(WorkbenchLog, WhatIsNoLogIsRefusedInOneLine) {
  const ScratchFolder scratch;
  const std::vector<DrivenRecording> recordings = riddle();
  nlohmann::ordered_json log =
      nlohmann::ordered_json::parse(format_workbench_log(some_log(), recordings));
  const auto with = [&](const char* pointer, const nlohmann::ordered_json& value) {
    nlohmann::ordered_json changed = log;
    changed[nlohmann::ordered_json::json_pointer(pointer)] = value;
    return fault_of(scratch.write("steps.json", changed.dump()), recordings);
  };
  for (const std::string& fault :
       {fault_of(scratch.write("steps.json", "{"), recordings),
        fault_of(scratch.write("steps.json", "[]"), recordings), with("/format", "another"),
        with("/at", 3), with("/at", -1), with("/steps/1/from", 1), with("/steps/1/kind", "sing"),
        with("/steps/2/model", "[robot"), with("/steps/0/dof", "many"), with("/steps/0/label", 5),
        with("/steps/1/excluded", nlohmann::ordered_json::parse("[[], [[1, 2]]]")),
        with("/steps/1/excluded", "all"), with("/steps", nlohmann::ordered_json::array())}) {
    EXPECT_NE(fault.find("steps.json"), std::string::npos) << fault;
    EXPECT_EQ(fault.find('\n'), std::string::npos) << fault;
  }
  EXPECT_EQ(with("/at", 1), "");
}

}  // namespace
}  // namespace trussmap::workbench_log_test
