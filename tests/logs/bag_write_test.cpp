// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Bags that we write, read by tests/logs/bags/mcap_reader.py: a reader of its own, in another
// language, that decodes messages by the definitions in the file and checks every checksum, count
// and offset. What it has read is compared with what went in.
#include "logs/bag_builder.hpp"
#include "logs/cdr_write.hpp"
#include "logs/mcap_write.hpp"
#include "scratch_folder.hpp"
#include "trussmap/error.hpp"
#include "trussmap/log_files.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::bag_write_test {
using namespace logs;
namespace {

using nlohmann::json;
using testing::ScratchFolder;

std::string python(const std::string& arguments, int& status) {
  FILE* pipe = ::popen(("/usr/bin/python3 " + arguments + " 2>&1").c_str(), "r");
  std::string output;
  if (pipe == nullptr) return output;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    output.append(buffer.data(), count);
  }
  const int ended = ::pclose(pipe);
  status = WIFEXITED(ended) ? WEXITSTATUS(ended) : -1;
  return output;
}

bool has_python() {
  int status = -1;
  static_cast<void>(python("-c 'import zstandard'", status));
  return status == 0;
}

/// What the reader says of the bytes.
std::string read_by_python(const std::string& bytes, int& status) {
  const ScratchFolder scratch;
  const auto file = scratch.write("a.mcap", bytes);
  return python(TRUSSMAP_SOURCE_DIR "/tests/logs/bags/mcap_reader.py " + file.string(), status);
}

/// Its JSON, with its messages by topic as well.
struct ReadBag {
  json file;
  std::map<std::string, std::vector<json>> topics;

  explicit ReadBag(const Bag& bag) {
    int status = -1;
    const std::string output = read_by_python(bag.bytes, status);
    EXPECT_EQ(status, 0) << output;
    if (status != 0) return;
    file = json::parse(output);
    std::uint64_t before = 0;
    for (const json& one : file["messages"]) {
      EXPECT_GE(one["log_time"], before);
      before = one["log_time"];
      EXPECT_EQ(one["log_time"], one["publish_time"]);
      if (one["value"].contains("header")) {
        EXPECT_EQ(stamp_of(one["value"]["header"]), one["log_time"].get<std::int64_t>());
      }
      std::vector<json>& topic = topics[one["topic"]];
      EXPECT_EQ(one["sequence"], topic.size());
      topic.push_back(one);
    }
    std::map<std::string, std::size_t> counts;
    for (const auto& [name, messages] : topics) counts[name] = messages.size();
    std::map<std::string, std::size_t> told;
    for (const Bag::Topic& one : bag.topics) {
      told[one.name] = one.messages;
      EXPECT_EQ(file["channels"][one.name], one.type);
    }
    EXPECT_EQ(counts, told);
  }

  static std::int64_t stamp_of(const json& header) {
    return header["stamp"]["sec"].get<std::int64_t>() * 1000000000 +
           header["stamp"]["nanosec"].get<std::int64_t>();
  }
};

double yaw_of(const json& rotation) {
  EXPECT_EQ(rotation["x"], 0.0);
  EXPECT_EQ(rotation["y"], 0.0);
  return 2.0 * std::atan2(rotation["z"].get<double>(), rotation["w"].get<double>());
}

/// A drive with everything that a recording may have, drawn from a seed; times in milliseconds.
Recording full_recording(std::uint64_t seed, std::size_t rows = 40) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Recording recording;
  recording.name = "full";
  Drive& drive = recording.drive;
  std::vector<double> load;
  for (std::size_t row = 0; row < rows; ++row) {
    drive.t.push_back(static_cast<double>(125 * (row + 1)) / 1000.0);
    drive.left.push_back(0.05 + 0.04 * unit(random));
    drive.right.push_back(0.05 + 0.04 * unit(random));
    drive.heading.push_back(row % 3 == 0 ? kAbsent : 3.0 * unit(random));
    drive.yaw_rate.push_back(row % 4 == 1 || row == 3 ? kAbsent : unit(random));
    load.push_back(unit(random));
  }
  drive.covariates.push_back({"load__kg", load});
  recording.sightings = {{0.0, "tag36h11:5", kAbsent, kAbsent},
                         {0.5, "5", 2.0, -0.7, 1.25},
                         {0.5, "post \"B\"", 3.5, 2.0},
                         {0.75, "radio 1", 12.25, kAbsent},
                         {1.0, "radio_1", 7.5, kAbsent},
                         {1.0, "church", kAbsent, 0.3},
                         {1.5, "tag36h11:5", kAbsent, kAbsent, 0.5, 0.01, 0.02}};
  recording.survey = {{"5", 1.0, 2.0}};
  recording.truth = {{-0.75, 1.0, 2.0, 3.0}, {1.25, -1.0, 0.5, -2.0}};
  recording.fixes = {{0.375, 100.125, -7.5, 0.5, 4.0}, {0.5, 101.0, -8.0}};
  recording.loops = {{0.5, 2.0, 0.1, 0.2, 0.3}};
  return recording;
}

