// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "drive/well_formed.hpp"
#include "files/present.hpp"
#include "geometry/index.hpp"
#include "io/csv.hpp"
#include "io/recording_limits.hpp"
#include "io/recording_streams.hpp"
#include "recording/time_units.hpp"
#include "recording/variable_names.hpp"
#include "text/plain_text.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace trussmap {
using namespace io;

namespace {

namespace fs = std::filesystem;

/// What a covariate may not be called, besides the variables that every recording has: columns and
/// functions.
constexpr std::string_view kTaken[] = {"left", "right", "sin", "cos", "tan", "abs",
                                       "sign", "min",   "max", "exp", "log", "sqrt"};

bool is_reserved(std::string_view name) {
  const std::vector<std::string>& variables = recording::reserved_variables();
  return std::find(variables.begin(), variables.end(), name) != variables.end() ||
         std::find(std::begin(kTaken), std::end(kTaken), name) != std::end(kTaken);
}

/// A time [s]. What is beyond all clocks looks like the time since 1970 in another unit.
double time_in(const CsvReader& csv, int column) {
  constexpr double kFirst = 5e8;  // s since 1970: what clocks of robots show
  constexpr double kLast = 5e9;
  const double t = csv.number(column);
  if (std::abs(t) <= kLargestTime) return t;
  std::string looks;
  for (const recording::TimeUnit& one : recording::kTimeUnits) {
    const double seconds = t / one.per_second;
    if (seconds > kFirst && seconds < kLast) {
      looks = fmt::format(": it looks like {} since 1970, not seconds", one.name);
    }
  }
  csv.fail(fmt::format("column {} is \"{}\", expected a number of at most {} in size{}",
                       csv.columns()[idx(column)], csv.field(column), csv_number(kLargestTime),
                       looks));
}

bool is_name(std::string_view text) {
  const auto word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  return !text.empty() && std::isalpha(static_cast<unsigned char>(text.front())) != 0 &&
         std::all_of(text.begin(), text.end(), word);
}

/// Columns beyond the known ones are an error: a misspelt one must not be ignored in silence.
void refuse_other_columns(const CsvReader& csv, const std::vector<std::string_view>& known) {
  for (const std::string& name : csv.columns()) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    std::string expected;
    for (const std::string_view one : known) {
      expected += (expected.empty() ? "" : ",") + std::string(one);
    }
    csv.fail(fmt::format("column \"{}\" is unknown, expected {}", name, expected));
  }
}

std::string landmark_name(const CsvReader& csv, int column) {
  const std::string_view name = csv.field(column);
  if (name.empty()) csv.fail("column landmark is empty, expected a landmark's name");
  if (!text::is_plain_text(name)) {
    csv.fail("a landmark's name holds a control character, expected printable text in UTF-8");
  }
  return std::string(name);
}

void require_forward(const CsvReader& csv, double before, double now, bool may_repeat) {
  if (now > before || (may_repeat && now == before)) return;
  csv.fail(now == before
               ? "time " + csv_number(now) + " is repeated, expected a later time"
               : "time runs backwards from " + csv_number(before) + " to " + csv_number(now) +
                     ", expected " + (may_repeat ? "no earlier time" : "a later time"));
}

