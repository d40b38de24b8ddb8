// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Component trussmap::trussmap.
//
// Pages: what a command found, in one HTML file that needs nothing else, with charts. A page draws
// results and what was gathered for it (evidence.hpp); it estimates nothing.
//
//   results --comparison_page ...--> Page --render_page--> HTML; render_plain_page: without a
//   script
//                                         --draw_charts--> SVG, one for each chart
//
// `subject` is what the page is about: recordings and model. Same input, same bytes.
#pragma once

#include "trussmap/calibrate.hpp"
#include "trussmap/model.hpp"
#include "trussmap/recording.hpp"
#include "trussmap/survey_comparison.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace trussmap {

namespace report {
struct PageContent;
}

struct BuiltMap;
struct Comparison;
struct ComparisonEvidence;
struct Diagnosis;
struct DiagnosisEvidence;
struct Discovery;
struct DiscoveryEvidence;
struct FitEvidence;
struct FleetReport;
struct RobotConstants;
struct RunContrast;
struct TourMap;
struct TourResult;
struct EffectPreview;
class TriedModel;
struct WorkbenchLog;

/// Copies share the content, which nothing changes: threads may use them at once.
class Page {
 public:
  /// For the library's own use, as `content`.
  Page(report::PageContent content);  // NOLINT(google-explicit-constructor)
  [[nodiscard]] const report::PageContent& content() const { return *content_; }

 private:
  std::shared_ptr<const report::PageContent> content_;
};

/// What makes the charts live (src/report/page): a style sheet, and a script with the chart
/// library.
struct PageRuntime {
  std::string_view style;
  std::string_view script;
};

/// The file. Its content security policy lets this script run and no other, and loads nothing.
[[nodiscard]] std::string render_page(const Page& page, const PageRuntime& runtime);

/// The same as a part of another page, such as a notebook's: verdict, figures, answers, tables and
/// charts as pictures; without a script, and with the little style that it needs.
[[nodiscard]] std::string render_section(const Page& page);

/// That section as a file of its own.
[[nodiscard]] std::string render_plain_page(const Page& page);

struct DrawnChart {
  std::string id;   ///< small letters, digits, -
  std::string svg;  ///< a file
};
[[nodiscard]] std::vector<DrawnChart> draw_charts(const Page& page);

struct SquareCalibration {
  std::vector<SquareRound> rounds;
  double side = 4.0;      ///< m
  Estimate wheelbase;     ///< m: to use from now on
  Estimate left_factor;   ///< likewise
  Estimate right_factor;  ///< likewise
  std::vector<std::string> doubts;
};

struct NoiseCalibration {
  EndErrors errors;
  NoiseEstimate estimate;
  NoiseFit fit;
  double path = 0.0;  ///< m, its length
  std::vector<std::string> doubts;
  std::optional<StatedNoise> stated = std::nullopt;  ///< drawn as well
};

struct TruthCalibration {
  WheelCalibration wheels;
  ArrivalErrors nominal;     ///< of held-out legs
  ArrivalErrors calibrated;  ///< of the same
  std::string verdict;       ///< one sentence
};

[[nodiscard]] Page comparison_page(const ComparisonEvidence& evidence, const std::string& subject);
[[nodiscard]] Page diagnosis_page(const Diagnosis& diagnosis, const DiagnosisEvidence& evidence,
                                  const std::string& subject);
[[nodiscard]] Page discovery_page(const Discovery& discovery, const DiscoveryEvidence& evidence,
                                  const std::string& subject);
[[nodiscard]] Page fit_page(const FitEvidence& evidence, const std::string& subject);
[[nodiscard]] Page fleet_page(const FleetReport& report, const std::string& subject);
[[nodiscard]] Page contrast_page(const RunContrast& contrast, const std::string& subject);
[[nodiscard]] Page map_page(const BuiltMap& built, const std::string& subject);
[[nodiscard]] Page noise_page(const NoiseCalibration& found, const std::string& subject);
[[nodiscard]] Page square_page(const SquareCalibration& found, const std::string& subject);
[[nodiscard]] Page truth_page(const TruthCalibration& found, const std::string& subject);
/// Bands are 95 % intervals of the means over the seeds.
[[nodiscard]] Page tour_page(const TourResult& result, int seeds, const std::string& subject);

/// The page with the robot's drive on it: its wheels from above and, where it steers, how far it
/// steered in these recordings (wheels taken in). Of two wheels the page as it is.
[[nodiscard]] Page with_drive(const Page& page, const Robot& robot,
                              const std::vector<DrivenRecording>& recordings);

/// How far off legs that no fit has seen may end, and how far they do.
struct Tolerance {
  double most = 0.0;         ///< m, root mean square
  double arrival_rms = 0.0;  ///< m (HeldOutMetrics)
  std::size_t legs = 0;      ///< held out, of which that is

