// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "criticism/diagnosis.hpp"

#include "criticism/local_dispersion.hpp"
#include "recording/slow_covariates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <numeric>

#include <Eigen/QR>

namespace trussmap {
namespace {

constexpr double kPractical = 0.05;  // rise of the arrival error
constexpr double kLookAlike = 0.95;
constexpr double kSecondLevel = 0.02;
constexpr double kSecondShare = 0.002;
constexpr std::size_t kMostLookAlikes = 12;
constexpr std::size_t kFamiliesRefined = 3;
constexpr std::size_t kChunk = 48;  // candidates
constexpr double kWorthALook = 0.01;
constexpr double kLargestPriorSd = 3.0;
constexpr double kLawLevel = 0.01;
constexpr double kStays = 0.001;  // p, with the others there
constexpr std::size_t kMostEvents = 8;

/// A candidate's test, without its columns.
struct Tested {
  Candidate candidate;
  Score score;
  Eigen::MatrixXd slopes;  ///< of the held-out legs
  int tried = 1;
  /// Of the score, what the members tried had found before shape parameters were refined: all that
  /// is paid for by their number, and so all that speaks for there being an effect.
  double share_found = 1.0;
  double dispersion = 1.0;  ///< of the rows that speak for it
  double evidence = 0.0;
  double p_value = 1.0;
  double p_adjusted = 1.0;
};

/// Runs score tests chunk by chunk, so that no more than a chunk's columns are held.
template <typename Visit>
void visit_scores(const ScoreTest& tests, const std::vector<Candidate>& candidates,
                  Resolution resolution, const Visit& visit) {
  for (std::size_t first = 0; first < candidates.size(); first += kChunk) {
    const std::size_t end = std::min(candidates.size(), first + kChunk);
    std::vector<Effect> effects;
    for (std::size_t k = first; k < end; ++k) effects.push_back(candidates[k].effect);
    std::vector<Score> scores = tests.test(effects, resolution);
    for (std::size_t k = first; k < end; ++k) visit(k, scores[k - first]);
  }
}

void drop_columns(Score& score) {
  score.columns.resize(0, 0);
  score.projected.resize(0, 0);
  score.landmarks.resize(0, 0);
}

class Diagnostician {
 public:
  Diagnostician(const std::vector<Recording>& recordings, const ModelFit& fit,
                const DiagnosisOptions& options)
      : fit_(fit), options_(options), tests_(fit), dispersion_(fit, tests_) {
    legs_ = std::make_unique<HeldOutLegs>(recordings, fit, fit_options(options), options.legs);
    predictable_ = legs_->same_layout(fit.problem);
  }

  Diagnosis run() {
    result_.chi2 = fit_.adjustment.chi2;
    result_.dof = fit_.adjustment.dof;
    result_.warnings = fit_.adjustment.warnings;
    result_.held_out = legs_->metrics();
    test_all();
    judge(tested_, result_.chi2, result_.dof);
    refine_families();
    judge(tested_, result_.chi2, result_.dof);
    find_missing();
    result_.events = test_events(fit_, tests_, nuisance_);
    result_.noise = test_noise_laws(fit_, tests_, nuisance_);
    report();
    return std::move(result_);
  }

 private:
  void test_all() {
    const std::vector<Candidate> candidates = candidates_for(fit_, tests_.context());
    result_.tried = static_cast<int>(candidates.size());
    std::vector<Candidate> members;
    std::vector<Candidate> tested;
    for (const Candidate& one : candidates) (one.family.empty() ? tested : members).push_back(one);
    struct Best {
      std::size_t member = 0;
      double score = -1.0;
      int tried = 0;
    };
    std::map<std::string, Best> families;
    visit_scores(tests_, members, Resolution::quick, [&](std::size_t k, const Score& score) {
      Best& best = families[members[k].family];
      ++best.tried;
      if (score.score > best.score) best = {k, score.score, best.tried};
    });
    for (const auto& [name, best] : families) tested.push_back(members[best.member]);
    visit_scores(tests_, tested, Resolution::screening, [&](std::size_t k, Score& score) {
      tested_.emplace_back();
      take(tested_.back(), tested[k], score);
      if (!tested[k].family.empty()) tested_.back().tried = families[tested[k].family].tried;
    });
  }

