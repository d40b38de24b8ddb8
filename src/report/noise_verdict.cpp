// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "report/noise_verdict.hpp"

#include "report/page_words.hpp"
#include "report/robot_off.hpp"
#include "trussmap/table.hpp"
#include "wording/channel_words.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace trussmap::report {

bool is_wrong(const NoiseSource& source) {
  if (!(source.stated > 0.0)) return source.sd > 0.0;
  return source.sd > kNoiseAsStated * source.stated || kNoiseAsStated * source.sd < source.stated;
}

bool is_wrong(const FittedNoise& noise) {
  return noise.changed() && std::any_of(noise.sources.begin(), noise.sources.end(),
                                        [](const NoiseSource& source) { return is_wrong(source); });
}

bool noise_is_wrong(const Diagnosis& diagnosis) {
  return diagnosis.under != nullptr && is_wrong(diagnosis.under->noise);
}

namespace {

/// "5.9 mm after a metre", "2.3°".
struct NoiseUnit {
  double factor = 1.0;
  std::string name;
};

NoiseUnit unit_of(const NoiseSource& source) {
  if (source.unit == "m^1/2") return {1000.0, " mm after a metre"};
  const wording::ShownUnit unit = wording::shown_unit(source.unit);
  return {unit.factor, unit.name.starts_with("\u00b0") ? unit.name : " " + unit.name};
}

}  // namespace

std::string found_and_stated(const FittedNoise& noise) {
  std::vector<std::string> texts;
  for (const NoiseSource& one : noise.sources) {
    if (!is_wrong(one)) continue;
    const NoiseUnit unit = unit_of(one);
    const QuantityText found = quantity_text(unit.factor * one.sd, unit.factor * one.sd_error);
    const std::string size = found.error.empty()
                                 ? two_digits(unit.factor * one.sd)
                                 : fmt::format("{} \u00b1 {}", found.value, found.error);
    texts.push_back(one.stated > 0.0
                        ? fmt::format("{} {}{}, not {} as stated", one.name, size, unit.name,
                                      two_digits(unit.factor * one.stated))
                        : fmt::format("{} {}{}, not stated at all", one.name, size, unit.name));
  }
  return listed(texts);
}

std::string noise_gain(const DiagnosisEvidence& evidence) {
  if (!evidence.as_stated || evidence.as_stated->legs.empty()) return "";
  const HeldOut& stated = *evidence.as_stated;
  const HeldOut& found = evidence.given.comparison.held_out;
  const double most = std::max(stated.arrival_rms, found.arrival_rms);
  return fmt::format(
      "What the noise found gains: legs end {} off, and {} is expected of them; by the noise "
      "stated they ended {} off, and {} was expected.",
      distance_text(found.arrival_rms, most), distance_text(found.expected_rms, most),
      distance_text(stated.arrival_rms, most), distance_text(stated.expected_rms, most));
}

std::string noisier_than_stated(const Comparison& comparison) {
  constexpr double kClear = 3.0;  // standard errors
  std::vector<std::string> noisy;
  for (const SourceCalibration& one : comparison.sources) {
    if (one.factor - 1.0 > kClear * one.sd && one.factor > kNoiseAsStated) {
      noisy.push_back(fmt::format("{} {} \u00b1 {} times", one.source, two_digits(one.factor),
                                  two_digits(one.sd)));
    }
  }
  return listed(noisy);
}

}  // namespace trussmap::report
