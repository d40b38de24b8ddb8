// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Signs and places of a drive's columns: where the motion by the columns as recorded agrees with
// another sensor by none of that one's own mistakes, and by one of the columns' agrees with all.
#include "check/findings.hpp"
#include "check/misfit.hpp"
#include "check/other_drive_mistakes.hpp"
#include "geometry/units.hpp"
#include "text/number_text.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

namespace trussmap::check {
namespace {

constexpr double kDisagrees = 0.15;  // misfit, with whatever mistake of the sensor's
constexpr double kFits = 0.35;       // with a mistake of the columns
constexpr double kBetter = 0.5;      // of the misfit as recorded
constexpr double kAsGood = 1.5;      // of the best one's: cannot be told from it
constexpr double kAsGoodBy = 0.05;

/// The witness that agrees least.
struct Worst {
  Witness witness = Witness::compass;
  double misfit = 0.0;
};

Worst worst_of(const std::vector<Misfit>& all, double Misfit::*which) {
  Worst worst;
  for (const Misfit& one : all) {
    if (one.*which >= worst.misfit) worst = {one.witness, one.*which};
  }
  return worst;
}

/// Whether each of the first tells in the second, too: where nothing moves, nothing contradicts.
bool all_tell(const std::vector<Misfit>& first, const std::vector<Misfit>& second) {
  return std::all_of(first.begin(), first.end(), [&](const Misfit& one) {
    return std::any_of(second.begin(), second.end(),
                       [&](const Misfit& other) { return other.witness == one.witness; });
  });
}

struct MistakeExplanation {
  OtherDriveMistake mistake;
  double misfit = 0.0;  ///< of the witness that agrees least
};

std::vector<MistakeExplanation> explanations(const Checked& checked, const MisfitFrame& frame,
                                             const std::vector<Misfit>& recorded, double misfit) {
  const DrivenRecording& recording = checked.recording;
  const MotionRows& drive = recording.drive;
  std::vector<MistakeExplanation> result;
  const double limit = std::min(kFits, kBetter * misfit);
  double best = limit;
  for (OtherDriveMistake& mistake : other_drive_mistakes(*checked.robot)) {
    const std::optional<MotionRows> other = drive_without(mistake, drive, *checked.robot);
    if (!other) continue;
    const std::optional<std::vector<Misfit>> now = misfits_below(limit, recording, *other, frame);
    if (!now || !all_tell(recorded, *now)) continue;
    const double worst = worst_of(*now, &Misfit::stated).misfit;
    best = std::min(best, worst);
    result.push_back({std::move(mistake), worst});
  }
  std::erase_if(result, [best](const MistakeExplanation& one) {
    return one.misfit > std::max(kAsGood * best, best + kAsGoodBy);
  });
  // The likeliest first, the simple ones of those that are as likely.
  constexpr double kEqual = 0.01;
  std::stable_partition(result.begin(), result.end(), [best](const MistakeExplanation& one) {
    return one.misfit < best + kEqual;
  });
  return result;
}

std::string percent(double share) {
  return text::fixed_text(100.0 * share, 0) + " %";
}

}  // namespace

bool steers_in_degrees(const Recording& recording, const Robot& robot) {
  constexpr double kSome = 0.05;  // of the rows
  const bool tricycle = robot.drive == DriveKind::tricycle;
  if ((!tricycle && robot.drive != DriveKind::ackermann) || robot.columns.size() != 2) return false;
  const std::vector<Covariate>& columns = recording.drive.covariates;
  const auto steer = std::find_if(columns.begin(), columns.end(), [&robot](const Covariate& one) {
    return one.name == robot.columns[1];
  });
  if (steer == columns.end()) return false;
  const double most = tricycle ? 2.0 * std::numbers::pi : 0.5 * std::numbers::pi;
  std::size_t beyond = 0;
  for (const double angle : steer->values) {
    if (!(std::abs(geometry::kDegree * angle) <= 2.0 * std::numbers::pi)) return false;
    if (std::abs(angle) > most) ++beyond;
  }
  return static_cast<double>(beyond) > kSome * static_cast<double>(steer->values.size());
}

void check_other_drive(Checked& checked) {
  if (checked.wrong.contains("left") || checked.wrong.contains("t")) return;
  const MotionRows& drive = checked.recording.drive;
  const MisfitFrame frame{checked.angle_unit, drive.start(), drive.t.back()};
  const std::vector<Misfit> recorded = misfits(checked.recording, drive, frame);
  const Worst worst = worst_of(recorded, &Misfit::best);
  if (worst.misfit < kDisagrees) return;
  const std::vector<MistakeExplanation> found =
      explanations(checked, frame, recorded, worst.misfit);
  if (found.empty()) return;
  const Robot& robot = *checked.robot;
  std::set<std::size_t> which;
  std::string words;
  std::string remedy;
  for (const MistakeExplanation& one : found) {
    for (const std::size_t k : one.mistake.columns()) which.insert(k);
    words += (words.empty() ? "with " : ", or with ") + in_words(one.mistake, robot);
    remedy += (remedy.empty() ? "" : ", or ") + remedy_of(one.mistake, robot);
  }
  std::string columns;
  for (const std::size_t k : which) columns += (columns.empty() ? "" : ",") + robot.columns[k];
  checked.add(
      "drive.csv", columns, found.front().mistake.kind,
      text::joined("as recorded the drive is ", percent(worst.misfit), " off ",
                   name_of(worst.witness), "; ", words, " it is ", percent(found.front().misfit),
                   " off", recorded.size() > 1 ? " at most" : ""),
      remedy);
}

}  // namespace trussmap::check
