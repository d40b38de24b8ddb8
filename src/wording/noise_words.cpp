// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/wording.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap {
namespace {

bool begins_with(const std::string& text, const char* start) {
  return text.rfind(start, 0) == 0;
}

bool lasts(const std::string& source) {
  return source.find(", ") != std::string::npos;
}

/// What the source makes, and what would measure it.
struct Remedy {
  const char* error;
  const char* help;
};

Remedy remedy_of(const std::string& source, bool gyro) {
  const char* better = gyro ? "a better gyro would help most" : "a gyro would help most";
  if (source == "wheels") {
    return {"what the wheels misread from metre to metre", better};
  }
  if (begins_with(source, "gyro")) return {"the gyro's error", better};
  for (const char* turning : {"heading_per_s", "heading_per_rad", "turn", "drift", "difference",
                              "left", "right", "rotate"}) {
    if (begins_with(source, turning)) return {"turning error", better};
  }
  if (begins_with(source, "creep")) {
    return {"slip to the side", "a sensor that sees the floor would help most"};
  }
  return {"travel error",
          "a wheel that carries no load, or a sensor that sees the floor, would "
          "help most"};
}

std::string duration_of(const std::string& source) {
  if (!lasts(source)) return "";
  if (source.find("per leg") != std::string::npos) return " that stays for a leg";
  if (source.find("per session") != std::string::npos) return " that stays for a recording";
  if (source.find("white") != std::string::npos) return "";
  return " that lasts";
}

/// How long a process lasts.
std::string lasting_of(const NoiseProcess& process) {
  switch (process.process) {
    case ProcessKind::correlated_in_t:
      return fmt::format("that last for {:.2g} s", process.length);
    case ProcessKind::correlated_in_distance:
      return fmt::format("that last for {:.2g} m", process.length);
    case ProcessKind::per_leg:
      return "that stay for a leg";
    case ProcessKind::per_session:
      return "that stay for a recording";
    case ProcessKind::per_pass:
      return "that stay as long as a landmark is in view";
    case ProcessKind::walk_in_t:
    case ProcessKind::walk_in_distance:
      return "that add up";
    case ProcessKind::white:
      break;
  }
  return "besides";
}

std::string changed_in_words(const NoiseSource& source) {
  constexpr double kSame = 1.05;  // of an amount that two digits tell apart
  if (source.lasts && source.process.channel == Channel::compass &&
      source.process.process == ProcessKind::walk_in_t) {
    return "compass errors that only grow: it looks like a heading integrated from a gyro, whose "
           "rate belongs in a column yaw_rate";
  }
  if (source.lasts) {
    return fmt::format("{} errors {}", name_of(source.process.channel), lasting_of(source.process));
  }
  if (source.stated == 0.0) return source.name + " besides";
  const double times = source.sd / source.stated;
  if (times < kSame && times > 1.0 / kSame) return "";
  if (times < 0.1) return source.name + " far less than is stated";
  return fmt::format("{} {:.2g} times what is stated", source.name, times);
}

}  // namespace

std::string in_words(const FittedNoise& noise) {
  std::string text;
  for (const NoiseSource& one : noise.sources) {
    const std::string own = noise.changed() ? changed_in_words(one) : "";
    if (!own.empty()) text += (text.empty() ? "" : "; ") + own;
  }
  return text;
}

std::string in_words(const NoiseBudget& budget) {
  if (budget.shares.empty()) return "";
  const NoiseShare& most = budget.shares.front();
  const Remedy remedy = remedy_of(most.source, budget.gyro);
  const std::string when =
      budget.horizon == 0.0 ? "at a leg's end" : fmt::format("after {:g} s", budget.horizon);
  return fmt::format("{} {:.0f} % is {}{}; {}", when, 100.0 * most.share, remedy.error,
                     duration_of(most.source), remedy.help);
}

}  // namespace trussmap
