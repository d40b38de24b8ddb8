// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What build writes.
#pragma once

#include "results/common.hpp"
#include "trussmap/build_map.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace trussmap::results {

/// An element of a landmark's covariance, m^2, where it is known.
template <int kRow, int kColumn>
[[nodiscard]] std::optional<double> covariance_of(const Landmark& one) {
  return one.covariance ? std::optional((*one.covariance)(kRow, kColumn)) : std::nullopt;
}

template <>
inline constexpr auto kDescribed<Landmark> =
    described(
        field(
            "x", [](const Landmark& one) { return one.position.x(); }, "m"),
        field(
            "y", [](const Landmark& one) { return one.position.y(); }, "m"),
        field("c_xx", covariance_of<0, 0>,
              "m^2, covariance in the map's frame, which is held at its first landmark")
            .if_any(),
        field("c_xy", covariance_of<0, 1>, "m^2").if_any(),
        field("c_yy", covariance_of<1, 1>, "m^2").if_any(),
        field("heading", &Landmark::heading, "rad, of landmarks whose yaws were read").if_any(),
        field("sd_heading", &Landmark::sd_heading, "rad").if_any())
        .named("position");

/// A map's landmarks, by name.
[[nodiscard]] inline Keyed<Landmark> positions(const LandmarkGraph& map) {
  Keyed<Landmark> all;
  for (int k = 0; k < map.landmarks(); ++k) {
    all.values.emplace_back(map.landmark(k).name, map.landmark(k));
  }
  return all;
}

template <>
inline constexpr auto kDescribed<RejectedSighting> =
    described(field("recording", &RejectedSighting::recording, "its name"),
              field("t", &RejectedSighting::t, "s"),
              field("landmark", &RejectedSighting::landmark, "its name"),
              field("misfit_m", &RejectedSighting::misfit, "from where the map has the landmark"));

template <>
inline constexpr auto kDescribed<FreedError> =
    described(keys_of("effect", &FreedError::effect),
              field("coefficients", through(&FreedError::effect, &Effect::coefficients)),
              field("sd", &FreedError::sd, "standard errors"));

template <>
inline constexpr auto kDescribed<MapQuality> = described(
    field("median_sd_m", &MapQuality::median_sd,
          "standard error of a landmark's position after the best rotation and translation of "
          "all; of the path where there are none"),
    field("worst_sd_m", &MapQuality::worst_sd, "the largest"),
    field("worst_landmark", &MapQuality::worst_landmark, "whose it is"),
    field("oriented", &MapQuality::oriented, "landmarks of which yaws tell an orientation")
        .at_least(0.0),
    field("median_sd_heading_rad", &MapQuality::median_sd_heading, "of these").or_null(),
    field("dispersion", &MapQuality::dispersion,
          "chi2/dof: 1 where the model's noise explains all errors"),
    field("loops", &MapQuality::loops, "from a landmark back to it").at_least(0.0),
    field("misclosure_share", &MapQuality::misclosure_share,
          "by how much dead reckoning misses a loop's start, as a share of the way: median")
        .or_null(),
    field("sightings", &MapQuality::sightings, "of all landmarks").at_least(0.0),
    field("left_out_share", &MapQuality::left_out_share,
          "of the sightings; where there are none, of fixes and loops"),
    field("from_adjusted_rms_m", &MapQuality::from_adjusted, "distance from the adjustment's map"));

/// A tour of a map that grew leg by leg.
struct GrownTour {
  std::size_t tour = 0;
  const TourErrors* errors = nullptr;
};
template <auto kMember>
inline constexpr auto kOfTour = through(&GrownTour::errors, &TourErrors::errors, kMember);
template <>
inline constexpr auto kDescribed<GrownTour> =
    described(field("tour", &GrownTour::tour, "its number").at_least(1.0),
              field("stretch_error", kOfTour<&MapErrors::stretch>,
                    "sigma: mean of |s - s_true|/s_true over the routes"),
              field("orientation_error_rad", kOfTour<&MapErrors::orientation>,
                    "rho: mean of |theta - theta_true| over the routes"),
              field("position_error_m", kOfTour<&MapErrors::position>,
                    "mean distance of the landmarks from the truth")
                  .if_any(),
              field("routes", kOfTour<&MapErrors::routes>, "that were compared").at_least(0.0),
              field("complete", through(&GrownTour::errors, &TourErrors::complete),
                    "false: the recording ended within the tour"));