  void take(Tested& tested, const Candidate& candidate, Score& score) {
    tested.candidate = candidate;
    tested.dispersion = dispersion_of(score, dispersion_);
    if (predictable_ && score.dof > 0) {
      tested.slopes = legs_->slopes(score.columns, score.landmarks);
    }
    drop_columns(score);
    tested.score = score;
  }

  [[nodiscard]] static double dispersion_of(const Score& score, const LocalDispersion& local) {
    return score.dof > 0 && score.p_value < kWorthALook ? local(score) : 1.0;
  }

  /// Log of what an effect of unknown size pays for having been fitted: sizes from the smallest
  /// that shows to a hundred times that are equally likely on a logarithmic scale, so that no unit
  /// and no belief about a size comes between look-alikes.
  [[nodiscard]] static double penalty(double score, int dof) {
    constexpr double kLogRange = 1.3;  // log(2 log(100) / sqrt(2 pi))
    return dof * (kLogRange + 0.5 * std::log(1.0 + score / std::max(1, dof)));
  }

  /// The same for shape parameters: found on a grid, then refined.
  [[nodiscard]] static double search_penalty(double score, const Tested& one) {
    return std::log(static_cast<double>(one.tried)) +
           0.5 * static_cast<double>(one.candidate.parameters.size()) * std::log(1.0 + score);
  }

  /// p-values against the dispersion that each would leave, as a whole and where it acts; evidence
  /// against the least there is.
  void judge(std::vector<Tested>& tested, double chi2, int dof) const {
    double least = std::max(1.0, chi2 / std::max(1, dof));
    for (Tested& one : tested) {
      one.p_value = 1.0;
      if (one.score.dof == 0) continue;
      const double left =
          std::max(1.0, (chi2 - one.score.score) / std::max(1, dof - one.score.dof));
      one.p_value = chi2_p_value(one.share_found * one.score.score / std::max(left, one.dispersion),
                                 one.score.dof);
      least = std::min(least, left);
    }
    std::vector<std::size_t> order(tested.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return tested[a].p_value < tested[b].p_value;
    });
    double remaining = static_cast<double>(result_.tried);
    double most = 0.0;
    for (const std::size_t k : order) {
      Tested& one = tested[k];
      most = std::max(most, std::min(1.0, remaining * one.p_value));
      one.p_adjusted = most;
      remaining -= one.tried;
      // What noise in these very rows would claim is a matter of p: an effect whose rows another
      // effect moves as well is as large as it is.
      const double net = one.score.score / least;
      one.evidence = 0.5 * net - penalty(net, one.score.dof) + one.candidate.log_prior;
      if (!one.candidate.parameters.empty()) one.evidence -= search_penalty(net, one);
      if (one.score.dof == 0) one.evidence = -1e300;
    }
  }

  /// Looks for better shape parameters of the most promising families.
  void refine_families() {
    std::vector<Tested*> families;
    for (Tested& one : tested_) {
      if (!one.candidate.parameters.empty() && one.score.dof > 0 && one.p_adjusted < 0.5) {
        families.push_back(&one);
      }
    }
    std::stable_sort(families.begin(), families.end(),
                     [](const Tested* a, const Tested* b) { return a->evidence > b->evidence; });
    // What refining may add to a score is bounded: a place that explains little is not the one.
    double best = 0.0;
    for (const Tested& one : tested_) best = std::max(best, one.score.score);
    std::erase_if(families, [&](const Tested* one) { return 2.0 * one->score.score < best; });
    if (families.size() > kFamiliesRefined) families.resize(kFamiliesRefined);
    for (Tested* one : families) refine(*one);
  }

  void refine(Tested& tested) {
    const Candidate better = refined(tests_, tested.candidate);
    if (better.parameters == tested.candidate.parameters) return;
    Score score = tests_.test({better.effect}).front();
    const double found = tested.score.score;
    take(tested, better, score);
    tested.share_found = std::min(1.0, found / std::max(tested.score.score, 1e-300));
  }

  /// What would have to be far larger than anything known is none, but for a plain factor: a
  /// wheelbase may be given quite wrong.
  [[nodiscard]] static bool implausible(const Tested& one) {
    if (one.candidate.effect.is_constant()) return false;
    const double prior_sd = facts_of(one.candidate.effect.channel).prior_sd;
    for (std::size_t k = 0; k < one.score.coefficients.size(); ++k) {
      if (std::abs(one.score.coefficients[k]) * one.score.largest[k] > kLargestPriorSd * prior_sd) {
        return true;
      }
    }
    return false;
  }