Drive drive_in(std::string_view text, const std::string& file) {
  CsvReader csv(text, file);
  const int t = csv.require("t");
  const int heading = csv.find("heading");
  const int yaw_rate = csv.find("yaw_rate");
  // Of other wheels than two the columns are the model's to name.
  const int known = 1 + (heading >= 0 ? 1 : 0) + (yaw_rate >= 0 ? 1 : 0);
  const bool others = csv.find("left") < 0 && csv.find("right") < 0 &&
                      static_cast<int>(csv.columns().size()) > known + 1;
  const int left = others ? -1 : csv.require("left");
  const int right = others ? -1 : csv.require("right");
  Drive drive;
  std::vector<int> covariate_columns;
  for (int column = 0; column < static_cast<int>(csv.columns().size()); ++column) {
    if (column == t || column == left || column == right || column == heading) continue;
    if (column == yaw_rate) continue;
    const std::string& name = csv.columns()[idx(column)];
    if (!is_name(name)) {
      csv.fail("column \"" + name +
               "\" cannot be a covariate, expected a letter, then letters, digits or _");
    }
    if (is_reserved(name)) {
      csv.fail("column \"" + name + "\" is a reserved name, expected another for a covariate");
    }
    drive.covariates.push_back({name, {}});
    covariate_columns.push_back(column);
  }
  while (csv.next()) {
    const double now = time_in(csv, t);
    if (!drive.t.empty()) require_forward(csv, drive.t.back(), now, false);
    drive.t.push_back(now);
    if (left >= 0) drive.left.push_back(csv.number(left, kLargestTravel));
    if (right >= 0) drive.right.push_back(csv.number(right, kLargestTravel));
    if (heading >= 0) drive.heading.push_back(csv.number_or_absent(heading, kLargestAngle));
    if (yaw_rate >= 0) drive.yaw_rate.push_back(csv.number_or_absent(yaw_rate, kLargestYawRate));
    for (std::size_t k = 0; k < covariate_columns.size(); ++k) {
      drive.covariates[k].values.push_back(csv.number(covariate_columns[k], kLargestCovariate));
    }
  }
  if (drive.rows() < 2) {
    throw InputError(file, csv.line(),
                     std::to_string(drive.rows()) + (drive.rows() == 1 ? " row" : " rows") +
                         ", expected two at least (the first interval is as long as the second)");
  }
  for (auto* column : {&drive.t, &drive.left, &drive.right, &drive.heading, &drive.yaw_rate}) {
    column->shrink_to_fit();
  }
  for (Covariate& one : drive.covariates) one.values.shrink_to_fit();
  return drive;
}

void require_inside(const CsvReader& csv, const Drive& drive, double t, const char* what) {
  const double slack = drive::clock_slack(drive);
  if (t >= drive.start() - slack && t <= drive.t.back() + slack) return;
  constexpr double kFarOut = 10.0;  // times the drive's length
  std::string looks;
  for (const recording::TimeUnit& one : recording::kTimeUnits) {
    const double seconds = t / one.per_second;
    const bool inside = seconds >= drive.start() && seconds <= drive.t.back();
    if (looks.empty() && inside &&
        t > drive.t.back() + kFarOut * (drive.t.back() - drive.start())) {
      looks = fmt::format(": is it in {}?", one.name);
    }
  }
  csv.fail(std::string(what) + csv_number(t) + " is outside the drive, expected " +
           csv_number(drive.start()) + " to " + csv_number(drive.t.back()) + looks);
}

double sd_or_absent(const CsvReader& csv, int column, double largest, const char* name) {
  if (column < 0) return kAbsent;
  const double sd = csv.number_or_absent(column, largest);
  if (sd <= 0.0) csv.fail(std::string(name) + " is " + csv_number(sd) + ", expected more than 0");
  return sd;
}

std::vector<Sighting> sightings_in(std::string_view text, const std::string& file,
                                   const Drive& drive, bool may_lack) {
  CsvReader csv(text, file);
  const int t = csv.require("t");
  const int landmark = csv.require("landmark");
  const int range = csv.find("range");
  const int bearing = csv.find("bearing");
  const int yaw = csv.find("yaw");
  const int dx = csv.find("dx");
  const int dy = csv.find("dy");
  refuse_other_columns(csv, {"t", "landmark", "range", "bearing", "yaw", "dx", "dy"});
  std::vector<Sighting> sightings;
  while (csv.next()) {
    Sighting sighting;
    sighting.t = time_in(csv, t);
    sighting.landmark = landmark_name(csv, landmark);
    if (range >= 0) {
      sighting.range = csv.number_or_absent(range, kLargestRange);
    }
    if (bearing >= 0) sighting.bearing = csv.number_or_absent(bearing, kLargestAngle);
    if (yaw >= 0) sighting.yaw = csv.number_or_absent(yaw, kLargestAngle);
    if (dx >= 0) sighting.dx = csv.number_or_absent(dx, kLargestRange);
    if (dy >= 0) sighting.dy = csv.number_or_absent(dy, kLargestRange);
    if (std::isnan(sighting.dx) != std::isnan(sighting.dy)) {
      csv.fail("dx or dy stands alone, expected both or neither");
    }
    if (!std::isnan(sighting.dx) && (!sighting.standing() || std::isnan(sighting.yaw))) {
      csv.fail(
          "dx and dy are of a robot that stands on its landmark and reads its yaw, expected "
          "a yaw and neither range nor bearing beside them");
    }
    if (sighting.range < 0.0) csv.fail("the range is negative, expected 0 or more");
    require_inside(csv, drive, sighting.t, "time ");
    if (!sightings.empty()) require_forward(csv, sightings.back().t, sighting.t, true);
    sightings.push_back(std::move(sighting));
  }
  if (sightings.empty()) {
    throw InputError(file, csv.line(),
                     may_lack ? "no sighting, expected one row at least; beside a truth.csv, "
                                "fixes.csv or loops.csv the file may be left out"
                              : "no sighting, expected one row at least");
  }
  return sightings;
}

