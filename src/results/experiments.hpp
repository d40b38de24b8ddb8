// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What umbmark, noise and tape write: experiments beside a tape.
#pragma once

#include "results/common.hpp"
#include "trussmap/texts.hpp"
#include "trussmap/umbmark.hpp"
#include "trussmap/wheel_noise.hpp"

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::results {

// ----------------------------------------
// umbmark.

/// A square's solution by one method.
struct SolvedSquare {
  const SquareRound* round = nullptr;
  SquareMethod method = SquareMethod::exact;

  [[nodiscard]] const SquareSolution& found() const {
    return method == SquareMethod::exact ? round->exact : round->formulas;
  }
  [[nodiscard]] SquareCorrections sum() const { return corrections_after(*round, method); }
  [[nodiscard]] const SquareClusters& clusters() const { return round->clusters; }
};

/// An estimate of `from` and its standard error.
template <auto kFrom, auto kMember>
[[nodiscard]] constexpr auto square_figure(const char* name, const char* sd_name,
                                           const char* about) {
  return std::tuple(field(
                        name,
                        [](const SolvedSquare& one) {
                          return std::invoke(kMember, std::invoke(kFrom, one)).value;
                        },
                        about),
                    field(
                        sd_name,
                        [](const SolvedSquare& one) {
                          return std::invoke(kMember, std::invoke(kFrom, one)).standard_error;
                        },
                        "standard error")
                        .or_null());
}
template <auto kMember>
inline constexpr auto kInterval = [](const SolvedSquare& one) {
  const Interval at = confidence_interval(std::invoke(kMember, one.found()));
  return std::array<double, 2>{at.low, at.high};
};
template <auto kMember>
inline constexpr auto kTotal =
    [](const SolvedSquare& one) { return std::invoke(kMember, one.sum().errors); };

template <>
inline constexpr auto kDescribed<SolvedSquare> =
    described(
        square_figure<&SolvedSquare::found, &SquareSolution::alpha>(
            "alpha_rad", "sd_alpha_rad", "type A error: rotation per turn"),
        square_figure<&SolvedSquare::found, &SquareSolution::beta>("beta_rad", "sd_beta_rad",
                                                                   "type B error: bend per leg"),
        square_figure<&SolvedSquare::found, &SquareSolution::diameter_ratio>(
            "E_d", "sd_E_d", "right over left wheel diameter"),
        square_figure<&SolvedSquare::found, &SquareSolution::wheelbase_ratio>(
            "E_b", "sd_E_b", "actual over nominal wheelbase"),
        square_figure<&SolvedSquare::sum, &SquareCorrections::left_factor>(
            "c_left", "sd_c_left", "correction of the left wheel's travel"),
        square_figure<&SolvedSquare::sum, &SquareCorrections::right_factor>("c_right", "sd_c_right",
                                                                            "of the right one's"),
        square_figure<&SolvedSquare::sum, &SquareCorrections::wheelbase>("wheelbase_m",
                                                                         "sd_wheelbase_m",
                                                                         "corrected"),
        square_figure<&SolvedSquare::clusters, &SquareClusters::largest_offset>(
            "E_max_syst_m", "sd_E_max_syst_m", "the larger of both centres' distances from 0"),
        field("sem_m", through(&SolvedSquare::clusters, &SquareClusters::sem), "of a centre")
            .or_null(),
        field("second_round_worthwhile",
              through(&SolvedSquare::clusters, &SquareClusters::second_round_worthwhile),
              "the corrections are within reach of another round"),
        field("interval95_E_d", kInterval<&SquareSolution::diameter_ratio>, "low and high")
            .or_null(),
        field("interval95_E_b", kInterval<&SquareSolution::wheelbase_ratio>, "low and high")
            .or_null(),
        field("total_E_d", kTotal<&GeometryErrors::diameter_ratio>, "of all rounds so far"),
        field("total_E_b", kTotal<&GeometryErrors::wheelbase_ratio>, "of all rounds so far"),
        field("total_E_s", kTotal<&GeometryErrors::scale>,
              "mean wheel size over nominal, likewise"))
        .named("square_solution");

/// Standard deviation of a run along an axis, m.
template <int kAxis>
[[nodiscard]] double sd_along(const SampleMean& mean) {
  return std::sqrt(mean.covariance(kAxis, kAxis));
}
template <>
inline constexpr auto kDescribed<SampleMean> =
    described(field("runs", &SampleMean::count).at_least(0.0),
              field(
                  "x_m", [](const SampleMean& one) { return one.mean.x(); }, "mean"),
              field(
                  "y_m", [](const SampleMean& one) { return one.mean.y(); }, "mean"),
              field("sd_x_m", sd_along<0>, "of a run").or_null(),
              field("sd_y_m", sd_along<1>, "of a run").or_null());

/// An estimate by headings and its standard error.
template <auto kMember>
[[nodiscard]] constexpr auto heading_figure(const char* name, const char* sd_name,
                                            const char* about = "", const char* sd_about = "") {
  return std::tuple(field(name, through(kMember, &Estimate::value), about),
                    field(sd_name, through(kMember, &Estimate::standard_error), sd_about));
}
template <>
inline constexpr auto kDescribed<SquareHeadings> = described(
    heading_figure<&SquareHeadings::cw>("cw_rad", "sd_cw_rad", "mean error, counter-clockwise",
                                        "of the mean"),
    heading_figure<&SquareHeadings::ccw>("ccw_rad", "sd_ccw_rad", "mean error", "of the mean"),
    field("E_theta_max_rad", &SquareHeadings::largest, "the larger of both").at_least(0.0),
    heading_figure<&SquareHeadings::alpha>("alpha_rad", "sd_alpha_rad", "missing per quarter turn"),
    heading_figure<&SquareHeadings::beta>("beta_rad", "sd_beta_rad", "turned per leg"),
    heading_figure<&SquareHeadings::diameter_ratio>("E_d", "sd_E_d"),
    heading_figure<&SquareHeadings::wheelbase_ratio>("E_b", "sd_E_b"),
    heading_figure<&SquareHeadings::alpha_excess>("alpha_excess_rad", "sd_alpha_excess_rad",
                                                  "headings less positions",
                                                  "of the difference, run by run"),
    heading_figure<&SquareHeadings::beta_excess>("beta_excess_rad", "sd_beta_excess_rad",
                                                 "headings less positions",
                                                 "of the difference, run by run"),
    field("p_value", &SquareHeadings::p_value, "of excesses as large by chance").or_null());

[[nodiscard]] inline SolvedSquare by_formulas(const SquareRound& round) {
  return {&round, SquareMethod::formulas};
}
[[nodiscard]] inline SolvedSquare by_exact(const SquareRound& round) {
  return {&round, SquareMethod::exact};
}
template <auto kMember>
inline constexpr auto kAngle = through(&SquareRound::angles, kMember, &Estimate::value);

template <>
inline constexpr auto kDescribed<SquareRound> =
    described(
        keys_of("formulas", by_formulas),
        field("exact", by_exact, "without the formulas' approximations"),
        field("cw", through(&SquareRound::clusters, &SquareClusters::cw)),
        field("ccw", through(&SquareRound::clusters, &SquareClusters::ccw)),
        field("alpha_x_rad", kAngle<&SquareAngles::alpha_x>, "from x alone"),
        field("alpha_y_rad", kAngle<&SquareAngles::alpha_y>, "from y alone"),
        field("beta_x_rad", kAngle<&SquareAngles::beta_x>, "from x alone"),
        field("beta_y_rad", kAngle<&SquareAngles::beta_y>, "from y alone"),
        field("driven_with",
              described(
                  field("wheelbase_m", through(&SquareRound::setup, &SquareSetup::wheelbase),
                        "nominal"),
                  field("c_left", through(&SquareRound::in_force, &GeometryErrors::left_factor),
                        "correction in force"),
                  field("c_right", through(&SquareRound::in_force, &GeometryErrors::right_factor),
                        "correction in force"))),
        field("residual_m", through(&SquareRound::consistency, &SquareConsistency::residual),
              "what two errors do not explain of the centres"),
        field("contradiction_p_value",
              through(&SquareRound::consistency, &SquareConsistency::p_value), "of that residual")
            .or_null(),
        field("E_s", through(&SquareRound::setup, &SquareSetup::scale, &Estimate::value),
              "of straight runs with this round's settings; 1 where none were measured, and once "
              "it is corrected"),
        field(
            "sd_E_s",
            [](const SquareRound& round) {
              const Estimate& scale = round.setup.scale;
              return scale.dof > 0.0 ? std::optional(scale.standard_error) : std::nullopt;
            },
            "of two straight runs or more"),
        field("headings", &SquareRound::headings,
              "what the return orientations say; null where they were not measured"),
        field("verdict", square_verdict,
              "doubtful: see the warnings; where the runs contradict each other, the standard "
              "errors hold that, too")
            .one_of("worth correcting | nothing left to correct | doubtful"),
        field("warnings", &SquareRound::doubts))
        .named("square_round");

template <>
inline constexpr auto kDescribed<PathAlone> = described(
    field("path", &PathAlone::path, "as given"),
    field("end_m", through(&PathAlone::tuned, &PathTuning::error_before), "how far its end is off")
        .at_least(0.0),
    field("tuned_wheelbase_ratio", through(&PathAlone::tuned, &PathTuning::wheelbase_ratio),
          "tuned until it is off least, over that in force"),
    field("end_tuned_m", through(&PathAlone::tuned, &PathTuning::error_after), "then")
        .at_least(0.0),
    field("square_cw_tuned_m", through(&PathAlone::tuned, &PathTuning::square_cw),
          "how far a square is off then")
        .at_least(0.0),
    field("square_ccw_tuned_m", through(&PathAlone::tuned, &PathTuning::square_ccw)).at_least(0.0));

/// What umbmark says.
struct SquareReport {
  const std::vector<SquareRound>* rounds = nullptr;
  SquareMethod method = SquareMethod::exact;
  const std::vector<PathAlone>* alone = nullptr;
};
template <>
inline constexpr auto kDescribed<SquareReport> = described(
    keys_of("last",
            [](const SquareReport& one) -> const SquareRound& { return one.rounds->back(); }),
    field(
        "solution",
        [](const SquareReport& one) {
          return one.method == SquareMethod::exact ? "exact" : "formulas";
        },
        "which of both is in use")
        .one_of("formulas | exact"),
    field("rounds",
          [](const SquareReport& one) -> const std::vector<SquareRound>& { return *one.rounds; }),
    field(
        "alone",
        [](const SquareReport& one) -> const std::vector<PathAlone>& { return *one.alone; },
        "--alone: what other paths would have hidden")
        .if_any());

// ----------------------------------------
// noise.

/// A wheel's constant.
template <auto kWheel, auto kMember>
inline constexpr auto kOfWheel = through(kWheel, kMember);
template <int kWheel>
[[nodiscard]] double squared_of(const NoiseEstimate& one) {
  return one.squared[kWheel];
}
template <int kWheel>
[[nodiscard]] double sd_squared_of(const NoiseEstimate& one) {
  return std::sqrt(one.squared_covariance(kWheel, kWheel));
}
template <>
inline constexpr auto kDescribed<NoiseEstimate> =
    described(field("k_left", kOfWheel<&NoiseEstimate::left, &WheelConstant::k>, "m^(1/2)"),
              field("k_right", kOfWheel<&NoiseEstimate::right, &WheelConstant::k>, "m^(1/2)"),
              field("sd_k_left", kOfWheel<&NoiseEstimate::left, &WheelConstant::standard_error>,
                    "m^(1/2), null where k is 0")
                  .or_null(),
              field("sd_k_right", kOfWheel<&NoiseEstimate::right, &WheelConstant::standard_error>,
                    "likewise")
                  .or_null(),
              field("upper95_k_left", kOfWheel<&NoiseEstimate::left, &WheelConstant::upper_limit>,
                    "m^(1/2), below which k is with 95 % confidence"),
              field("upper95_k_right", kOfWheel<&NoiseEstimate::right, &WheelConstant::upper_limit>,
                    "likewise"),
              field("k_left_squared", squared_of<0>, "m, not bounded at 0"),
              field("k_right_squared", squared_of<1>, "m, likewise"),
              field("sd_k_left_squared", sd_squared_of<0>, "m"),
              field("sd_k_right_squared", sd_squared_of<1>, "m"))
        .named("wheel_constants");

template <>
inline constexpr auto kDescribed<EllipseCount> =
    described(field("coordinates", &EllipseCount::coordinates, "x-y, ..."),
              field("inside", &EllipseCount::inside, "the 95 % ellipse").at_least(0.0),
              field("runs", &EllipseCount::runs).at_least(0.0),
              share("p_value", &EllipseCount::p_value, "two-sided"));

template <>
inline constexpr auto kDescribed<NoiseFit> = described(
    field("good", &NoiseFit::good, "no p-value below 0.01"),
    field("bends", &NoiseFit::nonlinear, "the errors are not Gaussian: exact is in use"),
    field("distance_p_value", &NoiseFit::distance_p_value, "Kolmogorov-Smirnov's").or_null(),
    field("shape_p_value", &NoiseFit::shape_p_value, "of the likelihood ratio").or_null(),
    field("ellipses", &NoiseFit::ellipses));

template <>
inline constexpr auto kDescribed<SigmaCount> = described(
    field("coordinates", &SigmaCount::coordinates, "x-y, ..."),
    field("runs", &SigmaCount::runs).at_least(0.0),
    field("inside_1_2_3_sigma", &SigmaCount::inside, "runs within so many standard deviations"),
    field("expected_1_2_3_sigma", &SigmaCount::expected, "of a normal distribution"));

template <>
inline constexpr auto kDescribed<StatedNoise> =
    described(field("k_left", &StatedNoise::left, "m^(1/2), as given"),
              field("k_right", &StatedNoise::right, "m^(1/2), as given"),
              share("p_value", &StatedNoise::p_value, "of the likelihood ratio to the estimate"),
              field("within", &StatedNoise::counts));

/// What noise says.
struct NoiseReport {
  const NoiseAnalysis* analysis = nullptr;
  std::string path;
};
template <auto kMember>
inline constexpr auto kAnalysed =
    [](const NoiseReport& one) -> decltype(auto) { return std::invoke(kMember, *one.analysis); };
template <>
inline constexpr auto kDescribed<NoiseReport> = described(
    keys_of("estimate", kAnalysed<&NoiseAnalysis::estimate>),
    field("runs", through(kAnalysed<&NoiseAnalysis::estimate>, &NoiseEstimate::runs)).at_least(0.0),
    field("first_order", kAnalysed<&NoiseAnalysis::first_order>, "the paper's"),
    field("exact", kAnalysed<&NoiseAnalysis::exact>, "without linearisation"),
    field("path", &NoiseReport::path, "as given"),
    field("wheelbase_m",
          through(kAnalysed<&NoiseAnalysis::experiment>, &NoiseExperiment::wheelbase),
          "of the model"),
    field(
        "mean",
        [](const NoiseReport& one) {
          const Eigen::Vector3d& mean = one.analysis->estimate.mean;
          return std::array<double, 3>{mean[0], mean[1], mean[2]};
        },
        "of the end errors: m, m, rad"),
    field("mean_p_value",
          through(kAnalysed<&NoiseAnalysis::estimate>, &NoiseEstimate::mean_p_value),
          "of no systematic error; null with too few runs")
        .or_null(),
    field("mean_subtracted",
          through(kAnalysed<&NoiseAnalysis::experiment>, &NoiseExperiment::subtract_mean),
          "--subtract-mean"),
    field("fit", kAnalysed<&NoiseAnalysis::fit>),
    field("warnings", kAnalysed<&NoiseAnalysis::doubts>),
    field("stated", kAnalysed<&NoiseAnalysis::stated>, "--k: how well it explains the runs")
        .if_any());

// ----------------------------------------
// tape.

/// Nothing without degrees of freedom.
[[nodiscard]] inline std::optional<double> error_of(const std::optional<Estimate>& one) {
  return one && one->dof > 0.0 ? std::optional(one->standard_error) : std::nullopt;
}
[[nodiscard]] inline std::optional<double> estimated_value(const std::optional<Estimate>& one) {
  return one ? std::optional(one->value) : std::nullopt;
}
template <auto kMember>
[[nodiscard]] constexpr auto taped_figure(const char* name, const char* sd_name, const char* about,
                                          const char* sd_about = "standard error") {
  return std::tuple(field(name, through(kMember, estimated_value), about),
                    field(sd_name, through(kMember, error_of), sd_about));
}

template <>
inline constexpr auto kDescribed<TapedConstant> =
    described(field("name", &TapedConstant::name,
                    "wheelbase, left wheel, right wheel, wheels, gyro scale or gyro bias"),
              field("old", &TapedConstant::before,
                    "calculated with while driving; of wheels and gyro scale a factor"),
              field("new", through(&TapedConstant::now, &Estimate::value), "to use from now on"),
              field("sd", through(&TapedConstant::now, error_of), "standard error"),
              field("unit", &TapedConstant::unit, "m, rad/s, or none of a factor"));

template <>
inline constexpr auto kDescribed<TapeCalibration> = described(
    field(
        "verdict", [](const TapeCalibration& one) { return name_of(tape_verdict(one)); },
        "cannot tell: nothing has a standard error; doubtful: runs contradict each other")
        .one_of("worth correcting | nothing to correct | cannot tell | doubtful"),
    taped_figure<&TapeCalibration::scale>(
        "E_s", "sd_E_s", "true over measured travel; null: not determined",
        "standard error; null: none, of one run without an sd for instance"),
    taped_figure<&TapeCalibration::wheelbase_ratio>(
        "E_b", "sd_E_b",
        "actual wheelbase over that calculated with; without straight runs for E_s = 1"),
    taped_figure<&TapeCalibration::diameter_ratio>(
        "E_d", "sd_E_d", "right over left wheel diameter; null: not determined"),
    taped_figure<&TapeCalibration::turn_factor>("turn_factor", "sd_turn_factor",
                                                "true turns over the odometry's, E_s / E_b"),
    taped_figure<&TapeCalibration::gyro_scale>(
        "gyro_scale", "sd_gyro_scale", "by what share the robot turns more than its gyro says"),
    taped_figure<&TapeCalibration::gyro_bias>("gyro_bias_rad_per_s", "sd_gyro_bias_rad_per_s",
                                              "what the gyro reads too much"),
    field(
        "class",
        [](const TapeCalibration& one) {
          return one.wheelbase_ratio ? std::optional<std::string>("wheelbase") : std::nullopt;
        },
        "what E_b stands for; null without turns")
        .one_of("wheelbase"),
    field("looks_the_same", &TapeCalibration::look_alikes,
          "effects that these turns do not tell from it"),
    field(
        "runs",
        described(field("straight", &TapeCalibration::straight_runs, "straight runs").at_least(0.0),
                  field("spin", &TapeCalibration::turns, "turns on the spot").at_least(0.0),
                  field("rest", &TapeCalibration::rests, "rests").at_least(0.0))),
    field("undetermined", &TapeCalibration::undetermined, "what was not determined, and why"),
    field("notes", &TapeCalibration::notes, "what would make it surer"),
    field("warnings", &TapeCalibration::doubts, "runs that contradict each other"));

/// What tape says.
struct TapeReport {
  const TapeCalibration* found = nullptr;
  const std::vector<TapedConstant>* constants = nullptr;
};
template <>
inline constexpr auto kDescribed<TapeReport> = described(
    keys_of("found", &TapeReport::found),
    field(
        "constants",
        [](const TapeReport& one) -> const std::vector<TapedConstant>& { return *one.constants; },
        "in the owner's figures"));

}  // namespace trussmap::results
