// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What a map store costs: opening it after a short and after a long history of the same map, and a
// leg that is kept at once.
#include "trussmap/map_store.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <random>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using namespace trussmap;
namespace fs = std::filesystem;

double seconds_of(const auto& work) {
  const auto begun = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
}

/// A robot on a square grid of landmarks, 1 m apart: every route once, then at random.
class Driver {
 public:
  explicit Driver(int side) : side_(side) {}

  template <typename Builder>
  void drive(Builder& builder) {
    if (builder_is_new_) builder.start(name());
    builder_is_new_ = false;
    const int next = step();
    const Vector2 along((next % side_) - (here_ % side_), (next / side_) - (here_ / side_));
    const Vector2 error(0.03 * normal_(random_), 0.03 * normal_(random_));
    here_ = next;
    builder.arrive(name(), {along + error, 0.0009 * Matrix2::Identity()});
  }

 private:
  [[nodiscard]] std::string name() const { return "landmark " + std::to_string(here_); }

  int step() {
    if (toured_ < side_ * side_ - 1) {  // row after row, to and fro
      const int row = ++toured_ / side_;
      const int column = toured_ % side_;
      return row * side_ + (row % 2 == 0 ? column : side_ - 1 - column);
    }
    while (true) {
      const int turn = std::uniform_int_distribution<int>(0, 3)(random_);
      const int x = here_ % side_ + (turn == 0 ? 1 : turn == 1 ? -1 : 0);
      const int y = here_ / side_ + (turn == 2 ? 1 : turn == 3 ? -1 : 0);
      if (x >= 0 && y >= 0 && x < side_ && y < side_) return y * side_ + x;
    }
  }

  int side_;
  int here_ = 0;
  int toured_ = 0;
  bool builder_is_new_ = true;
  std::mt19937_64 random_{1};
  std::normal_distribution<double> normal_;
};

double opening(const fs::path& file) {
  double least = 1e9;
  for (int round = 0; round < 5; ++round) {
    least = std::min(least, seconds_of([&] { const MapStore store(file); }));
  }
  return least;
}

void run(const fs::path& file, int side, std::int64_t legs) {
  Driver driver(side);
  MapStore store(file);
  double first = 0.0;
  for (std::int64_t kept = 0; kept < legs;) {
    const std::int64_t more = kept == 0 ? 10'000 : 9 * kept;
    const double seconds = seconds_of([&] {
      store.append(std::to_string(kept), "a session", [&](MapBuilder& builder) {
        for (std::int64_t k = 0; k < more; ++k) driver.drive(builder);
      });
    });
    kept += more;
    store = MapStore(fs::path(file.string() + ".other.db"));  // lets go of the file
    const double open = opening(file);
    if (first == 0.0) first = open;
    store = MapStore(file);
    fmt::print(
        "{:>9} legs of {} landmarks, {:.0f} us each in one session: opened in {:.1f} ms, {:.2f} "
        "times the first; {:.0f} MB\n",
        kept, store.builder().landmarks(), 1e6 * seconds / static_cast<double>(more), 1e3 * open,
        open / first, static_cast<double>(fs::file_size(file)) / 1e6);
  }
  constexpr int kSingle = 1000;
  const double alone = seconds_of([&] {
    for (int k = 0; k < kSingle; ++k) driver.drive(store);
  });
  fmt::print("a leg that is kept at once: {:.0f} us\n", 1e6 * alone / kSingle);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    CLI::App app("Opening a map store after a short and a long history, and keeping a leg");
    fs::path folder = fs::temp_directory_path();
    int side = 32;
    std::int64_t legs = 1'000'000;
    app.add_option("--folder", folder, "Where the store is made (and removed)");
    app.add_option("--side", side, "Landmarks along a side of the grid");
    app.add_option("--legs", legs, "Legs at most: 10^4, 10^5, ...");
    CLI11_PARSE(app, argc, argv);
    const fs::path scratch =
        folder / ("trussmap_store_bench." + std::to_string(std::random_device()()));
    fs::create_directories(scratch);
    run(scratch / "map.db", side, legs);
    fs::remove_all(scratch);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