std::vector<SurveyPoint> survey_in(std::string_view text, const std::string& file) {
  CsvReader csv(text, file);
  const int landmark = csv.require("landmark");
  const int x = csv.require("x");
  const int y = csv.require("y");
  const int sd = csv.find("sd");
  const int heading = csv.find("heading");
  refuse_other_columns(csv, {"landmark", "x", "y", "sd", "heading"});
  std::vector<SurveyPoint> survey;
  std::set<std::string> names;
  while (csv.next()) {
    SurveyPoint point;
    point.landmark = landmark_name(csv, landmark);
    point.x = csv.number(x, kLargestPosition);
    point.y = csv.number(y, kLargestPosition);
    if (sd >= 0) point.sd = csv.number_or_absent(sd, kLargestPosition);
    if (heading >= 0) point.heading = csv.number_or_absent(heading, kLargestAngle);
    if (point.sd <= 0.0) csv.fail("sd is " + csv_number(point.sd) + ", expected more than 0");
    if (!names.insert(point.landmark).second) {
      csv.fail("landmark " + point.landmark + " is surveyed twice, expected each once");
    }
    survey.push_back(std::move(point));
  }
  if (survey.empty()) {
    throw InputError(file, csv.line(), "no landmark, expected one row at least");
  }
  return survey;
}

std::vector<TruthRow> truth_in(std::string_view text, const std::string& file) {
  CsvReader csv(text, file);
  const int t = csv.require("t");
  const int x = csv.require("x");
  const int y = csv.require("y");
  const int heading = csv.require("heading");
  refuse_other_columns(csv, {"t", "x", "y", "heading"});
  std::vector<TruthRow> truth;
  while (csv.next()) {
    const TruthRow row{time_in(csv, t), csv.number(x, kLargestPosition),
                       csv.number(y, kLargestPosition), csv.number(heading, kLargestAngle)};
    if (!truth.empty()) require_forward(csv, truth.back().t, row.t, false);
    truth.push_back(row);
  }
  if (truth.empty()) {
    throw InputError(file, csv.line(), "no pose, expected one row at least");
  }
  return truth;
}

std::vector<Fix> fixes_in(std::string_view text, const std::string& file) {
  CsvReader csv(text, file);
  const int t = csv.require("t");
  const int x = csv.require("x");
  const int y = csv.require("y");
  const int sd = csv.find("sd");
  const int quality = csv.find("quality");
  refuse_other_columns(csv, {"t", "x", "y", "sd", "quality"});
  std::vector<Fix> fixes;
  while (csv.next()) {
    Fix fix;
    fix.t = time_in(csv, t);
    fix.x = csv.number(x, kLargestPosition);
    fix.y = csv.number(y, kLargestPosition);
    fix.sd = sd_or_absent(csv, sd, kLargestPosition, "sd");
    if (quality >= 0) fix.quality = csv.number_or_absent(quality, kLargestCovariate);
    if (!fixes.empty()) require_forward(csv, fixes.back().t, fix.t, false);
    fixes.push_back(fix);
  }
  if (fixes.empty()) {
    throw InputError(file, csv.line(), "no fix, expected one row at least");
  }
  return fixes;
}