  [[nodiscard]] static const Tested* best_of(const std::vector<Tested>& tested, double level) {
    const Tested* best = nullptr;
    for (const Tested& one : tested) {
      if (one.score.dof == 0 || one.p_adjusted >= level || implausible(one)) continue;
      if (best == nullptr || one.evidence > best->evidence) best = &one;
    }
    return best;
  }

  /// Asks anew of those (by place in `still`) for which `wanted` holds.
  template <typename Wanted>
  static void ask_again(const ModelFit& fit, const ScoreTest& left, std::vector<Tested>& still,
                        const Wanted& wanted) {
    std::vector<std::size_t> places;
    std::vector<Candidate> candidates;
    for (std::size_t k = 0; k < still.size(); ++k) {
      if (!wanted(still[k])) continue;
      places.push_back(k);
      candidates.push_back(still[k].candidate);
    }
    const LocalDispersion local(fit, left);
    visit_scores(left, candidates, Resolution::screening, [&](std::size_t k, Score& score) {
      Tested& one = still[places[k]];
      one.dispersion = dispersion_of(score, local);
      drop_columns(score);
      one.score = score;
    });
  }

  /// The law of noise that explains more than any effect does, if there is one.
  [[nodiscard]] const NoiseTest* leading_law(const std::vector<NoiseTest>& laws) const {
    double most = 0.0;
    for (const Tested& one : tested_) {
      if (one.p_adjusted < options_.level) most = std::max(most, one.score.score);
    }
    for (const NoiseTest& law : laws) {
      if (law.unit.empty() || law.p_adjusted >= kLawLevel) continue;  // a shape, or chance
      return law.score > most ? &law : nullptr;
    }
    return nullptr;
  }

  /// Laws of noise and single events that have a better claim than any effect come before them.
  /// `still`: the effects, asked of what is left. A whole session that is out of line is not among
  /// the events: what goes with a session's load is an effect.
  void let_others_claim(ScoreTest& left, const ModelFit& ground, std::vector<Tested>& still) {
    const auto significant = [this](const Tested& one) {
      return one.score.dof > 0 && one.p_adjusted < options_.level;
    };
    int dof = result_.dof;
    if (&ground != &fit_) {
      ask_again(ground, left, still, [](const Tested&) { return true; });
      judge(still, left.residuals().squaredNorm(), dof);
    }
    Eigen::MatrixXd nuisance(left.residuals().size(), 0);
    for (std::size_t k = 0; k < kMostEvents; ++k) {
      if (best_of(still, options_.level) == nullptr) return;
      double p = 1.0;
      for (const Tested& one : still) {
        if (one.score.dof > 0 && !implausible(one)) p = std::min(p, one.p_adjusted);
      }
      const std::vector<EventTest> events = test_events(ground, left, nuisance);
      const auto event = std::find_if(events.begin(), events.end(), [](const EventTest& one) {
        return one.kind != "session" && one.projected.cols() > 0;
      });
      if (event == events.end() || event->p_adjusted >= p) return;
      left.condition_on(event->projected);
      append(nuisance, event->projected);
      dof -= event->dof;
      std::vector<double> p_before;
      for (const Tested& one : still) p_before.push_back(one.p_adjusted);
      ask_again(ground, left, still, significant);
      judge(still, left.residuals().squaredNorm(), dof);
      // Those not asked again cannot have become better.
      for (std::size_t j = 0; j < still.size(); ++j) {
        still[j].p_adjusted = std::max(still[j].p_adjusted, p_before[j]);
      }
    }
  }

  static void append(Eigen::MatrixXd& columns, const Eigen::MatrixXd& more) {
    columns.conservativeResize(more.rows(), columns.cols() + more.cols());
    columns.rightCols(more.cols()) = more;
  }