[[nodiscard]] inline std::vector<GrownTour> grown_tours(const BuiltMap& built) {
  std::vector<GrownTour> tours;
  for (const TourErrors& one : built.tours) tours.push_back({tours.size() + 1, &one});
  return tours;
}

/// A member of the comparison with a survey.
template <auto kMember>
inline constexpr auto kOnSurvey = through(&MapOnSurvey::comparison, kMember);

template <>
inline constexpr auto kDescribed<MapOnSurvey> = described(
    field("landmarks", kOnSurvey<&SurveyComparison::landmarks>,
          "in the map and in the survey, not contradicting")
        .at_least(0.0),
    field("rms_m", through(&MapOnSurvey::comparison, &SurveyComparison::rigid, &Alignment::rms),
          "distance, after the best rotation and translation of the map onto the survey"),
    field("rms_dead_reckoning_m", &MapOnSurvey::rms_dead_reckoning,
          "the same of dead reckoning alone; null: landmarks are not reckoned")
        .or_null(),
    field("rms_similarity_m",
          through(&MapOnSurvey::comparison, &SurveyComparison::similarity, &Alignment::rms),
          "with a scale as well"),
    field("scale",
          through(&MapOnSurvey::comparison, &SurveyComparison::similarity, &Alignment::scale),
          "of that"),
    field("rms_with_contradicting_m", kOnSurvey<&SurveyComparison::rms_all>, "with those left out"),
    field("contradicting", kOnSurvey<&SurveyComparison::contradicting>,
          "landmarks left out of the figures"),
    field("exchanged", kOnSurvey<&SurveyComparison::exchanged>,
          "pairs, each where the other should be"));

// ----------------------------------------
// Paths of recordings without landmarks.

template <>
inline constexpr auto kDescribed<PathTie> = described(
    field(
        "kind", [](const PathTie& tie) { return tie.loop ? "loop" : "fix"; }, "what it is")
        .one_of("fix | loop"),
    field("t", &PathTie::t, "s"),
    field(
        "t2", [](const PathTie& tie) { return tie.loop ? std::optional(tie.t2) : std::nullopt; },
        "s, of a loop")
        .if_any(),
    field("misfit_m", &PathTie::misfit, "between what was measured and the path"));

template <>
inline constexpr auto kDescribed<PathOnTruth> = described(
    field("rows", &PathOnTruth::rows, "within the drive").at_least(0.0),
    field("rms_m", &PathOnTruth::rms, "distance, after the best rotation and translation"),
    field("rms_dead_reckoning_m", &PathOnTruth::rms_dead_reckoning, "the same of dead reckoning"));

/// How many fixes, or loops.
template <bool kLoops>
[[nodiscard]] std::size_t ties_of(const BuiltPath& path) {
  return static_cast<std::size_t>(std::ranges::count(path.ties, kLoops, &PathTie::loop));
}
[[nodiscard]] inline std::vector<PathTie> left_out_of(const BuiltPath& path) {
  std::vector<PathTie> ties;
  std::ranges::copy_if(path.ties, std::back_inserter(ties), &PathTie::left_out);
  return ties;
}

template <>
inline constexpr auto kDescribed<BuiltPath> =
    described(field("recording", &BuiltPath::recording, "its name"),
              field("length_m", &BuiltPath::length, "of the path"),
              field("median_sd_m", &BuiltPath::median_sd, "standard error of a position"),
              field("worst_sd_m", &BuiltPath::worst_sd, "the largest"),
              field("worst_t", &BuiltPath::worst_t, "s, when"),
              field("dead_reckoning_off_rms_m", &BuiltPath::rms_dead_reckoning,
                    "distance of dead reckoning from the path"),
              field("fixes", ties_of<false>, "positions measured on the way"),
              field("loops", ties_of<true>, "poses measured from one time to another"),
              field("left_out", left_out_of, "fixes and loops that contradict the others"),
              field("truth", &BuiltPath::on_truth, "the path beside the truth").if_any());

// ----------------------------------------
// The map.

/// What build says of recordings.
struct MapReport {
  const BuiltMap* built = nullptr;
  std::string method;  ///< as --method has it
};
template <auto kMember>
inline constexpr auto kBuilt =
    [](const MapReport& one) -> decltype(auto) { return std::invoke(kMember, *one.built); };
template <auto kMember>
inline constexpr auto kOfMap = through(&MapReport::built, &BuiltMap::map, kMember);
template <auto kMember>
inline constexpr auto kFitted = through(&MapReport::built, &BuiltMap::fit, kMember);

