// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Encoders of a tricycle's steered and driven front wheel under a tracker (G. Grisetti, Sapienza
// University of Rome: data of the course Probabilistic Robotics) as a recording.
//
//   #kinematic_model: traction_drive_wheel
//   #parameter_values: Ksteer Ktraction axis_length steer_offset     m, rad
//   #joints_max_enc_values: counts per turn of the steering, of the wheel
//   # translation: [x, y, z], # rotation: [quaternion]               of the tracked sensor
//   time: T ticks: S D model_pose: X Y TH tracker_pose: X Y TH       s, ticks, m, rad
//
// The steering stands at Ksteer 2 pi S/counts + steer_offset (S beyond half a turn counts back),
// the wheel travels Ktraction D/counts. D is an unsigned counter of 32 bits that begins again at 0,
// and comes late by a sample or two: five samples make a row. The truth is the robot's, by where
// the sensor is stated to be. The parameters are first guesses, off by factors: calibrate finds
// them.
#include "datasets/formats.hpp"
#include "datasets/number_rows.hpp"
#include "io/recording_limits.hpp"
#include "trussmap/error.hpp"
#include "trussmap/planar.hpp"
#include "trussmap/write_files.hpp"

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

namespace trussmap::datasets {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kKind = "#kinematic_model:";
constexpr double kTurnOfCounter = 4294967296.0;  // ticks, unsigned 32 bit
constexpr std::size_t kJoined = 5;               // samples in a row

/// Finite numbers after a key, up to the next word; commas and brackets are passed over.
std::optional<std::vector<double>> numbers_after(std::string_view line, std::string_view key) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return std::nullopt;
  std::vector<double> numbers;
  std::string_view rest = line.substr(at + key.size());
  for (;;) {
    const std::size_t start = rest.find_first_not_of(" \t\r[],");
    if (start == std::string_view::npos) return numbers;
    rest.remove_prefix(start);
    double value = 0.0;
    const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    if (status != std::errc() || !std::isfinite(value)) return numbers;
    numbers.push_back(value);
    rest.remove_prefix(static_cast<std::size_t>(end - rest.data()));
  }
}

struct Header {
  double steer_per_turn = 0.0;   ///< rad at the wheel for a radian of its encoder
  double metres_per_turn = 0.0;  ///< of the driven wheel's encoder
  double length = 0.0;           ///< m
  double steer_offset = 0.0;     ///< rad
  double steer_counts = 0.0;     ///< a turn of the encoder
  double drive_counts = 0.0;
  Pose sensor;  ///< in the robot's axes
};

struct Sample {
  double t = 0.0;      ///< s
  double steer = 0.0;  ///< rad
  double drive = 0.0;  ///< ticks
  Pose tracked;
  std::size_t line = 0;
};

class LogReader {
 public:
  explicit LogReader(const fs::path& file) : file_(file) {}

  void read() {
    std::istringstream lines(read_file(file_));
    for (std::string line; std::getline(lines, line);) {
      ++line_;
      if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
      if (line.front() == '#') {
        take_header(line);
      } else {
        take_sample(line);
      }
    }
    if (samples.size() <= 2 * kJoined) {
      fail(0, "has fewer than " + std::to_string(2 * kJoined + 1) + " samples, expected a drive");
    }
  }

  Header header;
  std::vector<Sample> samples;

 private:
  [[noreturn]] void fail(std::size_t line, const std::string& what) const {
    throw InputError(file_.string(), line, what);
  }

  std::vector<double> expect(const std::string& line, std::string_view key, std::size_t count) {
    const auto numbers = numbers_after(line, key);
    if (!numbers || numbers->size() != count) {
      fail(line_, std::string(key) + " has " + std::to_string(numbers ? numbers->size() : 0) +
                      " numbers, expected " + std::to_string(count));
    }
    return *numbers;
  }

  void take_header(const std::string& line) {
    if (line.starts_with(kKind) && line.find("traction_drive_wheel") == std::string::npos) {
      fail(line_, "the kinematic model is another one, expected traction_drive_wheel");
    }
    if (line.find("#parameter_values:") == 0) {
      const std::vector<double> values = expect(line, "#parameter_values:", 4);
      if (!(values[2] > 0.0)) fail(line_, "the axis length is not positive, expected metres");
      header.steer_per_turn = values[0];
      header.metres_per_turn = values[1];
      header.length = values[2];
      header.steer_offset = values[3];
    } else if (line.find("#joints_max_enc_values:") == 0) {
      const std::vector<double> values = expect(line, "#joints_max_enc_values:", 2);
      if (!(values[0] > 0.0) || !(values[1] > 0.0)) {
        fail(line_, "counts per turn are not positive, expected those of both encoders");
      }
      header.steer_counts = values[0];
      header.drive_counts = values[1];
    } else if (line.find("translation:") != std::string::npos) {
      const std::vector<double> values = expect(line, "translation:", 3);
      header.sensor.x = values[0];
      header.sensor.y = values[1];
    } else if (line.find("rotation:") != std::string::npos) {
      const std::vector<double> values = expect(line, "rotation:", 4);
      header.sensor.heading = 2.0 * std::atan2(values[2], values[3]);
    }
  }

