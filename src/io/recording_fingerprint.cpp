// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "text/fnv_hash.hpp"
#include "text/number_text.hpp"
#include "trussmap/recording_files.hpp"

#include <string_view>

namespace trussmap {
namespace {

/// Against the same file given twice, not against a forger.
class Hash {
 public:
  void take(std::string_view text) {
    hash_.take(text);
    hash_.take(std::string_view("\0", 1));  // so that texts do not run together
  }
  void take(const std::vector<double>& numbers) {
    for (const double number : numbers) take(text::shortest_text(number));
    take("");
  }

  [[nodiscard]] std::string digits() const { return hash_.digits(); }

 private:
  text::FnvHash hash_;
};

void take(const Observations& recording, Hash& hash) {
  for (const Sighting& one : recording.sightings) {
    hash.take(one.landmark);
    hash.take({one.t, one.range, one.bearing});
  }
  for (const Fix& one : recording.fixes) hash.take({one.t, one.x, one.y, one.sd});
  for (const Loop& one : recording.loops) {
    hash.take({one.t, one.t2, one.dx, one.dy, one.dtheta, one.sd, one.sd_heading});
  }
}

}  // namespace

std::string fingerprint(const Recording& recording) {
  Hash hash;
  const Drive& drive = recording.drive;
  hash.take(drive.t);
  hash.take(drive.left);
  hash.take(drive.right);
  hash.take(drive.heading);
  if (drive.has_gyro()) hash.take(drive.yaw_rate);
  take(recording, hash);
  return hash.digits();
}

std::string fingerprint(const DrivenRecording& recording) {
  Hash hash;
  const MotionRows& drive = recording.drive;
  hash.take(drive.t);
  if (drive.wheels.empty()) {
    const bool two = drive.of_two_wheels();
    hash.take(two ? drive.pair.left : drive.forward);
    hash.take(two ? drive.pair.right : drive.turn);
  }
  hash.take(drive.heading);
  for (const WheelColumn& one : drive.wheels) hash.take(one.reading);
  if (drive.has_gyro()) hash.take(drive.yaw_rate);
  take(recording, hash);
  return hash.digits();
}

}  // namespace trussmap