template <>
inline constexpr auto kDescribed<MapReport> =
    described(
        field("method", &MapReport::method, "adjustment, elastic, elastic-printed or gauss-markov"),
        field(
            "verdict", [](const MapReport& one) { return verdict_of(*one.built); },
            "doubtful where anything speaks against the map: see warnings")
            .one_of("good | doubtful"),
        field("legs", kBuilt<&BuiltMap::legs>, "drives between landmarks").at_least(0.0),
        field("landmarks", kOfMap<&LandmarkGraph::landmarks>, "of the map").at_least(0.0),
        field("routes", kOfMap<&LandmarkGraph::routes>, "of the map").at_least(0.0),
        field("first_sight", kBuilt<&BuiltMap::first_sight>, "loops closed").at_least(0.0),
        field("refinements", kBuilt<&BuiltMap::refinements>, "known routes driven again")
            .at_least(0.0),
        field("side_sightings", kBuilt<&BuiltMap::side_sightings>,
              "routes from a leg's end to what else was seen there")
            .at_least(0.0),
        field("rejected", kBuilt<&BuiltMap::rejected>, "sightings left out"),
        field("unconfirmed", kBuilt<&BuiltMap::unconfirmed>,
              "landmarks that one sighting from afar alone has"),
        field("freed", kBuilt<&BuiltMap::freed>,
              "systematic errors that the model lacks, estimated beside the map"),
        field("quality", kBuilt<&BuiltMap::quality>, "how good the map is, without a survey"),
        field(
            "positions", [](const MapReport& one) { return positions(one.built->map); },
            "by landmark"),
        field("warnings", kBuilt<&BuiltMap::warnings>,
              "what speaks against the map, and the remedy"),
        field("notes", kBuilt<&BuiltMap::notes>, "what is worth knowing besides"),
        field("chi2", kFitted<&MapFit::chi2>, "of the adjustment, over the measurements kept"),
        field("dof", kFitted<&MapFit::dof>, "its degrees of freedom"),
        share("p_value", kFitted<&MapFit::p_value>,
              "chance of a chi2 as large where the model is right"),
        field("iterations", kFitted<&MapFit::iterations>, "of the adjustment").at_least(0.0),
        field("converged", kFitted<&MapFit::converged>, "whether they ended in a minimum"),
        field(
            "relaxed",
            [](const MapReport& one) {
              return one.built->method == Method::adjustment ? std::nullopt
                                                             : std::optional(one.built->relaxed);
            },
            "leg by leg: the whole came to equilibrium at the end")
            .if_any(),
        field(
            "tours", [](const MapReport& one) { return grown_tours(*one.built); },
            "leg by leg and surveyed: errors of the map as it then was, after the best rotation "
            "and translation, each time all its routes had been driven")
            .if_any(),
        field("survey", kBuilt<&BuiltMap::on_survey>,
              "where three landmarks of the map were surveyed")
            .if_any(),
        field("paths", kBuilt<&BuiltMap::paths>, "of recordings without landmarks").if_any())
        .named("build");

/// What build says of a session that a store has got.
struct AddedSession {
  MapReport report;
  std::string recording;
};
template <>
inline constexpr auto kDescribed<AddedSession> =
    described(keys_of("report", &AddedSession::report),
              field("recording", &AddedSession::recording, "its name"));

/// What build --store says.
struct StoreReport {
  std::string store;
  std::string method;
  const LandmarkGraph* map = nullptr;
  std::size_t sessions = 0;
  std::int64_t legs = 0;
  std::size_t left_out = 0;
  std::vector<AddedSession> added;
};
template <>
inline constexpr auto kDescribed<StoreReport> = described(
    field("store", &StoreReport::store, "its file"),
    field("method", &StoreReport::method, "adjustment, elastic, elastic-printed or gauss-markov"),
    field(
        "landmarks", [](const StoreReport& one) { return one.map->landmarks(); }, "of the map")
        .at_least(0.0),
    field(
        "routes", [](const StoreReport& one) { return one.map->routes(); }, "of the map")
        .at_least(0.0),
    field("sessions", &StoreReport::sessions, "in the store"),
    field("legs", &StoreReport::legs, "calls kept").at_least(0.0),
    field("left_out", &StoreReport::left_out, "arrivals that contradict the map"),
    field(
        "positions", [](const StoreReport& one) { return positions(*one.map); }, "by landmark"),
    field("added", &StoreReport::added,
          "the keys of build for each recording, of it alone but for the map"));

}  // namespace trussmap::results