  /// The best, then the best of what is left when it is taken out, and so on.
  void find_missing() {
    if (best_of(tested_, options_.level) == nullptr) return;
    const std::vector<NoiseTest> laws = test_noise_laws(fit_, tests_);
    const NoiseTest* law = leading_law(laws);
    const std::optional<ModelFit> noisier =
        law != nullptr ? std::optional(with_noise(fit_, tests_, *law)) : std::nullopt;
    const ModelFit& ground = noisier ? *noisier : fit_;
    ScoreTest left = noisier ? ScoreTest(ground) : tests_;
    std::vector<Tested> still = tested_;
    let_others_claim(left, ground, still);
    for (std::size_t k = 0; k < still.size(); ++k) {
      tested_[k].p_value = still[k].p_value;
      tested_[k].p_adjusted = still[k].p_adjusted;
    }
    int dof = result_.dof;
    const double at_first = left.residuals().squaredNorm();
    while (missing_.size() < options_.most_missing) {
      // What a first effect leaves for being so large is no second one.
      const double level = missing_.empty() ? options_.level : kSecondLevel * options_.level;
      const Tested* best = best_of(still, level);
      if (best == nullptr) break;
      const double chi2 = left.residuals().squaredNorm();
      if (!missing_.empty() && best->score.score < kSecondShare * (at_first - chi2)) break;
      const auto at = static_cast<std::size_t>(best - still.data());
      missing_.push_back(at);
      const Score whole = tests_.test({tested_[at].candidate.effect}).front();
      left.condition_on(left.columns(tested_[at].candidate.effect));
      append(nuisance_, whole.projected);
      dof -= whole.dof;
      if (missing_.size() == options_.most_missing) break;
      ask_again(ground, left, still, [](const Tested&) { return true; });
      judge(still, left.residuals().squaredNorm(), dof);
    }
    std::stable_sort(missing_.begin(), missing_.end(), [this](std::size_t a, std::size_t b) {
      return tested_[a].evidence > tested_[b].evidence;
    });
    estimate_jointly();
    drop_what_others_explain();
    for (const std::size_t one : missing_) look_alikes_.push_back(look_alikes_of(one));
  }

  /// Of effects that are found one after the other, a later one may be all that there is.
  void drop_what_others_explain() {
    while (missing_.size() > 1) {
      const auto weakest =
          std::max_element(joint_.begin(), joint_.end(),
                           [](const Score& a, const Score& b) { return a.p_value < b.p_value; });
      if (weakest->p_value < kStays) return;
      missing_.erase(missing_.begin() + (weakest - joint_.begin()));
      estimate_jointly();
    }
  }

  /// Sizes of all that is missing, each with the others there.
  void estimate_jointly() {
    joint_.clear();
    for (const std::size_t one : missing_) {
      ScoreTest others = tests_;
      for (const std::size_t other : missing_) {
        if (other != one) others.condition_on(tests_.columns(tested_[other].candidate.effect));
      }
      Score score = others.test({tested_[one].candidate.effect}).front();
      if (score.dof == 0) score = tested_[one].score;
      drop_columns(score);
      joint_.push_back(std::move(score));
    }
  }

  /// A free form that happens to hold the winner's shape is no rival to a catalogue effect.
  [[nodiscard]] static bool is_rival(const Candidate& one, const Candidate& winner) {
    if (one.form == Form::catalogue || one.form == Form::line) return true;
    return winner.form != Form::catalogue && winner.form != Form::line && one.form == winner.form;
  }

  [[nodiscard]] std::vector<LookAlike> look_alikes_of(std::size_t at) const {
    std::vector<LookAlike> same_layout;
    const Score winner = tests_.test({tested_[at].candidate.effect}).front();
    Eigen::VectorXd trace = Eigen::VectorXd::Zero(winner.projected.rows());
    for (std::size_t k = 0; k < winner.coefficients.size(); ++k) {
      trace += winner.coefficients[k] * winner.projected.col(static_cast<Eigen::Index>(k));
    }
    const double length = trace.norm();
    if (length == 0.0) return same_layout;
    std::vector<Candidate> rivals;
    for (std::size_t k = 0; k < tested_.size(); ++k) {
      const Candidate& one = tested_[k].candidate;
      if (k != at && is_rival(one, tested_[at].candidate)) rivals.push_back(one);
    }
    visit_scores(tests_, rivals, Resolution::exact, [&](std::size_t k, const Score& score) {
      if (score.dof == 0) return;
      const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factor(score.projected);
      const double cosine = (score.projected * factor.solve(trace)).norm() / length;
      if (cosine >= kLookAlike) same_layout.push_back({rivals[k].effect, std::min(1.0, cosine)});
    });
    std::stable_sort(same_layout.begin(), same_layout.end(),
                     [](const LookAlike& a, const LookAlike& b) { return a.cosine > b.cosine; });
    if (same_layout.size() > kMostLookAlikes) same_layout.resize(kMostLookAlikes);
    return same_layout;
  }

