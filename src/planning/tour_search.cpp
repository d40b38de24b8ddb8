// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "planning/tour_search.hpp"

#include "geometry/index.hpp"
#include "parallel/parallel_for.hpp"
#include "trussmap/error.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <set>
#include <stdexcept>
#include <utility>

namespace trussmap::planning {
namespace {

constexpr double kLeastGain = 1e-5;  // of a score, that a leg is worth
constexpr int kRefinements = 3;      // manoeuvres changed on a leg
constexpr std::size_t kAtOnce = 8;   // tours that are looked at together
constexpr std::size_t kThoroughLegs = 24;

void weigh(const SearchTask& task, TourValue& value) {
  value.least = 1.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < task.questions.size(); ++k) {
    const double share = std::min(1.0, value.lambdas[k] / task.questions[k].wanted);
    value.least = std::min(value.least, share);
    sum += std::sqrt(share);
  }
  const auto count = static_cast<double>(std::max<std::size_t>(1, task.questions.size()));
  value.score = sum / count + std::sqrt(value.least);
}

class Search {
 public:
  explicit Search(const SearchTask& task) : task_(task) {}

  FoundTour run() {
    FoundTour found{{task_.world.start, {}}, {}, {}};
    found.value.lambdas = lambdas_of(task_, gram_before(task_));
    weigh(task_, found.value);
    const std::size_t most = task_.goes_on ? kMostLegsAlong : kMostLegs;
    while (found.value.least < 1.0 && found.tour.legs.size() < most) {
      std::optional<FoundTour> next = extended(found);
      if (!next) break;
      found = std::move(*next);
    }
    trim(found);
    return found;
  }

 private:
  [[nodiscard]] bool within(const TourValue& value) const {
    return value.time <= task_.most_time && value.length <= task_.most_length;
  }

  using Informing = std::function<std::optional<DriveInformation>(const PlannedTour&)>;

  /// Several tours, of which `informs` says what they tell; nothing of those that cannot be driven,
  /// or take too long.
  [[nodiscard]] std::vector<std::optional<FoundTour>> found_by(
      const std::vector<PlannedTour>& tours, const Informing& informs) const {
    std::vector<std::optional<FoundTour>> all(tours.size());
    parallel::parallel_for(tours.size(), [&](std::size_t k) {
      const DrivePlan plan = plan_of(task_.world, tours[k]);
      FoundTour found{tours[k], {}, {}};
      found.value.time = plan_duration(plan);
      found.value.length = plan_length(plan);
      if (!within(found.value)) return;
      std::optional<DriveInformation> told = informs(tours[k]);
      if (!told) return;
      found.told = std::move(*told);
      found.value.lambdas = lambdas_of(task_, gram_of(sum_of(task_.known, found.told)));
      weigh(task_, found.value);
      all[k] = std::move(found);
    });
    return all;
  }

  [[nodiscard]] std::vector<std::optional<FoundTour>> exactly(
      const std::vector<PlannedTour>& tours) const {
    return found_by(tours, [this](const PlannedTour& one) { return told_by(task_, one); });
  }

  /// What tours tell that go on from this one by a leg: from the leg before it on.
  [[nodiscard]] Informing going_on_from(const FoundTour& found) const {
    const std::size_t legs = found.tour.legs.size();
    if (task_.goes_on || legs < 2) {
      return [this](const PlannedTour& one) { return told_by(task_, one); };
    }
    const PlannedTour last{found.tour.landmark(legs - 1), {found.tour.legs.back()}};
    const auto alone = told_by(task_, last);
    return [this, &found, last, alone](const PlannedTour& one) -> std::optional<DriveInformation> {
      PlannedTour both = last;
      both.legs.push_back(one.legs.back());
      std::optional<DriveInformation> more = told_by(task_, both);
      if (!more || !alone) return std::nullopt;
      DriveInformation less = *alone;
      less.H = -less.H;
      return sum_of(sum_of(found.told, *more), less);
    };
  }

  /// The best by gain per second over `before`; nothing where none gains.
  [[nodiscard]] std::optional<FoundTour> best_of(const FoundTour& before,
                                                 const std::vector<PlannedTour>& tours,
                                                 const Informing& informs,
                                                 double than = 0.0) const {
    std::optional<FoundTour> best;
    for (std::optional<FoundTour>& one : found_by(tours, informs)) {
      if (!one || one->value.score < before.value.score + kLeastGain) continue;
      const double rate = rate_of(before.value, one->value);
      if (rate <= than * (1.0 + 1e-9)) continue;
      than = rate;
      best = std::move(one);
    }
    return best;
  }

  [[nodiscard]] static double rate_of(const TourValue& before, const TourValue& after) {
    return (after.score - before.score) / std::max(1e-6, after.time - before.time);
  }

  /// With one leg more.
  [[nodiscard]] std::optional<FoundTour> extended(const FoundTour& found) const {
    std::vector<PlannedTour> tours;
    const auto add = [&](const Manoeuvre& leg) {
      tours.push_back(found.tour);
      tours.back().legs.push_back(leg);
    };
    const int here = found.tour.landmark(found.tour.legs.size());
    for (const int to : task_.world.exits[idx(here)]) {
      const Manoeuvre plain = plain_leg(task_.world, found.tour, to);
      add(plain);
      for (const Manoeuvre& other : variants_of(task_.world, plain)) add(other);
    }
    const Informing informs = going_on_from(found);
    std::optional<FoundTour> best = best_of(found, tours, informs);
    for (int pass = 0; best && pass < kRefinements; ++pass) {
      tours.clear();
      for (const Manoeuvre& other : variants_of(task_.world, best->tour.legs.back())) add(other);
      std::optional<FoundTour> better =
          best_of(found, tours, informs, rate_of(found.value, best->value));
      if (!better) break;
      best = std::move(better);
    }
    return best ? exactly({best->tour}).front() : std::nullopt;
  }

