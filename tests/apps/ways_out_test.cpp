// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What commands write for other programs, as a user meets it: bags, trajectories, maps as YAML.
#include "scratch_folder.hpp"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

namespace trussmap::ways_out_test {
namespace {

using testing::Ran;
using testing::run_trussmap;
using testing::ScratchFolder;

std::ptrdiff_t count_lines(const std::string& text) {
  return std::count(text.begin(), text.end(), '\n');
}

class WaysOut : public ::testing::Test {
 protected:
  void SetUp() override {
    const Ran ran = run_trussmap(
        "simulate --mesh 3x3 --tours 1 --seed 1 --range-sensor --markers "
        "--out " +
        at("rec"));
    ASSERT_EQ(ran.status, 0) << ran.output;
  }

  [[nodiscard]] std::string at(const std::string& name) const {
    return (scratch_.path() / name).string();
  }
  [[nodiscard]] std::string content(const std::string& name) const {
    return scratch_.contents()[name];
  }

  ScratchFolder scratch_;
};

TEST_F(WaysOut, ARecordingBecomesABag) {
  const Ran ran = run_trussmap("convert " + at("rec") + " " + at("a.mcap"));
  ASSERT_EQ(ran.status, 0) << ran.output;
  for (const char* part : {"/joint_states (sensor_msgs/msg/JointState)", "/odom (nav_msgs",
                           "/imu/data (", "/tf (tf2_msgs/msg/TFMessage)", "/landmark (std_msgs",
                           "9 surveyed landmarks left out", "--map FILE"}) {
    EXPECT_NE(ran.output.find(part), std::string::npos) << part << "\n" << ran.output;
  }
  const std::string bag = content("a.mcap");
  EXPECT_EQ(bag.substr(0, 8), "\x89MCAP0\r\n");
  EXPECT_EQ(run_trussmap("convert " + at("rec") + " " + at("b.mcap")).status, 0);
  EXPECT_EQ(content("b.mcap"), bag);
  const std::string to_map = " --map " + at("map.toml");
  const Ran mapped = run_trussmap("convert " + at("rec") + " " + at("b.mcap") + to_map);
  EXPECT_NE(mapped.output.find("Read it back"), std::string::npos) << mapped.output;
  const Ran back = run_trussmap("convert " + at("b.mcap") + " " + at("again") + to_map);
  EXPECT_EQ(back.status, 0) << back.output;
  EXPECT_EQ(count_lines(content("again/drive.csv")), count_lines(content("rec/drive.csv")) + 1);
  EXPECT_EQ(count_lines(content("again/sightings.csv")), count_lines(content("rec/sightings.csv")));
  // Told where its recording began, it is another one; without a model it says so.
  std::filesystem::remove(at("rec") + "/model.toml");
  const Ran later =
      run_trussmap("convert " + at("rec") + " " + at("b.mcap") + " --epoch 1700000000.5");
  EXPECT_EQ(later.status, 0);
  EXPECT_NE(later.output.find("t = 0 is 1700000000.500000000 s"), std::string::npos);
  EXPECT_NE(later.output.find("no model.toml"), std::string::npos) << later.output;
  EXPECT_NE(content("b.mcap"), bag);
  EXPECT_EQ(run_trussmap("convert " + at("rec") + " " + at("c.mcap") + " --epoch -1").status, 2);
  EXPECT_EQ(run_trussmap("convert " + at("rec") + " " + at("c.mcap") + " --wheel-radius 0").status,
            2);
  EXPECT_FALSE(std::filesystem::exists(at("c.mcap")));
}

TEST_F(WaysOut, PosesBecomeABagAndAKittiTrajectory) {
  const std::string apply = "apply " + at("rec") + " --model " + at("rec/model.toml");
  const Ran ran =
      run_trussmap(apply + " --mcap " + at("o.mcap") + " --kitti " + at("o.txt") + " --adjusted");
  ASSERT_EQ(ran.status, 0) << ran.output;
  EXPECT_NE(ran.output.find("o.mcap"), std::string::npos) << ran.output;
  EXPECT_EQ(content("o.mcap").substr(0, 8), "\x89MCAP0\r\n");
  const std::string lines = content("o.txt");
  const std::string first = lines.substr(0, lines.find('\n'));
  EXPECT_EQ(std::count(first.begin(), first.end(), ' '), 11);
  EXPECT_EQ(run_trussmap(apply).status, 2);
  EXPECT_EQ(run_trussmap(apply + " --epoch 1 --tum " + at("t.txt")).status, 2);
}

TEST_F(WaysOut, PosesSayWhichEffectsTheyAreWithout) {
  const std::string open = " " + at("open.toml");
  ASSERT_EQ(run_trussmap("add " + at("rec/model.toml") + " 'slip with speed' --out" + open).status,
            0);
  const std::string apply = "apply " + at("rec") + " --out " + at("p.csv") + " --model";
  const std::string warning = "warning: effect slip with speed has no coefficients yet: left out";
  for (const char* how : {"", " --adjusted"}) {
    const Ran ran = run_trussmap(apply + open + how);
    EXPECT_EQ(ran.output.rfind(warning, 0), 0U) << ran.output;
    const Ran sound = run_trussmap(apply + " " + at("rec/model.toml") + how);
    EXPECT_EQ(sound.output.find("no coefficients"), std::string::npos) << sound.output;
  }
}

TEST_F(WaysOut, AMapBecomesYaml) {
  const Ran built = run_trussmap("build " + at("rec") + " --model " + at("rec/model.toml") +
                                 " --out " + at("m.graphml"));
  ASSERT_EQ(built.status, 0) << built.output;
  const std::string convert = "convert " + at("m.graphml") + " " + at("m.yaml");
  const Ran plain = run_trussmap(convert);
  EXPECT_EQ(plain.status, 0) << plain.output;
  // L0_1 and L1_1 end in the same number.
  EXPECT_NE(plain.output.find("without an id: L0_0"), std::string::npos) << plain.output;
  EXPECT_NE(content("m.yaml").find("frame_id: \"map\""), std::string::npos);
  const Ran sizeless = run_trussmap(convert + " --layout apriltag");
  EXPECT_EQ(sizeless.status, 2);
  EXPECT_NE(sizeless.output.find("--tag-size"), std::string::npos) << sizeless.output;
  EXPECT_EQ(run_trussmap(convert + " --layout apriltag --tag-size 0.1").status, 2);
  EXPECT_EQ(run_trussmap(convert + " --layout other").status, 2);
  EXPECT_EQ(run_trussmap("convert " + at("m.graphml") + " " + at("m.dot") + " --tag-size 1").status,
            2);
}

}  // namespace
}  // namespace trussmap::ways_out_test