  /// What the effect of such coefficients moves the held-out legs by; empty where not known.
  [[nodiscard]] static Eigen::VectorXd moves(const Tested& one,
                                             const std::vector<double>& coefficients) {
    if (one.slopes.size() == 0) return {};
    return one.slopes * Eigen::Map<const Eigen::VectorXd>(coefficients.data(), one.slopes.cols());
  }

  [[nodiscard]] HeldOutMetrics predicted(const Eigen::VectorXd& moved) const {
    return moved.size() == 0 ? metrics_of(result_.held_out) : metrics_of(legs_->moved(moved));
  }

  [[nodiscard]] HeldOutMetrics predicted(const Tested& one) const {
    return predicted(moves(one, one.score.coefficients));
  }

  [[nodiscard]] HeldOutMetrics predicted_with_missing() const {
    Eigen::VectorXd moved;
    for (std::size_t k = 0; k < missing_.size(); ++k) {
      const Eigen::VectorXd own = moves(tested_[missing_[k]], joint_[k].coefficients);
      if (own.size() == 0) continue;
      moved = moved.size() == 0 ? own : Eigen::VectorXd(moved + own);
    }
    return predicted(moved);
  }

  /// Relative rise of the arrival error over `floor` that a shape's smallest detectable size makes;
  /// the most of any shape.
  [[nodiscard]] double detectable_rise(const Tested& one, double floor) const {
    double most = 0.0;
    for (Eigen::Index k = 0; k < one.slopes.cols(); ++k) {
      const double size = one.score.minimal_detectable[static_cast<std::size_t>(k)];
      if (!std::isfinite(size)) return size;
      double squares = 0.0;
      const Eigen::Index legs = one.slopes.rows() / 6;
      for (Eigen::Index leg = 0; leg < legs; ++leg) {
        squares += one.slopes.col(k).segment<2>(6 * leg).squaredNorm();
      }
      const double moved =
          size * std::sqrt(squares / static_cast<double>(std::max<Eigen::Index>(1, legs)));
      most = std::max(most, std::hypot(1.0, moved / floor) - 1.0);
    }
    return one.slopes.cols() > 0 ? most : std::numeric_limits<double>::infinity();
  }

  [[nodiscard]] Status status_of(std::size_t k, const HeldOutMetrics& with_it, double floor) const {
    const Tested& one = tested_[k];
    if (std::find(missing_.begin(), missing_.end(), k) != missing_.end()) {
      const bool changes_nothing =
          predictable_ && !result_.held_out.legs.empty() && fit_.adjustment.p_value > 0.05 &&
          with_it.arrival_rms > (1.0 - 0.002) * result_.held_out.arrival_rms &&
          detectable_rise(one, floor) < 0.002;
      return changes_nothing ? Status::negligible : Status::missing;
    }
    if (one.score.dof == 0) return Status::cannot_tell;
    const auto is_this = [&](const LookAlike& other) {
      return other.effect.name == one.candidate.effect.name &&
             other.effect.shape == one.candidate.effect.shape;
    };
    for (const std::vector<LookAlike>& rivals : look_alikes_) {
      if (std::any_of(rivals.begin(), rivals.end(), is_this)) return Status::cannot_tell;
    }
    return detectable_rise(one, floor) <= kPractical ? Status::absent : Status::cannot_tell;
  }

  /// Not seen, but would be where the model explained the rest.
  [[nodiscard]] static bool hidden_by_misfit(const Tested& one) {
    const double prior_sd = facts_of(one.candidate.effect.channel).prior_sd * kLargestUncertainty;
    for (std::size_t k = 0; k < one.score.share.size(); ++k) {
      if (one.score.largest[k] > 0.0 && one.score.share[k] > kLeastShare &&
          one.score.largest[k] < prior_sd * std::sqrt(one.score.information[k])) {
        return true;
      }
    }
    return false;
  }

