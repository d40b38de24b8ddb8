// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// How much faster two threads are than one, by the clock, in one run: each in turn, the least of
// several. Digits are compared as well.
#include "linalg/block_system.hpp"
#include "linalg/dissection.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/model_file.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/running.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <exception>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

extern "C" void openblas_set_num_threads(int threads) __attribute__((weak));

namespace {

using namespace trussmap;

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// `work` leaves its figures as text.
void compare_threads(const std::string& what, int rounds,
                     const std::function<std::string()>& work) {
  std::array<double, 2> least{};
  least.fill(std::numeric_limits<double>::infinity());
  std::array<std::string, 2> figures;
  for (int round = 0; round < rounds; ++round) {
    for (const std::size_t k : {0U, 1U}) {
      set_threads(static_cast<int>(k) + 1);
      least[k] = std::min(least[k], seconds_of([&] { figures[k] = work(); }));
    }
  }
  fmt::print("{}: one thread {:.3f} s, two {:.3f} s, {:.2f} times as fast; digits {}\n", what,
             least[0], least[1], least[0] / least[1],
             figures[0] == figures[1] ? "the same" : "DIFFER");
}

/// The stiffness matrix of a square grid.
linalg::BlockSystem grid(int side) {
  std::vector<Vector2> positions;
  std::vector<linalg::NodePair> pairs;
  for (int row = 0; row < side; ++row) {
    for (int column = 0; column < side; ++column) {
      const int node = row * side + column;
      positions.emplace_back(column, row);
      if (column > 0) pairs.push_back({node - 1, node});
      if (row > 0) pairs.push_back({node - side, node});
    }
  }
  std::vector<int> sizes(positions.size(), 2);
  sizes[0] = 0;
  linalg::BlockSystem K(sizes, pairs, linalg::dissection_order(positions, pairs),
                        linalg::Kernel::frontal);
  Matrix2 stiffness;
  stiffness << 2.0, 0.3, 0.3, 1.0;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    K.add_diagonal(pairs[k][0], stiffness);
    K.add_diagonal(pairs[k][1], stiffness);
    K.add_coupling(static_cast<int>(k), Matrix2(-stiffness));
  }
  return K;
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app("Two threads against one");
  int side = 1000;
  app.add_option("--side", side, "of the grid that is factorised")->capture_default_str();
  std::vector<std::string> folders;
  app.add_option("--recordings", folders, "folders of one robot, to be diagnosed");
  std::string model_file;
  app.add_option("--model", model_file, "what is believed of it");
  int rounds = 3;
  app.add_option("--rounds", rounds)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  {
    linalg::BlockSystem K = grid(side);
    compare_threads(fmt::format("factorisation of a grid {0} x {0}", side), rounds, [&K] {
      K.factorise();
      return fmt::format("{:a}", K.log_determinant());
    });
  }
  if (!folders.empty()) {
    std::vector<DrivenRecording> recordings;
    for (const std::string& folder : folders)
      recordings.push_back(with_wheels(read_recording(folder), Robot()));
    const Model model = model_file.empty() ? Model{} : read_model(model_file);
    compare_threads("diagnose", rounds, [&] {
      const Diagnosis result = diagnose(recordings, model);
      std::string text = result.missing;
      for (const Finding& one : result.findings) text += fmt::format(" {:a}", one.p_value);
      return text;
    });
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "{}\n", error.what());
  return 1;
}
