// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "estimation/noise_states.hpp"
#include "estimation/student_tails.hpp"

#include <algorithm>
#include <utility>

namespace trussmap::estimation {

void put_processes(RecordingProblem& problem, const std::vector<LaidProcess>& laid,
                   const std::vector<double>& sds) {
  problem.noise_states.clear();
  problem.noise_terms.assign(laid.empty() ? 0 : problem.measurements.size(), {});
  problem.within.assign(laid.empty() ? 0 : problem.measurements.size(), Matrix4::Zero());
  for (std::size_t p = 0; p < laid.size(); ++p) {
    const int first = static_cast<int>(problem.noise_states.size());
    for (NoiseState state : laid[p].states) {
      state.process = static_cast<int>(p);
      if (state.previous >= 0) state.previous += first;
      problem.noise_states.push_back(state);
    }
    for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
      for (NoiseTerm term : laid[p].terms[k]) {
        term.state += first;
        term.by *= sds[p];
        problem.noise_terms[k].push_back(term);
      }
      problem.within[k] += sds[p] * sds[p] * laid[p].within[k];
    }
  }
}

void add_processes(RecordingProblem& problem, const std::vector<DrivenRecording>& recordings,
                   const Model& model) {
  if (model.noise.processes.empty()) return;
  const ProcessLayer layer(problem, recordings, model.robot);
  std::vector<LaidProcess> laid;
  std::vector<double> sds;
  for (const NoiseProcess& one : model.noise.processes) {
    laid.push_back(layer.lay(one.channel, one.process, one.length));
    sds.push_back(one.sd);
  }
  put_processes(problem, laid, sds);
  for (std::size_t k = 0; k < problem.measurements.size(); ++k) {
    Measurement& one = problem.measurements[k];
    one.whitener = whitener_with(one.whitener, problem.within[k], one.rows);
    for (std::size_t p = 0; p < laid.size(); ++p) {
      const NoiseProcess& process = model.noise.processes[p];
      if (!has_used_tails(process) || laid[p].within[k].isZero(0.0)) continue;
      one.tails = one.tails > 0.0 ? std::min(one.tails, process.tails) : process.tails;
    }
  }
}

Vector4 error_by(const Measurement& measurement, const effects::ByView& by_view,
                 const NoiseTerm& term) {
  if (is_driven(measurement)) return -term.by.head<4>();
  return by_view * term.by;
}

Vector4 lasting_in_segment(const RecordingProblem& problem, std::size_t measurement,
                           const Eigen::VectorXd& states) {
  Vector4 sum = Vector4::Zero();
  if (problem.noise_terms.empty() || states.size() == 0) return sum;
  for (const NoiseTerm& term : problem.noise_terms[measurement]) {
    sum += states[term.state] * term.by.head<4>();
  }
  return sum;
}

effects::ViewPattern lasting_in_view(const RecordingProblem& problem, std::size_t measurement,
                                     const effects::ViewPattern& view,
                                     const Eigen::VectorXd& states) {
  effects::ViewPattern sum = view;
  if (problem.noise_terms.empty() || states.size() == 0) return sum;
  for (const NoiseTerm& term : problem.noise_terms[measurement]) {
    const double z = states[term.state];
    sum.ahead += z * term.by[0];
    sum.left += z * term.by[1];
    sum.heading += z * term.by[2];
    sum.range += z * term.by[3];
    sum.range_scale += z * term.by[4];
    sum.bearing += z * term.by[5];
    sum.x += z * term.by[6];
    sum.y += z * term.by[7];
    sum.yaw += z * term.by[8];
  }
  return sum;
}

std::vector<double> state_variances(const RecordingProblem& problem) {
  std::vector<double> variances;
  variances.reserve(problem.noise_states.size());
  for (const NoiseState& state : problem.noise_states) {
    const double before = state.previous < 0 ? 0.0 : variances[idx(state.previous)];
    variances.push_back(state.keep * state.keep * before + state.sd * state.sd);
  }
  return variances;
}

Matrix4 segment_prior_covariance(const RecordingProblem& problem,
                                 const std::vector<double>& variances, std::size_t measurement) {
  Matrix4 result = Matrix4::Zero();
  if (problem.noise_terms.empty()) return result;
  const std::vector<NoiseTerm>& terms = problem.noise_terms[measurement];
  for (const NoiseTerm& a : terms) {
    for (const NoiseTerm& b : terms) {
      double covariance = 0.0;
      if (a.state == b.state) covariance = variances[idx(a.state)];
      for (const auto& [early, late] : {std::pair(a.state, b.state), std::pair(b.state, a.state)}) {
        const NoiseState& state = problem.noise_states[idx(late)];
        if (state.previous == early) covariance = state.keep * variances[idx(early)];
      }
      result += covariance * a.by.head<4>() * b.by.head<4>().transpose();
    }
  }
  return result;
}

}  // namespace trussmap::estimation