class BagWriting : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_python()) GTEST_SKIP() << "needs python3-zstandard";
  }
};

TEST_F(BagWriting, WheelsTurnByTheirTravels) {
  const Recording recording = full_recording(1);
  BagOptions options;
  options.wheel_radius = 0.0375;
  const ReadBag read(format_recording_bag(recording, {}, options));
  EXPECT_EQ(read.file["profile"], "ros2");
  const std::vector<json>& states = read.topics.at("/joint_states");
  const Drive& drive = recording.drive;
  ASSERT_EQ(states.size(), drive.rows() + 1);
  double left = 0.0;
  double right = 0.0;
  for (std::size_t k = 0; k < states.size(); ++k) {
    const json& value = states[k]["value"];
    EXPECT_EQ(value["name"], (json{"left_wheel", "right_wheel"}));
    // The truth begins 0.75 s before t = 0: the bag's t = 0 is a second later.
    EXPECT_EQ(states[k]["log_time"], 1000000000 + 125000000 * static_cast<std::int64_t>(k));
    if (k > 0) {
      left += drive.left[k - 1];
      right += drive.right[k - 1];
    }
    EXPECT_NEAR(value["position"][0].get<double>() * 0.0375, left, 1e-15 * static_cast<double>(k));
    EXPECT_NEAR(value["position"][1].get<double>() * 0.0375, right, 1e-15 * static_cast<double>(k));
    EXPECT_TRUE(value["velocity"].empty());
    EXPECT_TRUE(value["effort"].empty());
  }
}

/// Against arcs summed up here, without compass and gyro.
TEST_F(BagWriting, OdometryIsTheWheelsSummedUp) {
  Recording recording = full_recording(2);
  recording.drive.heading.clear();
  recording.drive.yaw_rate.clear();
  Model model;
  model.robot.wheelbase = 0.5;
  model.effects.push_back({"scale", Channel::travel, {"1"}, {0.5}});  // nominal: it does not count
  const ReadBag read(format_recording_bag(recording, model));
  const std::vector<json>& odometry = read.topics.at("/odom");
  const Drive& drive = recording.drive;
  ASSERT_EQ(odometry.size(), drive.rows() + 1);
  const std::vector<TimedPose> poses = dead_reckoned_poses(recording, {model.robot, {}, {}});
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
  for (std::size_t k = 0; k < odometry.size(); ++k) {
    const json& value = odometry[k]["value"];
    EXPECT_EQ(value["header"]["frame_id"], "odom");
    EXPECT_EQ(value["child_frame_id"], "base_link");
    const json& twist = value["twist"]["twist"];
    if (k > 0) {
      const double way = 0.5 * (drive.left[k - 1] + drive.right[k - 1]);
      const double turn = (drive.right[k - 1] - drive.left[k - 1]) / 0.5;
      const double chord = way * (std::sin(0.5 * turn) / (0.5 * turn));
      x += chord * std::cos(heading + 0.5 * turn);
      y += chord * std::sin(heading + 0.5 * turn);
      heading += turn;
      EXPECT_NEAR(twist["linear"]["x"], way / 0.125, 1e-12);
      EXPECT_NEAR(twist["angular"]["z"], turn / 0.125, 1e-12);
      // Chong & Kleeman: the variance of the turn is (k^2 |L| + k^2 |R|)/B^2.
      const double travel = std::abs(drive.left[k - 1]) + std::abs(drive.right[k - 1]);
      const double variance = std::pow(0.003, 2) * travel / std::pow(0.5 * 0.125, 2);
      EXPECT_NEAR(value["twist"]["covariance"][35], variance, 1e-9 * variance);
    } else {
      EXPECT_EQ(twist["linear"]["x"], 0.0);
      EXPECT_EQ(value["twist"]["covariance"][35], 1e6);
    }
    const json& pose = value["pose"]["pose"];
    EXPECT_NEAR(pose["position"]["x"], x, 1e-12);
    EXPECT_NEAR(pose["position"]["y"], y, 1e-12);
    EXPECT_EQ(pose["position"]["z"], 0.0);
    EXPECT_NEAR(wrap_angle(yaw_of(pose["orientation"]) - heading), 0.0, 1e-12);
    const std::vector<double> C = value["pose"]["covariance"];
    const Matrix3& planar = poses[k].estimate.covariance;
    ASSERT_EQ(C.size(), 36U);
    EXPECT_EQ(C[0], planar(0, 0));
    EXPECT_EQ(C[1], planar(0, 1));
    EXPECT_EQ(C[6], planar(1, 0));
    EXPECT_EQ(C[5], planar(0, 2));
    EXPECT_EQ(C[11], planar(1, 2));
    EXPECT_EQ(C[35], planar(2, 2));
    for (const std::size_t unknown : {14U, 21U, 28U}) EXPECT_EQ(C[unknown], 1e6);
    for (const std::size_t none : {2U, 8U, 22U, 33U}) EXPECT_EQ(C[none], 0.0);
  }
}