  /// Tours that are the same with something left out: a loop, the last leg, a manoeuvre.
  [[nodiscard]] std::vector<PlannedTour> shorter_than(const PlannedTour& tour) const {
    std::vector<PlannedTour> tours;
    for (std::size_t first = 0; first < tour.legs.size(); ++first) {
      for (std::size_t last = first + 1; last <= tour.legs.size(); ++last) {
        const bool closed = tour.landmark(first) == tour.landmark(last);
        if (!closed && last < tour.legs.size()) continue;
        if (!closed && last - first > 1) continue;
        PlannedTour other = tour;
        other.legs.erase(other.legs.begin() + static_cast<std::ptrdiff_t>(first),
                         other.legs.begin() + static_cast<std::ptrdiff_t>(last));
        if (!other.legs.empty()) tours.push_back(std::move(other));
      }
    }
    for (std::size_t leg = 0; leg < tour.legs.size(); ++leg) {
      for (const Manoeuvre& otherwise : variants_of(task_.world, tour.legs[leg])) {
        PlannedTour other = tour;
        other.legs[leg] = otherwise;
        tours.push_back(std::move(other));
      }
    }
    return tours;
  }

  /// As long as something can be left out at no loss: of a tour that answers all, which is then as
  /// short as it can be made so.
  void trim(FoundTour& found) const {
    constexpr int kMostPasses = 40;
    for (int pass = 0; pass < kMostPasses && found.value.least >= 1.0; ++pass) {
      std::vector<PlannedTour> tours = shorter_than(found.tour);
      std::vector<std::pair<double, std::size_t>> order;
      for (std::size_t k = 0; k < tours.size(); ++k) {
        const double time = plan_duration(plan_of(task_.world, tours[k]));
        if (time < found.value.time - 1e-6) order.emplace_back(time, k);
      }
      std::sort(order.begin(), order.end());
      std::optional<FoundTour> shorter;
      for (std::size_t first = 0; first < order.size() && !shorter; first += kAtOnce) {
        std::vector<PlannedTour> some;
        for (std::size_t k = first; k < std::min(order.size(), first + kAtOnce); ++k) {
          some.push_back(tours[order[k].second]);
        }
        for (std::optional<FoundTour>& one : exactly(some)) {
          if (!shorter && one && one->value.least >= 1.0) shorter = std::move(one);
        }
      }
      if (!shorter) return;
      found = std::move(*shorter);
    }
  }

  const SearchTask& task_;
};

}  // namespace

Eigen::MatrixXd gram_before(const SearchTask& task) {
  return gram_of(task.known);
}

Eigen::MatrixXd gram_with(const SearchTask& task, const PlanWorld& world, const DrivePlan& plan) {
  return gram_of(sum_of(task.known,
                        information_of(planned_fit(world, plan), {task.effects, task.own, false})));
}

std::vector<double> lambdas_of(const SearchTask& task, const Eigen::MatrixXd& gram) {
  std::vector<double> lambdas;
  for (const Question& one : task.questions) {
    lambdas.push_back(separation(gram, one, task.beside, task.phi));
  }
  return lambdas;
}

std::optional<DriveInformation> told_by(const SearchTask& task, const PlannedTour& tour) {
  try {
    return information_of(planned_fit(task.world, plan_of(task.world, tour)),
                          {task.effects, task.own, false});
  } catch (const std::invalid_argument&) {  // a bend sharper than the robot's, and the like
    return std::nullopt;
  } catch (const SolveError&) {
    return std::nullopt;
  }
}

FoundTour search_tour(const SearchTask& task) {
  return Search(task).run();
}

PlannedTour thorough_tour(const PlanWorld& world) {
  PlannedTour tour{world.start, {}};
  std::set<std::pair<int, int>> driven;
  for (std::size_t k = 0; k < kThoroughLegs; ++k) {
    const int here = tour.landmark(k);
    const std::vector<int>& exits = world.exits[idx(here)];
    const auto undriven = std::find_if(exits.begin(), exits.end(), [&](int to) {
      return !driven.contains({here, to});
    });
    const int to = undriven == exits.end() ? exits[k % exits.size()] : *undriven;
    driven.insert({here, to});
    Manoeuvre leg = plain_leg(world, tour, to);
    leg.speed = world.speeds[k % world.speeds.size()];
    leg.rate = world.turn_rates[(k / 2) % world.turn_rates.size()];
    leg.turns = std::array<int, 4>{2, -2, 0, 0}[k % 4];
    leg.bend = std::array<double, 5>{0.0, 0.0, kBend, 0.0, -kBend}[k % 5];
    leg.stand = k == 5 ? kLongStand : k % 6 == 5 ? kStand : 0.0;
    for (std::size_t load = 0; load < world.loads.size(); ++load) {
      const std::vector<double>& levels = world.loads[load].levels;
      leg.loads[load] = levels[(k / (load + 3)) % levels.size()];
    }
    tour.legs.push_back(std::move(leg));
  }
  return tour;
}

}  // namespace trussmap::planning
