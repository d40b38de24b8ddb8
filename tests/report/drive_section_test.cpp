// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "other_drives.hpp"
#include "report/page.hpp"
#include "trussmap/pages.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace trussmap::drive_section_test {
using namespace report;
namespace {

using testing::other_drive;
using testing::OtherDrive;
using testing::recorded;

Page some_page() {
  PageContent content;
  content.verdict = "good";
  content.sections = {{"Legs", {std::string("a text")}}, {"Tables", {PageTable()}}};
  return content;
}

std::vector<std::string> titles_of(const Page& page) {
  std::vector<std::string> titles;
  for (const PageSection& section : page.content().sections) titles.push_back(section.title);
  return titles;
}

TEST(DrivePage, ShowsOtherWheelsThanTwoBeforeTheTables) {
  const OtherDrive drive = other_drive(DriveKind::ackermann);
  const DrivenRecording recording = with_wheels(recorded(drive, drive.wheels), drive.model.robot);
  const Page page = with_drive(some_page(), drive.model.robot, {recording});
  EXPECT_EQ(titles_of(page), (std::vector<std::string>{"Legs", "The robot's drive", "Tables"}));
  EXPECT_EQ(charts_of(page.content()).size(), 2U);  // wheels, steering
  const OtherDrive omni = other_drive(DriveKind::omni3);
  EXPECT_EQ(charts_of(with_drive(some_page(), omni.model.robot, {}).content()).size(), 1U);
}

TEST(DrivePage, IsAsBeforeOfTwoWheelsAndOfWheelsThatAreNowhere) {
  EXPECT_EQ(titles_of(with_drive(some_page(), Robot(), {})), titles_of(some_page()));
  Robot robot;
  robot.drive = DriveKind::wheels;
  robot.columns = {"a", "b"};
  robot.matrix = Eigen::MatrixXd::Ones(3, 2);
  EXPECT_EQ(titles_of(with_drive(some_page(), robot, {})), titles_of(some_page()));
}

}  // namespace
}  // namespace trussmap::drive_section_test
