// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "io/csv.hpp"
#include "io/model_toml.hpp"
#include "io/recording_streams.hpp"
#include "trussmap/error.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/write_files.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace trussmap {
using namespace io;

namespace {

namespace fs = std::filesystem;

std::string drive_text(const Drive& drive, const std::string& comment) {
  std::string text;
  for (std::size_t at = 0; at < comment.size();) {
    const std::size_t end = std::min(comment.find('\n', at), comment.size());
    text += "# " + comment.substr(at, end - at) + '\n';
    at = end + 1;
  }
  const bool two = !drive.left.empty();
  text += two ? "t,left,right" : "t";
  if (drive.has_compass()) text += ",heading";
  if (drive.has_gyro()) text += ",yaw_rate";
  for (const Covariate& covariate : drive.covariates) text += ',' + covariate.name;
  text += '\n';
  for (std::size_t row = 0; row < drive.rows(); ++row) {
    text += csv_number(drive.t[row]);
    if (two) {
      text += ',' + csv_number(drive.left[row]) + ',' + csv_number(drive.right[row]);
    }
    if (drive.has_compass()) text += ',' + csv_number(drive.heading[row]);
    if (drive.has_gyro()) text += ',' + csv_number(drive.yaw_rate[row]);
    for (const Covariate& covariate : drive.covariates) {
      text += ',' + csv_number(covariate.values[row]);
    }
    text += '\n';
  }
  return text;
}

std::string sightings_text(const std::vector<Sighting>& sightings) {
  const bool ranges = std::any_of(sightings.begin(), sightings.end(),
                                  [](const Sighting& one) { return !one.standing(); });
  const bool yaws = std::any_of(sightings.begin(), sightings.end(),
                                [](const Sighting& one) { return !std::isnan(one.yaw); });
  const bool codes = std::any_of(sightings.begin(), sightings.end(),
                                 [](const Sighting& one) { return !std::isnan(one.dx); });
  std::string text = "t,landmark";
  text += ranges ? ",range,bearing" : "";
  text += yaws ? ",yaw" : "";
  text += codes ? ",dx,dy\n" : "\n";
  for (const Sighting& sighting : sightings) {
    text += csv_number(sighting.t) + ',' + csv_field(sighting.landmark);
    if (ranges) text += ',' + csv_number(sighting.range) + ',' + csv_number(sighting.bearing);
    if (yaws) text += ',' + csv_number(sighting.yaw);
    if (codes) text += ',' + csv_number(sighting.dx) + ',' + csv_number(sighting.dy);
    text += '\n';
  }
  return text;
}

std::string survey_text(const std::vector<SurveyPoint>& survey) {
  const bool sds = std::any_of(survey.begin(), survey.end(),
                               [](const SurveyPoint& point) { return !std::isnan(point.sd); });
  const bool headings = std::any_of(survey.begin(), survey.end(), [](const SurveyPoint& point) {
    return !std::isnan(point.heading);
  });
  std::string text = "landmark,x,y";
  text += sds ? ",sd" : "";
  text += headings ? ",heading\n" : "\n";
  for (const SurveyPoint& point : survey) {
    text += csv_field(point.landmark) + ',' + csv_number(point.x) + ',' + csv_number(point.y);
    if (sds) text += ',' + csv_number(point.sd);
    if (headings) text += ',' + csv_number(point.heading);
    text += '\n';
  }
  return text;
}

std::string truth_text(const std::vector<TruthRow>& truth) {
  std::string text = "t,x,y,heading\n";
  for (const TruthRow& row : truth) {
    text += csv_number(row.t) + ',' + csv_number(row.x) + ',' + csv_number(row.y) + ',' +
            csv_number(row.heading) + '\n';
  }
  return text;
}

std::string fixes_text(const std::vector<Fix>& fixes) {
  const bool sds =
      std::any_of(fixes.begin(), fixes.end(), [](const Fix& fix) { return !std::isnan(fix.sd); });
  const bool qualities = std::any_of(fixes.begin(), fixes.end(),
                                     [](const Fix& fix) { return !std::isnan(fix.quality); });
  std::string text =
      std::string("t,x,y") + (sds ? ",sd" : "") + (qualities ? ",quality" : "") + '\n';
  for (const Fix& fix : fixes) {
    text += csv_number(fix.t) + ',' + csv_number(fix.x) + ',' + csv_number(fix.y);
    if (sds) text += ',' + csv_number(fix.sd);
    if (qualities) text += ',' + csv_number(fix.quality);
    text += '\n';
  }
  return text;
}

std::string loops_text(const std::vector<Loop>& loops) {
  const bool sds = std::any_of(loops.begin(), loops.end(), [](const Loop& loop) {
    return !std::isnan(loop.sd) || !std::isnan(loop.sd_heading);
  });
  std::string text = sds ? "t,t2,dx,dy,dtheta,sd,sd_heading\n" : "t,t2,dx,dy,dtheta\n";
  for (const Loop& loop : loops) {
    text += csv_number(loop.t) + ',' + csv_number(loop.t2) + ',' + csv_number(loop.dx) + ',' +
            csv_number(loop.dy) + ',' + csv_number(loop.dtheta);
    if (sds) text += ',' + csv_number(loop.sd) + ',' + csv_number(loop.sd_heading);
    text += '\n';
  }
  return text;
}

/// By the readers of what is written, before anything is.
void require_readable(const FolderOfFiles& whole, const Recording& recording) {
  try {
    static_cast<void>(recording_in(whole.files, recording.sightings.empty()));
    for (const auto& [name, text] : whole.files) {
      if (name == "model.toml") static_cast<void>(model_from_text(text, name));
    }
  } catch (const InputError& error) {
    const std::string from = recording.name.empty() ? whole.folder.string() : recording.name;
    throw InputError(
        from, 0, std::string("makes a recording that could not be read again: ") + error.what());
  }
}

}  // namespace

FolderOfFiles recording_folder(const fs::path& folder, const Recording& recording,
                               const std::string& comment, NamedTexts beside) {
  FolderOfFiles whole;
  whole.folder = folder;
  whole.files.emplace_back("drive.csv", drive_text(recording.drive, comment));
  if (!recording.sightings.empty()) {
    whole.files.emplace_back("sightings.csv", sightings_text(recording.sightings));
  }
  if (!recording.survey.empty()) {
    whole.files.emplace_back("survey.csv", survey_text(recording.survey));
  }
  if (!recording.truth.empty()) whole.files.emplace_back("truth.csv", truth_text(recording.truth));
  if (!recording.fixes.empty()) whole.files.emplace_back("fixes.csv", fixes_text(recording.fixes));
  if (!recording.loops.empty()) whole.files.emplace_back("loops.csv", loops_text(recording.loops));
  for (auto& file : beside) whole.files.push_back(std::move(file));
  require_readable(whole, recording);
  // An earlier recording's stream in the same folder would be taken for this one's.
  for (const char* name : {"sightings.csv", "survey.csv", "truth.csv", "fixes.csv", "loops.csv"}) {
    const bool written = std::any_of(whole.files.begin(), whole.files.end(),
                                     [name](const auto& file) { return file.first == name; });
    if (!written) whole.gone.emplace_back(name);
  }
  return whole;
}

void write_recording(const fs::path& folder, const Recording& recording, const std::string& comment,
                     const NamedTexts& beside) {
  write_files({}, {recording_folder(folder, recording, comment, beside)});
}

}  // namespace trussmap