TEST_F(BagWriting, CompassAndGyroStandWhereTheyWereRead) {
  const Recording recording = full_recording(3);
  const ReadBag read(format_recording_bag(recording, {}));
  const Drive& drive = recording.drive;
  std::size_t next = 0;
  const std::vector<json>& messages = read.topics.at("/imu/data");
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    const bool compass = !std::isnan(drive.heading[row]);
    const bool gyro = !std::isnan(drive.yaw_rate[row]);
    if (!compass && !gyro) continue;
    ASSERT_LT(next, messages.size());
    const json& value = messages[next++]["value"];
    EXPECT_EQ(value["header"]["frame_id"], "base_link");
    EXPECT_EQ(value["linear_acceleration_covariance"][0], -1.0);
    EXPECT_EQ(value["orientation_covariance"][0], compass ? 1e6 : -1.0);
    EXPECT_EQ(value["angular_velocity_covariance"][0], gyro ? 1e6 : -1.0);
    if (compass) {
      EXPECT_NEAR(yaw_of(value["orientation"]), drive.heading[row], 1e-14);
      EXPECT_EQ(value["orientation_covariance"][8], 0.02 * 0.02);
    }
    if (gyro) {
      EXPECT_EQ(value["angular_velocity"]["z"], drive.yaw_rate[row]);
      EXPECT_NEAR(value["angular_velocity_covariance"][8], 0.001 * 0.001 / 0.125, 1e-18);
    }
  }
  EXPECT_EQ(next, messages.size());
}

TEST_F(BagWriting, SightingsGoWhereTheyHaveAMessage) {
  const Recording recording = full_recording(4);
  const Bag bag = format_recording_bag(recording, {});
  const ReadBag read(bag);
  const std::vector<json>& stood = read.topics.at("/landmark");
  ASSERT_EQ(stood.size(), 2U);
  EXPECT_EQ(stood[0]["value"]["data"], "tag36h11:5");
  EXPECT_EQ(stood[0]["log_time"], 1000000000);

  const std::vector<json>& transforms = read.topics.at("/tf");
  ASSERT_EQ(transforms.size(), 1U);  // of one time
  const json& seen = transforms[0]["value"]["transforms"];
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_EQ(transforms[0]["log_time"], ReadBag::stamp_of(seen[1]["header"]));
  EXPECT_EQ(seen[0]["header"]["frame_id"], "base_link");
  EXPECT_EQ(seen[0]["child_frame_id"], "5");
  EXPECT_NEAR(seen[0]["transform"]["translation"]["x"], 2.0 * std::cos(0.7), 1e-15);
  EXPECT_NEAR(seen[0]["transform"]["translation"]["y"], -2.0 * std::sin(0.7), 1e-15);
  EXPECT_NEAR(yaw_of(seen[0]["transform"]["rotation"]), 1.25, 1e-15);
  EXPECT_EQ(seen[1]["child_frame_id"], "post \"B\"");
  EXPECT_EQ(yaw_of(seen[1]["transform"]["rotation"]), 0.0);

  // ROS would call both radios the same.
  const json& first = read.topics.at("/range/radio_1")[0]["value"];
  EXPECT_EQ(first["header"]["frame_id"], "radio 1");
  EXPECT_EQ(first["range"], 12.25);
  EXPECT_NEAR(first["variance"], 0.05 * 0.05, 1e-9);
  const json& second = read.topics.at("/range/radio_1_2")[0]["value"];
  EXPECT_EQ(second["header"]["frame_id"], "radio_1");
  EXPECT_EQ(second["range"], 7.5);

  std::map<std::string, std::size_t> left_out;
  for (const Bag::LeftOut& one : bag.left_out) left_out[one.what] = one.count;
  const std::map<std::string, std::size_t> expected = {
      {"bearings alone", 1},
      {"yaws of landmarks that were not seen by range and bearing", 1},
      {"loops", 1},
      {"surveyed landmarks", 1},
      {"standard deviations or qualities of fixes", 1}};
  EXPECT_EQ(left_out, expected);
}