  void report() {
    std::vector<std::size_t> order(tested_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto rank = [this](std::size_t k) {
      return static_cast<std::size_t>(std::find(missing_.begin(), missing_.end(), k) -
                                      missing_.begin());
    };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      if (rank(a) != rank(b)) return rank(a) < rank(b);
      return tested_[a].evidence > tested_[b].evidence;
    });
    result_.with_missing = predicted_with_missing();
    const double floor = missing_.empty() ? result_.held_out.arrival_rms
                                          : predicted(tested_[missing_.front()]).arrival_rms;
    for (const std::size_t k : order) {
      const Tested& one = tested_[k];
      if (one.score.dof == 0) {
        if (one.candidate.form == Form::catalogue && !hidden_by_misfit(one) &&
            !tests_.is_present(one.candidate.effect)) {
          result_.unobservable.push_back(why_unobservable(one.candidate.effect, fit_, one.score));
        }
        continue;
      }
      Finding finding;
      finding.candidate = one.candidate;
      finding.candidate.effect.coefficients = one.score.coefficients;
      finding.score = one.score.score;
      finding.dof = one.score.dof;
      finding.p_value = one.p_value;
      finding.p_adjusted = one.p_adjusted;
      finding.evidence = one.evidence;
      finding.sd = one.score.sd;
      finding.minimal_detectable = one.score.minimal_detectable;
      finding.tried = one.tried;
      finding.held_out = predicted(one);
      finding.status = status_of(k, finding.held_out, floor);
      if (rank(k) < missing_.size()) {
        finding.look_alikes = look_alikes_[rank(k)];
        finding.joint = joint_[rank(k)].coefficients;
        finding.joint_sd = joint_[rank(k)].sd;
      }
      result_.findings.push_back(std::move(finding));
    }
    result_.p_value = chi2_p_value(result_.chi2, result_.dof);
    if (!missing_.empty()) {
      const Finding& first = result_.findings.front();
      result_.verdict = Diagnosis::Verdict::missing;
      result_.missing = first.candidate.effect.name;
      result_.p_value = first.p_adjusted;
      for (const LookAlike& rival : first.look_alikes) {
        result_.next_drive = separating_drive(first.candidate.effect, rival.effect,
                                              slow_covariates(fit_.recordings));
        if (!result_.next_drive.empty()) break;
      }
    } else if (result_.p_value < 0.01) {
      result_.verdict = Diagnosis::Verdict::unexplained_misfit;
    }
  }

  const ModelFit& fit_;
  const DiagnosisOptions& options_;
  ScoreTest tests_;
  LocalDispersion dispersion_;
  std::unique_ptr<HeldOutLegs> legs_;
  bool predictable_ = false;
  std::vector<Tested> tested_;
  std::vector<std::size_t> missing_;                 ///< of tested_, best first
  std::vector<std::vector<LookAlike>> look_alikes_;  ///< of each that is missing
  std::vector<Score> joint_;                         ///< of each that is missing
  Eigen::MatrixXd nuisance_;                         ///< projected columns of what is missing
  Diagnosis result_;
};

}  // namespace

std::string_view name_of(Status status) {
  switch (status) {
    case Status::missing:
      return "missing";
    case Status::absent:
      return "absent";
    case Status::negligible:
      return "negligible";
    case Status::cannot_tell:
      break;
  }
  return "cannot tell";
}

ModelFitOptions fit_options(const DiagnosisOptions& options) {
  ModelFitOptions how;
  how.problem = options.problem;
  how.gate = options.gate;
  return how;
}

HeldOutMetrics metrics_of(const HeldOut& held_out) {
  return {held_out.arrival_rms, held_out.stretch_error, held_out.orientation_error};
}

Diagnosis diagnose(const std::vector<Recording>& recordings, const ModelFit& fit,
                   const DiagnosisOptions& options) {
  return Diagnostician(recordings, fit, options).run();
}

Diagnosis diagnose(const std::vector<Recording>& recordings, const Model& model,
                   const DiagnosisOptions& options) {
  const ModelFit fit = fit_model(recordings, model, fit_options(options));
  Diagnosis result = diagnose(recordings, fit, options);
  result.advice = advice_on(recordings, model, options.problem);
  return result;
}

}  // namespace trussmap
