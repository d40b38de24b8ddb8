// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Two runs of one robot, from what the commands wrote of them.
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/fleet.hpp"
#include "trussmap/write_files.hpp"

#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::run_contrast_test {
namespace {

using testing::ScratchFolder;

const FigureChange& named(const RunContrast& contrast, const std::string& name) {
  for (const FigureChange& one : contrast.figures) {
    if (one.name == name) return one;
  }
  throw std::out_of_range(name);
}

RunFigures read(const ScratchFolder& scratch, const std::string& json) {
  const std::filesystem::path file = scratch.path() / "run.json";
  write_file(file, json);
  return read_run_figures(file);
}

TEST(RunContrast, ReadsErrorsConstantsAndEffects) {
  const ScratchFolder scratch;
  const nlohmann::json held{{"legs", 8}, {"arrival_rms_m", 0.02}};
  const nlohmann::json whole{
      {"verdict", "consistent"},
      {"steps", {{{"chi2", 900}, {"dof", 100}}, {{"chi2", 120}, {"dof", 100}, {"heldout", held}}}},
      {"effects",
       {{{"effect", "hard iron"},
         {"shape", {"sin(heading)", "cos(heading)"}},
         {"coefficients", {0.04, -0.03}},
         {"sd", {0.001, nullptr}}}}},
      {"constants",
       {{{"name", "wheelbase"}, {"unit", "m"}, {"old", 0.34}, {"new", 0.33}, {"sd", 0.001}},
        {{"name", "left wheel"}, {"unit", "times"}, {"new", nullptr}, {"sd", nullptr}}}}};
  const RunFigures run = read(scratch, whole.dump());
  EXPECT_EQ(run.verdict, "consistent");
  ASSERT_EQ(run.figures.size(), 4U);  // what was not determined, or has no error, is none
  EXPECT_DOUBLE_EQ(run.figures[0].value, 1.2);
  EXPECT_DOUBLE_EQ(run.figures[1].value, 0.02);
  EXPECT_DOUBLE_EQ(run.figures[1].dof, 16.0);
  EXPECT_EQ(run.figures[2].name, "wheelbase");
  EXPECT_EQ(run.figures[3].name, "effect hard iron: sin(heading)");
}

TEST(RunContrast, RefusesWhatIsNoRun) {
  const ScratchFolder scratch;
  for (const char* text : {"", "[]", "{}", "{\"chi2\": 1", "{\"effects\": [{\"effect\": 3}]}"}) {
    EXPECT_THROW(static_cast<void>(read(scratch, text)), InputError) << text;
  }
  EXPECT_THROW(static_cast<void>(read_run_figures(scratch.path() / "none.json")), InputError);
}

/// Against quantiles from tables: F(10, 20) exceeds 2.774 with 2.5 %, a normal variable 1.96.
TEST(RunContrast, HasThePValuesOfTheTables) {
  const RunFigures before{"",
                          {{"chi2/dof", "", 1.0, 0.0, 20.0}, {"wheelbase", "m", 0.3, 0.003, 0}}};
  const RunFigures now{
      "", {{"chi2/dof", "", 2.774, 0.0, 10.0}, {"wheelbase", "m", 0.3 + 1.96 * 0.005, 0.004, 0}}};
  const RunContrast contrast = contrast_runs(before, now);
  EXPECT_NEAR(named(contrast, "chi2/dof").p_value.value(), 0.05, 1e-3);
  EXPECT_NEAR(named(contrast, "wheelbase").p_value.value(), 0.05, 1e-4);
  EXPECT_EQ(contrast.told(), 2U);
  EXPECT_FALSE(contrast.any_changed());  // two of them: 0.025 would be needed
  const RunContrast back = contrast_runs(now, before);
  EXPECT_NEAR(named(back, "chi2/dof").p_value.value(), 0.05, 1e-3);
}

TEST(RunContrast, ErrorsOfLegsAreComparedByTheirSquares) {
  const RunFigures before{"", {{"held-out legs end off", "m", 0.01, 0.0, 20.0}}};
  const RunFigures now{"", {{"held-out legs end off", "m", 0.01 * std::sqrt(2.774), 0.0, 10.0}}};
  EXPECT_NEAR(contrast_runs(before, now).figures.at(0).p_value.value(), 0.05, 1e-3);
}

TEST(RunContrast, WhatOneRunAloneTellsIsSaidAndNotJudged) {
  const RunFigures before{"", {{"wheelbase", "m", 0.3, 0.001, 0}, {"fix delay", "s", 0.1, 0, 0}}};
  const RunFigures now{"", {{"gyro bias", "rad/s", 0.01, 0.001, 0}, {"fix delay", "s", 0.2, 0, 0}}};
  const RunContrast contrast = contrast_runs(before, now);
  ASSERT_EQ(contrast.figures.size(), 3U);
  EXPECT_FALSE(named(contrast, "wheelbase").now);
  EXPECT_FALSE(named(contrast, "gyro bias").before);
  EXPECT_EQ(contrast.told(), 0U);
  EXPECT_FALSE(contrast.any_changed());
}

}  // namespace
}  // namespace trussmap::run_contrast_test
