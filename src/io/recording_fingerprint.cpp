// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "text/number_text.hpp"
#include "trussmap/recording_files.hpp"

#include <cstdint>
#include <string_view>

namespace trussmap {
namespace {

/// FNV-1a, 64 bits: against the same file given twice, not against a forger.
class Hash {
 public:
  void take(std::string_view text) {
    for (const char c : text) take_byte(static_cast<unsigned char>(c));
    take_byte(0);
  }
  void take(const std::vector<double>& numbers) {
    for (const double number : numbers) take(shortest_text(number));
    take("");
  }

  [[nodiscard]] std::string digits() const {
    std::string result;
    for (int shift = 60; shift >= 0; shift -= 4)
      result += "0123456789abcdef"[(state_ >> shift) & 15U];
    return result;
  }

 private:
  void take_byte(unsigned char byte) { state_ = (state_ ^ byte) * 0x100000001b3U; }

  std::uint64_t state_ = 0xcbf29ce484222325U;
};

}  // namespace

std::string fingerprint(const Recording& recording) {
  Hash hash;
  const Drive& drive = recording.drive;
  hash.take(drive.t);
  if (drive.wheels.empty()) {
    hash.take(drive.left);
    hash.take(drive.right);
  }
  hash.take(drive.heading);
  for (const WheelColumn& one : drive.wheels) hash.take(one.reading);
  if (drive.has_gyro()) hash.take(drive.yaw_rate);
  for (const Sighting& one : recording.sightings) {
    hash.take(one.landmark);
    hash.take({one.t, one.range, one.bearing});
  }
  for (const Fix& one : recording.fixes) hash.take({one.t, one.x, one.y, one.sd});
  for (const Loop& one : recording.loops) {
    hash.take({one.t, one.t2, one.dx, one.dy, one.dtheta, one.sd, one.sd_heading});
  }
  return hash.digits();
}

}  // namespace trussmap
