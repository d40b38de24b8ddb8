// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Who should factorise a truss's stiffness matrix: solve_truss's work by our frontal kernel and by
// CHOLMOD, on trusses of all sizes.
//
//   grid   n x n joints, bars between neighbours
//   city   the same, every joint tied to one neighbour before it, to others by chance, some
//          diagonals: 2.6 ends of bars per joint, blocks of many sizes
//
//   frontal            approximate minimum degree of the joints (by CHOLMOD), our kernel
//   CHOLMOD            the same order, CHOLMOD's factorisation
//   CHOLMOD, its own   CHOLMOD's analysis of the matrix as it is, once
//
// And for the corrections of an elastic map, grids again:
//
//   all       a bar changes, the whole comes to equilibrium: the live factor updated, or CHOLMOD
//             factorises the new matrix (its analysis kept)
//   nearest   a piece of 7 x 7 joints, another one at every arrival: our band matrix, or CHOLMOD,
//             with its analysis and without
//
// Rivals take turns in this process; processor time; the median of the paired ratios counts.
#include "linalg/band_cholesky.hpp"
#include "linalg/block_system.hpp"
#include "truss/truss_system.hpp"
#include "trussmap/running.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <functional>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace trussmap::bench {
using namespace truss;
using namespace linalg;
namespace {

struct Structure {
  int joints = 0;
  std::vector<NodePair> ends;
  std::vector<Matrix2> stiffnesses;
  std::vector<Vector2> forces;
};

Structure structure_of(int side, bool city, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  Structure result;
  result.joints = side * side;
  const auto bar = [&](int i, int j) {
    const Matrix2 R = rotation(normal(random));
    result.ends.push_back({i, j});
    result.stiffnesses.emplace_back(R * Vector2(400.0, 1111.0).asDiagonal() * R.transpose());
  };
  for (int k = 0; k < result.joints; ++k) {
    const int column = k % side;
    const int row = k / side;
    const bool by_left = column > 0 && (row == 0 || chance(random) < 0.5);
    if (column > 0 && (!city || by_left || chance(random) < 0.35)) bar(k - 1, k);
    if (row > 0 && (!city || !by_left || chance(random) < 0.35)) bar(k - side, k);
    if (city && row > 0 && column > 0 && chance(random) < 0.08) bar(k - side - 1, k);
    result.forces.emplace_back(normal(random), normal(random));
  }
  return result;
}

double cpu() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void assemble(TrussSystem& K, const Structure& truss) {
  for (std::size_t k = 0; k < truss.ends.size(); ++k) {
    K.add_bar(static_cast<int>(k), truss.stiffnesses[k]);
  }
}

std::vector<bool> first_held(int joints) {
  std::vector<bool> held(idx(joints), false);
  held[0] = true;
  return held;
}

/// Each returns a displacement, in which they must agree.
double in_minimum_degree(const Structure& truss, Kernel kernel) {
  TrussSystem K(first_held(truss.joints), truss.ends, elimination_order(truss.joints, truss.ends),
                kernel);
  assemble(K, truss);
  K.factorise();
  return K.solve(truss.forces).back().x();
}

double in_cholmods_own(const Structure& truss) {
  std::vector<int> order(idx(truss.joints));
  for (int k = 0; k < truss.joints; ++k) order[idx(k)] = k;
  TrussSystem K(first_held(truss.joints), truss.ends, order, Kernel::cholmod);
  assemble(K, truss);
  SparseCholesky cholesky(Ordering::amd);
  cholesky.analyse(K.matrix());
  cholesky.factorise(K.matrix());
  Eigen::VectorXd u = Eigen::VectorXd::Zero(K.matrix().cols());
  for (int joint = 1; joint < truss.joints; ++joint) {
    u.segment<2>(K.offset(joint)) = truss.forces[idx(joint)];
  }
  cholesky.solve_in_place(u);
  return u[K.offset(truss.joints - 1)];
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

struct Rival {
  const char* name;
  std::function<double()> work;
};

/// Milliseconds, and over the first rival's; all must answer alike.
void race(const std::string& what, const std::vector<Rival>& rivals, int rounds, int repeats) {
  std::vector<std::vector<double>> times(rivals.size());
  for (int round = 0; round < rounds; ++round) {
    double answer = 0.0;
    for (std::size_t k = 0; k < rivals.size(); ++k) {
      const double begin = cpu();
      double found = 0.0;
      for (int n = 0; n < repeats; ++n) found = rivals[k].work();
      times[k].push_back((cpu() - begin) / repeats);
      if (k == 0) answer = found;
      if (!(std::abs(found - answer) <= 1e-6 * std::abs(answer))) {
        throw std::runtime_error("rivals answer otherwise");
      }
    }
  }
  fmt::print("{}:", what);
  for (std::size_t k = 0; k < rivals.size(); ++k) {
    std::vector<double> ratios;
    for (std::size_t n = 0; n < times[k].size(); ++n) ratios.push_back(times[k][n] / times[0][n]);
    const auto [least, most] = std::minmax_element(ratios.begin(), ratios.end());
    fmt::print("  {} {:.4f} ms", rivals[k].name, 1e3 * median(times[k]));
    if (k > 0) fmt::print(", {:.2f} ({:.2f} to {:.2f}) of that", median(ratios), *least, *most);
  }
  fmt::print("\n");
}

void compare(int side, bool city, int rounds) {
  const Structure truss = structure_of(side, city, 1);
  race(fmt::format("{} of {} joints, {} bars", city ? "city" : "grid", truss.joints,
                   truss.ends.size()),
       {{"frontal", [&] { return in_minimum_degree(truss, Kernel::frontal); }},
        {"CHOLMOD", [&] { return in_minimum_degree(truss, Kernel::cholmod); }},
        {"CHOLMOD, its own", [&] { return in_cholmods_own(truss); }}},
       rounds, std::max(1, 20000 / truss.joints));
}

/// A bar becomes stiffer by a rank of 2 and the whole is solved.
void compare_corrections(int side, int rounds) {
  const Structure truss = structure_of(side, false, 1);
  TrussSystem K(first_held(truss.joints), truss.ends, elimination_order(truss.joints, truss.ends),
                Kernel::cholmod);
  assemble(K, truss);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(K.matrix().cols());
  const std::size_t bar = truss.ends.size() / 2;
  for (int c = 0; c < 2; ++c) {
    f[K.offset(truss.ends[bar][0]) + c] = 1.0;
    f[K.offset(truss.ends[bar][1]) + c] = -1.0;
  }
  SparseCholesky live(Ordering::fixed);
  live.analyse(K.matrix());
  live.factorise(K.matrix());
  SparseCholesky anew(Ordering::fixed);
  anew.analyse(K.matrix());
  SparseMatrix W(K.matrix().cols(), 2);
  for (int c = 0; c < 2; ++c) {
    W.insert(K.offset(truss.ends[bar][0]) + c, c) = 1e-6;  // small: the answer stays
    W.insert(K.offset(truss.ends[bar][1]) + c, c) = -1e-6;
  }
  W.makeCompressed();
  race(fmt::format("correction of all among {} joints", truss.joints),
       {{"updated",
         [&] {
           live.update(W);
           Eigen::VectorXd u = f;
           live.solve_updated(u);
           return u.sum() + u.cwiseAbs().maxCoeff();
         }},
        {"CHOLMOD",
         [&] {
           anew.factorise(K.matrix());
           Eigen::VectorXd u = f;
           anew.solve_in_place(u);
           return u.sum() + u.cwiseAbs().maxCoeff();
         }}},
       rounds, std::max(1, 20000 / truss.joints));
}

void compare_pieces(int rounds) {
  const int side = 7;
  const Structure truss = structure_of(side, false, 1);
  std::vector<int> order;
  for (int k = 0; k < truss.joints; ++k) order.push_back(k);
  TrussSystem K(first_held(truss.joints), truss.ends, order, Kernel::cholmod);
  assemble(K, truss);
  const SparseMatrix& lower = K.matrix();
  const auto n = static_cast<int>(lower.cols());
  const Eigen::VectorXd f = Eigen::VectorXd::LinSpaced(n, -1.0, 1.0);
  BandMatrix band;
  const auto by_cholmod = [&](SparseCholesky& cholesky) {
    cholesky.factorise(lower);
    Eigen::VectorXd u = f;
    cholesky.solve_in_place(u);
    return u.sum();
  };
  SparseCholesky kept(Ordering::amd);
  kept.analyse(lower);
  race("correction of a piece of 49 joints",
       {{"band",
         [&] {
           band.resize(n, 2 * side + 1);
           for (int column = 0; column < n; ++column) {
             for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry) {
               band.add(static_cast<int>(entry.row()), column, entry.value());
             }
           }
           band.factorise(1e-13);
           Eigen::VectorXd u = f;
           band.solve_in_place(u);
           return u.sum();
         }},
        {"CHOLMOD, analysis and all",
         [&] {
           SparseCholesky cholesky(Ordering::amd);
           cholesky.analyse(lower);
           return by_cholmod(cholesky);
         }},
        {"CHOLMOD, without its analysis", [&] { return by_cholmod(kept); }}},
       rounds, 2000);
}

}  // namespace
}  // namespace trussmap::bench

int main(int argc, char** argv) {
  try {
    std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);
    CLI::App app("solve_truss by our frontal kernel and by CHOLMOD");
    std::vector<int> sides{6, 10, 18, 32, 56, 100, 178, 316, 1000};
    int rounds = 7;
    app.add_option("--sides", sides, "joints along a side")->capture_default_str();
    app.add_option("--rounds", rounds)->check(CLI::PositiveNumber)->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    trussmap::set_threads(1);
    trussmap::bench::compare_pieces(rounds);
    for (const int side : {10, 32, 100}) trussmap::bench::compare_corrections(side, rounds);
    for (const int side : sides) {
      for (const bool city : {false, true}) trussmap::bench::compare(side, city, rounds);
    }
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