  void take_sample(const std::string& line) {
    if (!(header.length > 0.0) || !(header.steer_counts > 0.0)) {
      fail(line_, "a sample before #parameter_values and #joints_max_enc_values, expected these");
    }
    const std::vector<double> time = expect(line, "time:", 1);
    const std::vector<double> ticks = expect(line, "ticks:", 2);
    const std::vector<double> tracked = expect(line, "tracker_pose:", 3);
    if (!samples.empty() && !(time[0] > samples.back().t)) {
      fail(line_, "time runs backwards, expected samples in order of time");
    }
    for (const double one : ticks) {
      if (one < 0.0 || one >= kTurnOfCounter || one != std::floor(one)) {
        fail(line_, "a count is no unsigned number of 32 bits, expected one");
      }
    }
    if (ticks[0] >= header.steer_counts) {
      fail(line_, "the steering's count exceeds its turn, expected less than " +
                      std::to_string(static_cast<long>(header.steer_counts)));
    }
    const double turn = ticks[0] / header.steer_counts;
    const double signed_turn = turn > 0.5 ? turn - 1.0 : turn;
    samples.push_back(
        {time[0],
         header.steer_per_turn * 2.0 * std::numbers::pi * signed_turn + header.steer_offset,
         ticks[1],
         {tracked[0], tracked[1], tracked[2]},
         line_});
  }

  fs::path file_;
  std::size_t line_ = 0;
};

/// The counter begins again at 0.
double ticks_between(double before, double after) {
  return std::remainder(after - before, kTurnOfCounter);
}

/// Where the robot is, by where its sensor is tracked.
TruthRow truth_of(const Sample& sample, const Pose& sensor, double epoch) {
  const double heading = sample.tracked.heading - sensor.heading;
  const Vector2 place = sample.tracked.position() - rotation(heading) * sensor.position();
  return {since(epoch, sample.t), place.x(), place.y(), wrap_angle(heading)};
}

}  // namespace

bool is_encoder_log(const fs::path& file) {
  const std::string name = file.filename().string();
  if (!name.ends_with(".txt") && !name.ends_with(".txt.xz")) return false;
  if (!fs::is_regular_file(file)) return false;
  return read_file(file).starts_with(kKind);
}

Dataset read_encoder_log(const fs::path& file) {
  LogReader log(file);
  log.read();
  const Header& header = log.header;
  Dataset result;
  result.epoch = log.samples.front().t;
  Model& model = result.model;
  model.robot.drive = DriveKind::tricycle;
  model.robot.length = header.length;
  model.robot.columns = {"wheel", "steer"};
  model.noise.left = model.noise.right = 0.03;
  model.noise.steer = 0.01;
  model.noise.truth = 0.004;
  model.noise.truth_heading = 0.002;
  Recording& recording = result.recording;
  recording.name = file.string();
  recording.drive.covariates = {{"wheel", {}}, {"steer", {}}};
  double travelled = 0.0;  // ticks of the row
  double steered = 0.0;    // rad s
  std::size_t first = 0;
  for (std::size_t k = 1; k < log.samples.size(); ++k) {
    const Sample& before = log.samples[k - 1];
    const Sample& now = log.samples[k];
    travelled += ticks_between(before.drive, now.drive);
    steered += 0.5 * (before.steer + now.steer) * (now.t - before.t);
    if (k - first < kJoined) continue;
    recording.drive.t.push_back(since(result.epoch, now.t));
    recording.drive.covariates[0].values.push_back(travelled / header.drive_counts *
                                                   header.metres_per_turn);
    recording.drive.covariates[1].values.push_back(steered / (now.t - log.samples[first].t));
    recording.truth.push_back(truth_of(now, header.sensor, result.epoch));
    const io::SourceLine source(recording.name, now.line);
    source.expect_last_row(recording.drive);
    source.expect(recording.truth.back());
    travelled = steered = 0.0;
    first = k;
  }
  result.comment = fmt::format("t = 0 is {:.3f} s, Unix time", result.epoch);
  result.figures = {
      counted("samples", log.samples.size(), "samples, of which five make one of the"),
      counted("rows", recording.drive.rows(), "drive rows, each with the truth")};
  return result;
}

}  // namespace trussmap::datasets