TEST_F(BagWriting, FixesTruthAndCovariatesAreExact) {
  const Recording recording = full_recording(5);
  const ReadBag read(format_recording_bag(recording, {}));
  const std::vector<json>& fixes = read.topics.at("/fix");
  ASSERT_EQ(fixes.size(), 2U);
  EXPECT_EQ(fixes[0]["value"]["header"]["frame_id"], "map");
  EXPECT_EQ(fixes[0]["value"]["point"], (json{{"x", 100.125}, {"y", -7.5}, {"z", 0.0}}));
  EXPECT_EQ(fixes[0]["log_time"], 1375000000);
  const std::vector<json>& truth = read.topics.at("/truth");
  ASSERT_EQ(truth.size(), 2U);
  EXPECT_EQ(truth[0]["log_time"], 250000000);
  EXPECT_EQ(truth[1]["value"]["pose"]["position"]["x"], -1.0);
  EXPECT_NEAR(yaw_of(truth[1]["value"]["pose"]["orientation"]), -2.0, 1e-15);
  const std::vector<json>& load = read.topics.at("/covariates/load_kg");
  ASSERT_EQ(load.size(), recording.drive.rows());
  for (std::size_t row = 0; row < load.size(); ++row) {
    EXPECT_EQ(load[row]["value"]["data"], recording.drive.covariates[0].values[row]);
  }
}

TEST_F(BagWriting, OtherDrivesHaveTheirOwnJoints) {
  Recording recording = full_recording(6);
  recording.drive.left.clear();
  recording.drive.right.clear();
  std::vector<double> travel(recording.drive.rows(), 0.0625);
  std::vector<double> steering;
  for (std::size_t row = 0; row < travel.size(); ++row) {
    steering.push_back(0.01 * static_cast<double>(row) - 0.2);
  }
  recording.drive.covariates.push_back({"front", travel});
  recording.drive.covariates.push_back({"steer", steering});
  Model model;
  model.robot.drive = DriveKind::tricycle;
  model.robot.length = 1.5;
  model.robot.columns = {"front", "steer"};
  const ReadBag read(format_recording_bag(recording, model));
  const std::vector<json>& states = read.topics.at("/joint_states");
  EXPECT_EQ(states[0]["value"]["name"], (json{"front", "steer"}));
  EXPECT_EQ(states[0]["value"]["position"], (json{0.0, -0.2}));
  EXPECT_EQ(states[3]["value"]["position"], (json{3.0 * 0.0625 / 0.05, steering[2]}));
  EXPECT_FALSE(read.topics.contains("/covariates/front"));
  EXPECT_FALSE(read.topics.contains("/covariates/steer"));
  EXPECT_TRUE(read.topics.contains("/covariates/load_kg"));
  // f = w cos b, a = w sin b/length
  const json& twist = read.topics.at("/odom")[1]["value"]["twist"]["twist"];
  EXPECT_NEAR(twist["linear"]["x"], 0.0625 * std::cos(-0.2) / 0.125, 1e-12);
  EXPECT_NEAR(twist["angular"]["z"], 0.0625 * std::sin(-0.2) / 1.5 / 0.125, 1e-12);
}

TEST_F(BagWriting, LongDrivesAreCutIntoChunks) {
  const Recording recording = full_recording(7, 4000);
  const Bag bag = format_recording_bag(recording, {});
  const ReadBag read(bag);
  EXPECT_GT(read.file["chunks"], 3);
  EXPECT_EQ(read.file["compression"], json{"zstd"});
  EXPECT_EQ(format_recording_bag(recording, {}).bytes, bag.bytes);
}