  [[nodiscard]] bool passed() const { return arrival_rms <= most; }
};
/// The page with that above all else.
[[nodiscard]] Page with_tolerance(const Page& page, const Tolerance& tolerance);
/// "passed: legs end 12 mm off (root mean square of 43 held out), within the tolerance of 20 mm".
[[nodiscard]] std::string in_words(const Tolerance& tolerance);

/// The command of `trussmap` that helps on from a result; none where a look at the floor, or at
/// what happened, does.
struct NextCommand {
  std::string_view command;   ///< "fit"
  std::string_view options;   ///< "--noise"; may be empty
  std::string_view what_for;  ///< "writes the noise found into the model"
};
[[nodiscard]] std::optional<NextCommand> next_command(const Comparison& result);
[[nodiscard]] std::optional<NextCommand> next_command(const Diagnosis& result);
/// `kept`: the model found is in a file.
[[nodiscard]] std::optional<NextCommand> next_command(const Discovery& result, bool kept);

/// That as a command line to copy, and what it does.
struct NextStep {
  std::string line;      ///< quoted for a shell
  std::string what_for;  ///< "adds what is missing, and what shows behind it"
};
/// The page with that below its verdict.
[[nodiscard]] Page with_next_step(const Page& page, const NextStep& next);

/// How a page came about, for its foot.
struct Provenance {
  std::string command;  ///< the line that made it, quoted for a shell
  std::string version;  ///< of trussmap
  std::string date;     ///< YYYY-MM-DD; empty: not told
  /// Names of recordings, and what tells each from any other (fingerprint, recording_files.hpp).
  std::vector<std::pair<std::string, std::string>> data = {};
};
/// The page with that at its foot, and how to cite.
[[nodiscard]] Page with_provenance(const Page& page, const Provenance& provenance);

/// The page with the constants to paste; without any the page as it is.
[[nodiscard]] Page with_constants(const Page& page, const RobotConstants& constants);

/// The page of a workbench: it asks the program that serves it for what it shows. Its content
/// security policy lets this script run and no other, and ask no other program.
[[nodiscard]] std::string workbench_page(const PageRuntime& runtime);
/// What that page shows, as JSON: verdict, cards, charts, steps. `provisional`: by the noise as
/// stated, while it is still being estimated.
[[nodiscard]] std::string workbench_json(const TriedModel& now, const WorkbenchLog& log,
                                         const std::string& subject, bool provisional = false);
/// Of that, what the page shows when these legs are chosen, by their numbers, ascending.
[[nodiscard]] std::string selection_json(const TriedModel& now, const WorkbenchLog& log,
                                         const std::vector<std::size_t>& legs);
/// The same of an effect that is looked at: "+ name" beside the present model's error `arrival_rms`
/// [m]. Of one that the model has, without figures of what it would save.
[[nodiscard]] std::string preview_json(const EffectPreview& preview, double arrival_rms);

/// Pictures as SVG files: the map before and after, over its survey where there is one; where runs
/// round a square of this side [m] ended, a cluster per direction and round; end errors with the
/// 95 % ellipses of the runs and of the estimate.
[[nodiscard]] std::string map_picture(const BuiltMap& built, const std::string& title);
/// A tour's map over the true one, as the elastic paper's Figures 5 and 8; by first sight alone
/// with what was measured below it, and crosses at the true positions, as its Figure 7.
[[nodiscard]] std::string tour_picture(const TourMap& shown);
[[nodiscard]] std::string square_picture(const std::vector<SquareRuns>& rounds, double side);
/// With a stated k its ellipses of 1, 2 and 3 standard deviations as well.
[[nodiscard]] std::string noise_picture(const EndErrors& errors, const NoiseEstimate& estimate,
                                        const std::optional<StatedNoise>& stated = std::nullopt);

/// A moment of an exploration.
struct ExplorationFrame {
  LandmarkGraph map;   ///< without a compass laid over the world
  int here = -1;       ///< landmark
  double way = 0.0;    ///< m, driven so far
  double error = 0.0;  ///< m, mean distance of its landmarks from where they are
};

/// The map as it grows, an animated picture (SVG); without animation its end. `world`: where
/// landmarks are, and the routes between them.
[[nodiscard]] std::string exploration_picture(const std::vector<ExplorationFrame>& frames,
                                              const LandmarkGraph& world,
                                              const std::string& subject);

/// A file with that picture, its error over the way, and moments of it (HTML).
[[nodiscard]] std::string exploration_page(const std::vector<ExplorationFrame>& frames,
                                           const LandmarkGraph& world, const std::string& subject);

}  // namespace trussmap
