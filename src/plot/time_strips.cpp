// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "plot/time_strips.hpp"

#include "drive/elapsed_time.hpp"
#include "recording/time_spans.hpp"
#include "wording/channel_words.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace trussmap::plot {
namespace {

constexpr double kPoints = 600.0;  // in all
constexpr std::size_t kMostStrips = 5;

/// A value of a row with how long the row took; none where there is nothing to show.
using RowValue = std::function<double(const MotionRows& drive, std::size_t row)>;
using RowValues = std::function<std::optional<RowValue>(const DrivenRecording&)>;

struct Strip {
  std::vector<double> t;
  std::vector<double> value;
};

Strip strip_of(const std::vector<DrivenRecording>& recordings, const RowValues& values) {
  const std::vector<double> shifts = drive::elapsed_shifts(recordings);
  const MotionRows& last = recordings.back().drive;
  const double whole = last.rows() > 0 ? last.t.back() + shifts.back() : shifts.back();
  const double share = std::max(whole / kPoints, 1e-9);
  Strip strip;
  for (std::size_t s = 0; s < recordings.size(); ++s) {
    const DrivenRecording& recording = recordings[s];
    const MotionRows& drive = recording.drive;
    const std::optional<RowValue> value = values(recording);
    double sum = 0.0, time = 0.0;
    for (std::size_t row = 0; value && row < drive.rows(); ++row) {
      const double duration = drive.duration(row);
      sum += (*value)(drive, row) * duration;
      time += duration;
      if (time < share && row + 1 < drive.rows()) continue;
      strip.t.push_back(drive.t[row] + shifts[s] - 0.5 * time);
      strip.value.push_back(time > 0.0 ? sum / time : 0.0);
      sum = time = 0.0;
    }
    if (drive.rows() == 0) continue;
    strip.t.push_back(drive.t.back() + shifts[s]);
    strip.value.push_back(kAbsent);
  }
  return strip;
}

/// Over the strip's whole height.
ChartLayer band_over(const std::vector<TimeSpan>& spans, const std::string& name,
                     const std::string& colour, const Strip& strip) {
  double least = 0.0, most = 0.0;
  for (const double value : strip.value) {
    if (std::isnan(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  ChartLayer band{LayerKind::band, name, {{"", {}}, {"", {}}, {"", {}}}};
  band.colour = colour;
  const auto add = [&band](double t, double low, double high) {
    band.columns[0].numbers.push_back(t);
    band.columns[1].numbers.push_back(low);
    band.columns[2].numbers.push_back(high);
  };
  for (const TimeSpan& span : spans) {
    add(span.from, least, most);
    add(span.to, least, most);
    add(span.to, kAbsent, kAbsent);
  }
  return band;
}

Chart chart_of(const std::string& id, const std::string& title, Strip strip,
               const MarkedTimes& marked) {
  Chart chart;
  chart.id = id;
  chart.title = title;
  chart.caption = "In time, sessions one after the other.";
  chart.x.title = "t [s]";
  chart.height = 70.0;
  if (!marked.chosen.empty()) {
    chart.layers.push_back(band_over(recording::merged(marked.chosen), "chosen", "2", strip));
  }
  if (!marked.excluded.empty()) {
    chart.layers.push_back(
        band_over(recording::merged(marked.excluded), "excluded", "muted", strip));
  }
  ChartLayer line{
      LayerKind::line, "", {{"t [s]", std::move(strip.t)}, {title, std::move(strip.value)}}};
  line.size = 1.2;
  chart.layers.push_back(std::move(line));
  return chart;
}

bool varies(const Strip& strip) {
  double least = 1e300, most = -1e300;
  for (const double value : strip.value) {
    if (std::isnan(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return most > least;
}

std::optional<std::size_t> place_of(const DrivenRecording& recording,
                                    const std::string& covariate) {
  const auto& all = recording.drive.covariates;
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Covariate& one) { return one.name == covariate; });
  if (found == all.end()) return std::nullopt;
  return static_cast<std::size_t>(found - all.begin());
}

}  // namespace

std::vector<Chart> time_strips(const std::vector<DrivenRecording>& recordings,
                               const MarkedTimes& marked) {
  std::vector<Chart> strips;
  if (recordings.empty()) return strips;
  const auto speed = [](const MotionRows& drive, std::size_t row) {
    return drive.forward[row] / drive.duration(row);
  };
  strips.push_back(chart_of(
      "strip-speed", "speed [m/s]",
      strip_of(recordings, [&speed](const DrivenRecording&) { return RowValue(speed); }), marked));
  for (const Covariate& one : recordings.front().drive.covariates) {
    if (strips.size() == kMostStrips) break;
    const bool everywhere =
        std::all_of(recordings.begin(), recordings.end(), [&one](const DrivenRecording& recording) {
          return place_of(recording, one.name).has_value();
        });
    if (!everywhere) continue;
    Strip strip = strip_of(recordings, [&one](const DrivenRecording& recording) {
      const std::vector<double>& values =
          recording.drive.covariates[*place_of(recording, one.name)].values;
      return RowValue([&values](const MotionRows&, std::size_t row) { return values[row]; });
    });
    if (!varies(strip)) continue;
    strips.push_back(chart_of("strip-" + std::to_string(strips.size()),
                              wording::variable_in_words(one.name), std::move(strip), marked));
  }
  return strips;
}

}  // namespace trussmap::plot