TEST_F(BagWriting, CorrectedOdometryIsThePoses) {
  std::vector<TimedPose> poses;
  for (int k = 0; k < 3; ++k) {
    TimedPose one;
    one.t = 10.0 + 0.5 * k;
    one.estimate.pose = {1.0 * k, 0.0, 0.5 * std::numbers::pi * k};
    one.estimate.covariance.diagonal() << 0.01 * k, 0.02, 0.03;
    poses.push_back(one);
  }
  BagOptions options;
  options.epoch = 1700000000123456789;
  options.robot_frame = "base_footprint";
  const ReadBag read(format_odometry_bag(poses, true, options));
  const std::vector<json>& messages = read.topics.at("/odometry/corrected");
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(messages[1]["log_time"], 1700000010623456789);
  const json& value = messages[2]["value"];
  EXPECT_EQ(value["header"]["frame_id"], "map");
  EXPECT_EQ(value["child_frame_id"], "base_footprint");
  EXPECT_EQ(value["pose"]["pose"]["position"]["x"], 2.0);
  EXPECT_EQ(value["pose"]["covariance"][0], 0.02);
  EXPECT_EQ(value["pose"]["covariance"][35], 0.03);
  // From (1, 0), facing +y, to (2, 0): a metre to the right in half a second.
  EXPECT_NEAR(value["twist"]["twist"]["linear"]["x"], 0.0, 1e-15);
  EXPECT_NEAR(value["twist"]["twist"]["linear"]["y"], -2.0, 1e-15);
  EXPECT_NEAR(value["twist"]["twist"]["angular"]["z"], std::numbers::pi, 1e-12);
  EXPECT_EQ(value["twist"]["covariance"][0], 1e6);
  const ReadBag odometry(format_odometry_bag(poses, false));
  EXPECT_EQ(odometry.topics.at("/odometry/corrected")[0]["value"]["header"]["frame_id"], "odom");
}

TEST_F(BagWriting, DefinitionsComeWithAllTheirParts) {
  const ReadBag read(format_recording_bag(full_recording(8), {}));
  const std::string odometry = read.file["schemas"]["nav_msgs/msg/Odometry"];
  for (const char* part :
       {"std_msgs/Header", "builtin_interfaces/Time", "geometry_msgs/PoseWithCovariance",
        "geometry_msgs/Pose", "geometry_msgs/Point", "geometry_msgs/Quaternion",
        "geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist", "geometry_msgs/Vector3"}) {
    const std::string title = std::string(80, '=') + "\nMSG: " + part + "\n";
    EXPECT_NE(odometry.find(title), std::string::npos) << part;
  }
}

/// The reader would notice.
TEST_F(BagWriting, WrongBytesAreFound) {
  const std::string good = format_recording_bag(full_recording(9), {}).bytes;
  std::mt19937_64 random(9);
  std::uniform_int_distribution<std::size_t> place(8, good.size() - 9);
  int status = -1;
  for (int k = 0; k < 20; ++k) {
    std::string bad = good;
    bad[place(random)] ^= 0x10;
    static_cast<void>(read_by_python(bad, status));
    EXPECT_EQ(status, 1);
  }
}

TEST(BagTimes, AreThoseOfRos) {
  std::vector<TimedPose> poses(1);
  poses[0].t = -3.25;
  EXPECT_EQ(format_odometry_bag(poses, true).epoch, 4000000000);
  BagOptions options;
  options.epoch = 0;
  EXPECT_THROW(static_cast<void>(format_odometry_bag(poses, true, options)), InputError);
  for (const double t : {2147483648.0, 1e300, kAbsent}) {
    poses[0].t = t;
    EXPECT_THROW(static_cast<void>(format_odometry_bag(poses, true)), InputError) << t;
  }
  poses[0].t = 2147483647.5;
  EXPECT_NO_THROW(static_cast<void>(format_odometry_bag(poses, true)));
  EXPECT_THROW(static_cast<void>(format_odometry_bag({}, true)), std::invalid_argument);
  poses.push_back(poses[0]);
  EXPECT_THROW(static_cast<void>(format_odometry_bag(poses, true)), std::invalid_argument);
}

TEST(BagTopics, HaveNamesThatRosAllows) {
  EXPECT_EQ(topic_token("tag36h11:5"), "tag36h11_5");
  EXPECT_EQ(topic_token("5"), "landmark_5");
  EXPECT_EQ(topic_token("__a--b__"), "a_b");
  EXPECT_EQ(topic_token("\xc3\xa4"), "landmark");
}

/// The specification's own words: alignment counts from behind the encapsulation.
TEST(Cdr, NumbersStandAtMultiplesOfTheirSize) {
  const std::string bytes = CdrWriter()
                                .number(std::uint8_t{7})
                                .number(std::uint16_t{0x0102})
                                .number(1.0)
                                .text("a")
                                .bytes();
  const std::string expected("\0\1\0\0\x07\0\x02\x01\0\0\0\0\0\0\0\0\0\0\xf0\x3f\2\0\0\0a\0", 26);
  EXPECT_EQ(bytes, expected);
}

}  // namespace
}  // namespace trussmap::bag_write_test