std::vector<Loop> loops_in(std::string_view text, const std::string& file, const Drive& drive) {
  CsvReader csv(text, file);
  const int t = csv.require("t");
  const int t2 = csv.require("t2");
  const int dx = csv.require("dx");
  const int dy = csv.require("dy");
  const int dtheta = csv.require("dtheta");
  const int sd = csv.find("sd");
  const int sd_heading = csv.find("sd_heading");
  refuse_other_columns(csv, {"t", "t2", "dx", "dy", "dtheta", "sd", "sd_heading"});
  std::vector<Loop> loops;
  while (csv.next()) {
    Loop loop;
    loop.t = time_in(csv, t);
    loop.t2 = time_in(csv, t2);
    loop.dx = csv.number(dx, kLargestPosition);
    loop.dy = csv.number(dy, kLargestPosition);
    loop.dtheta = csv.number(dtheta, kLargestAngle);
    loop.sd = sd_or_absent(csv, sd, kLargestPosition, "sd");
    loop.sd_heading = sd_or_absent(csv, sd_heading, kLargestAngle, "sd_heading");
    require_inside(csv, drive, loop.t, "time t ");
    require_inside(csv, drive, loop.t2, "time t2 ");
    if (loop.t == loop.t2) {
      csv.fail("t2 is t, " + csv_number(loop.t) + ", expected another time");
    }
    loops.push_back(loop);
  }
  if (loops.empty()) {
    throw InputError(file, csv.line(), "no loop, expected one row at least");
  }
  return loops;
}

/// Where a recording's streams are, by name.
struct Streams {
  std::function<bool(const char* name)> has;
  std::function<std::string(const char* name)> text;
};

/// `folder` stands for the recording in messages.
Recording recording_of(const fs::path& folder, const Streams& streams, bool drive_alone) {
  const auto& has = streams.has;
  const auto& text = streams.text;
  const auto file = [&](const char* name) { return (folder / name).string(); };
  if (!has("drive.csv")) {
    throw InputError(file("drive.csv"), 0, "is missing, a recording needs it");
  }
  const bool may_lack = has("truth.csv") || has("fixes.csv") || has("loops.csv");
  if (!has("sightings.csv") && !may_lack && !drive_alone) {
    throw InputError(file("sightings.csv"), 0,
                     "is missing, a recording without truth.csv, fixes.csv or loops.csv needs it");
  }
  Recording recording;
  recording.name = folder.string();
  Drive& drive = recording.drive;
  drive = drive_in(text("drive.csv"), file("drive.csv"));
  if (has("sightings.csv")) {
    recording.sightings =
        sightings_in(text("sightings.csv"), file("sightings.csv"), drive, may_lack);
  }
  if (has("survey.csv")) recording.survey = survey_in(text("survey.csv"), file("survey.csv"));
  if (has("truth.csv")) recording.truth = truth_in(text("truth.csv"), file("truth.csv"));
  if (has("fixes.csv")) recording.fixes = fixes_in(text("fixes.csv"), file("fixes.csv"));
  if (has("loops.csv")) recording.loops = loops_in(text("loops.csv"), file("loops.csv"), drive);
  return recording;
}

}  // namespace

bool is_covariate_name(std::string_view name) {
  return is_name(name) && !is_reserved(name);
}

}  // namespace trussmap

namespace trussmap::io {

std::vector<SurveyPoint> read_survey(const fs::path& file) {
  return survey_in(read_file(file), file.string());
}

}  // namespace trussmap::io

namespace trussmap {

Recording read_recording(const fs::path& folder, bool drive_alone) {
  std::error_code ignored;
  if (!files::is_present(folder)) {
    throw InputError(folder.string(), 0, "there is no such folder, expected a recording");
  }
  if (!fs::is_directory(folder, ignored)) {
    throw InputError(folder.string(), 0, "is a file, expected a recording's folder");
  }
  const Streams streams{[&](const char* name) { return files::is_present(folder / name); },
                        [&](const char* name) { return read_file(folder / name); }};
  return recording_of(folder, streams, drive_alone);
}

}  // namespace trussmap

namespace trussmap::io {

Recording recording_in(const NamedTexts& files, bool drive_alone) {
  const auto find = [&](const char* name) {
    return std::find_if(files.begin(), files.end(),
                        [&](const auto& file) { return file.first == name; });
  };
  const Streams streams{[&](const char* name) { return find(name) != files.end(); },
                        [&](const char* name) { return find(name)->second; }};
  return recording_of("", streams, drive_alone);
}

}  // namespace trussmap::io
