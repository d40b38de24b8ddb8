// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Writes a grid of landmarks as g2o, any number of them, for adjust --solver petsc: what a robot
// with a compass brings home that has driven every route once.
//
//   routes      5 m long, measured with standard deviations of 5 % along and 3 % across, turned
//               a little so that covariances are full
//   positions   dead reckoned: up the first column, then along the rows
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

constexpr double kSpacing = 5.0;  // m
constexpr double kAlong = 0.05 * kSpacing;
constexpr double kAcross = 0.03 * kSpacing;
constexpr double kTurn = 0.3;  // rad, of a covariance's axes
constexpr std::size_t kChunk = std::size_t{1} << 24U;

struct Options {
  int columns = 100;
  int rows = 100;
  std::uint64_t seed = 1;
  std::string file;
};

/// A measured route and its information.
struct Route {
  double dx;
  double dy;
  double xx;
  double xy;
  double yy;
};

class Writer {
 public:
  explicit Writer(const std::string& path) : file_(std::fopen(path.c_str(), "w")) {
    if (file_ == nullptr) throw std::runtime_error(path + ": cannot be written");
  }
  ~Writer() {
    if (file_ != nullptr) std::fclose(file_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  template <typename... Values>
  void line(fmt::format_string<const Values&...> format, const Values&... values) {
    fmt::format_to(std::back_inserter(text_), format, values...);
    if (text_.size() >= kChunk) flush();
  }
  void close() {
    flush();
    const bool written = std::fclose(file_) == 0;
    file_ = nullptr;
    if (!written) throw std::runtime_error("the file cannot be written");
  }

 private:
  void flush() {
    if (std::fwrite(text_.data(), 1, text_.size(), file_) != text_.size()) {
      throw std::runtime_error("the file cannot be written");
    }
    text_.clear();
  }

  std::FILE* file_;
  fmt::memory_buffer text_;
};

class Robot {
 public:
  explicit Robot(std::uint64_t seed) : random_(seed) {}

  /// From (0, 0) to (x, y), along an axis.
  Route measure(double x, double y) {
    const double heading = std::atan2(y, x) + kTurn * normal_(random_);
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    const double along = kAlong * normal_(random_);
    const double across = kAcross * normal_(random_);
    const double stiff = 1.0 / (kAlong * kAlong);
    const double soft = 1.0 / (kAcross * kAcross);
    return {x + c * along - s * across, y + s * along + c * across, c * c * stiff + s * s * soft,
            c * s * (stiff - soft), s * s * stiff + c * c * soft};
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

void write_grid(const Options& options) {
  Robot robot(options.seed);
  const auto columns = static_cast<std::size_t>(options.columns);
  const auto rows = static_cast<std::size_t>(options.rows);
  std::vector<Route> right(columns * rows);
  std::vector<Route> up(columns * rows);
  for (std::size_t k = 0; k < columns * rows; ++k) {
    right[k] = robot.measure(kSpacing, 0.0);
    up[k] = robot.measure(0.0, kSpacing);
  }
  Writer out(options.file);
  std::array<double, 2> begin{};
  for (std::size_t row = 0; row < rows; ++row) {
    std::array<double, 2> at = begin;
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t k = row * columns + column;
      out.line("VERTEX_XY {} {:.6f} {:.6f}\n", k, at[0], at[1]);
      at = {at[0] + right[k].dx, at[1] + right[k].dy};
    }
    begin = {begin[0] + up[row * columns].dx, begin[1] + up[row * columns].dy};
  }
  const auto route = [&out](std::size_t from, std::size_t to, const Route& one) {
    out.line("EDGE_POINTXY {} {} {:.6f} {:.6f} {:.7g} {:.7g} {:.7g}\n", from, to, one.dx, one.dy,
             one.xx, one.xy, one.yy);
  };
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t k = row * columns + column;
      if (column + 1 < columns) route(k, k + 1, right[k]);
      if (row + 1 < rows) route(k, k + columns, up[k]);
    }
  }
  out.close();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    CLI::App app("Writes a grid of landmarks and measured routes as g2o");
    Options options;
    app.add_option("columns", options.columns)->required()->check(CLI::PositiveNumber);
    app.add_option("rows", options.rows)->required()->check(CLI::PositiveNumber);
    app.add_option("file", options.file)->required();
    app.add_option("--seed", options.seed)->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    write_grid(options);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
