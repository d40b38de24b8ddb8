// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// What public headers say of threads: many at once give what one gives, to the bit. ThreadSanitizer
// (make tsan) sees what luck hides.
#include "estimation/simulated_recordings.hpp"
#include "linalg/block_system.hpp"
#include "linalg/dissection.hpp"
#include "scratch_folder.hpp"
#include "trussmap/build_map.hpp"
#include "trussmap/catalogue.hpp"
#include "trussmap/check.hpp"
#include "trussmap/compare.hpp"
#include "trussmap/corrected_odometry.hpp"
#include "trussmap/diagnose.hpp"
#include "trussmap/fit_model.hpp"
#include "trussmap/map_builder.hpp"
#include "trussmap/map_files.hpp"
#include "trussmap/map_store.hpp"
#include "trussmap/pose_graph.hpp"
#include "trussmap/recording_files.hpp"
#include "trussmap/running.hpp"
#include "trussmap/tour_experiment.hpp"
#include "trussmap/write_files.hpp"

#include <atomic>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace trussmap::thread_test {
using namespace linalg;
namespace {

constexpr int kThreads = 4;

/// The same work in every thread, begun at once; what each came to.
template <typename Result>
std::vector<Result> in_threads(const std::function<Result(int)>& work) {
  std::vector<Result> results(kThreads);
  std::atomic<int> ready{0};
  std::vector<std::thread> threads;
  for (int k = 0; k < kThreads; ++k) {
    threads.emplace_back([&, k] {
      ++ready;
      while (ready < kThreads) std::this_thread::yield();
      results[static_cast<std::size_t>(k)] = work(k);
    });
  }
  for (std::thread& one : threads) one.join();
  return results;
}

/// Every thread's text is what the work gives alone.
void expect_alone(const std::function<std::string(int)>& work) {
  const std::string alone = work(0);
  EXPECT_FALSE(alone.empty());
  for (const std::string& one : in_threads<std::string>(work)) EXPECT_EQ(one, alone);
}

struct World {
  Recording recording = testing::simulate_recording({.range_sensor = true, .tours = 1}, 5).read;
  Model model = [] {
    Model result;
    for (const auto& [channel, shape] :
         {std::pair{Channel::turn, "speed"}, std::pair{Channel::compass, "sin(heading)"}}) {
      Effect effect;
      effect.name = shape;
      effect.channel = channel;
      effect.shape = {shape};
      result.effects.push_back(effect);
    }
    return result;
  }();
};

std::string numbers(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += std::to_string(value) + " ";
  return text;
}

std::vector<double> coefficients_of(const ModelFit& fit) {
  std::vector<double> result;
  for (const EffectEstimate& one : fit.effects) {
    result.insert(result.end(), one.effect.coefficients.begin(), one.effect.coefficients.end());
  }
  return result;
}

TEST(Threads, ShareRecordingsAndModels) {
  const World world;
  expect_alone(
      [&](int) { return numbers(coefficients_of(fit_model({world.recording}, world.model))); });
  expect_alone([&](int) { return format_map_graphml(build_map({world.recording}, Model{}).map); });
  expect_alone([&](int) {
    const Comparison result = compare({world.recording}, Model{});
    return numbers({result.chi2, result.p_value});
  });
  expect_alone([&](int) { return fingerprint(world.recording); });
  EXPECT_EQ(in_threads<std::size_t>(
                [&](int) { return check_recordings({world.recording}, &world.model).size(); }),
            std::vector<std::size_t>(kThreads));
}

TEST(Threads, DiagnoseAtOnce) {
  const World world;
  expect_alone([&](int) {
    const Diagnosis result = diagnose({world.recording}, Model{});
    return result.missing + " " + numbers({result.chi2, result.p_value});
  });
}

/// What it gives on one thread and on several.
void expect_same_on_several(const std::function<std::string()>& work) {
  const std::string alone = work();
  EXPECT_FALSE(alone.empty());
  for (const int count : {2, 3, 8}) {
    set_threads(count);
    EXPECT_EQ(work(), alone) << count << " threads";
  }
  set_threads(1);
}

TEST(Threads, ThatACallWorksOnDoNotChangeADigit) {
  const World world;
  expect_same_on_several([&] {
    const ModelFit fit = fit_model({world.recording}, world.model);
    std::string text = fmt::format("{:a} ", fit.chi2);
    for (const FittedLandmark& one : fit.landmarks) text += fmt::format("{:a} ", one.position.x());
    for (const double one : coefficients_of(fit)) text += fmt::format("{:a} ", one);
    return text;
  });
  expect_same_on_several([&] {
    const Diagnosis result = diagnose({world.recording}, Model{});
    std::string text = result.missing;
    for (const Finding& one : result.findings) text += fmt::format(" {:a}", one.p_value);
    for (const NoiseTest& one : result.noise) text += fmt::format(" {:a}", one.score);
    return text;
  });
}

/// Large enough for tiles, and for subtrees of their own.
TEST(Threads, FactoriseAGridToTheSameDigits) {
#ifdef __SANITIZE_THREAD__
  constexpr int kSide = 60;
#else
  constexpr int kSide = 200;
#endif
  std::vector<Vector2> positions;
  std::vector<NodePair> pairs;
  for (int row = 0; row < kSide; ++row) {
    for (int column = 0; column < kSide; ++column) {
      const int node = row * kSide + column;
      positions.emplace_back(column, row);
      if (column > 0) pairs.push_back({node - 1, node});
      if (row > 0) pairs.push_back({node - kSide, node});
    }
  }
  const std::vector<int> sizes(positions.size(), 2);
  BlockSystem K(sizes, pairs, dissection_order(positions, pairs), Kernel::frontal);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    Matrix2 stiffness;
    stiffness << 2.0 + 0.1 * static_cast<double>(k % 7), 0.3, 0.3, 1.0;
    K.add_diagonal(pairs[k][0], stiffness);
    K.add_diagonal(pairs[k][1], stiffness);
    K.add_coupling(static_cast<int>(k), Matrix2(-stiffness));
  }
  K.add_diagonal(0, Matrix2(Matrix2::Identity()));
  const Eigen::MatrixXd b = Eigen::MatrixXd::Random(K.unknowns(), 70);
  const auto solved = [&] {
    K.factorise();
    return Eigen::MatrixXd(K.solve(b));
  };
  const Eigen::MatrixXd alone = solved();
  for (const int count : {2, 3, 8}) {
    set_threads(count);
    EXPECT_TRUE((solved().array() == alone.array()).all()) << count << " threads";
  }
  // Of two that break down the first in the order of elimination is named, as by one thread.
  K.set_diagonal(-K.diagonal());
  const auto broken_at = [&] {
    try {
      K.factorise();
    } catch (const NotPositiveDefinite& failure) {
      return failure.column();
    }
    return -2;
  };
  const int on_several = broken_at();
  set_threads(1);
  EXPECT_EQ(on_several, broken_at());
  EXPECT_GE(on_several, 0);
}

TEST(Threads, ReadOneMapAndGrowTheirOwn) {
  MapBuilder shared;
  const auto grow = [](MapBuilder& builder) {
    builder.start("dock");
    for (int k = 0; k < 60; ++k) {
      const double side = k % 4 < 2 ? 5.0 : -5.0;
      const Vector2 d = k % 2 == 0 ? Vector2(side, 0.1) : Vector2(0.1, side);
      builder.arrive(k % 4 == 3 ? "dock" : "corner " + std::to_string(k % 4),
                     {d, 0.01 * Matrix2::Identity()});
    }
  };
  grow(shared);
  expect_alone([&](int) {
    std::string text = format_map_graphml(shared.map());
    for (int k = 0; k < shared.landmarks(); ++k) text += numbers({shared.position(k).x()});
    return text + std::to_string(shared.here()) + std::to_string(*shared.find("corner 1"));
  });
  for (const Method method : {Method::elastic, Method::gauss_markov}) {
    expect_alone([&](int) {
      MapBuilder own({.method = method});
      grow(own);
      return format_map_graphml(own.map());
    });
  }
}

TEST(Threads, ReadAndUseOneShape) {
  const World world;
  expect_alone([&](int) {
    const Shape own("sin(heading) + 1");
    std::string text = own.text();
    for (const Effect& one : world.model.effects) {
      const Shape copy = one.shape.front();
      text += copy.text() + std::to_string(copy.speaks_of("speed"));
    }
    return text;
  });
  const Drive& drive = world.recording.drive;
  expect_alone([&](int) {  // as many robots of one model
    Model model = world.model;
    for (Effect& one : model.effects) one.coefficients = {0.01};
    CorrectedOdometry odometry(model, {.compass = true});
    Pose pose;
    for (std::size_t row = 0; row < drive.rows(); ++row) {
      pose =
          odometry
              .drive({drive.duration(row), drive.left[row], drive.right[row], drive.heading[row]},
                     {})
              .pose.pose;
    }
    return numbers({pose.x, pose.y, pose.heading});
  });
}

TEST(Threads, WriteAndReadFilesOfTheirOwn) {
  const testing::ScratchFolder scratch;
  const World world;
  expect_alone([&](int k) {
    const auto folder = scratch.path() / ("rec" + std::to_string(k));
    write_recording(folder, world.recording, "");
    write_file(scratch.path() / ("text" + std::to_string(k)), "text");
    return fingerprint(read_recording(folder)) +
           read_file(scratch.path() / ("text" + std::to_string(k)));
  });
}

TEST(Threads, OneWritesAStoreWhileOthersRead) {
  const testing::ScratchFolder scratch;
  const auto file = scratch.path() / "map.db";
  const auto leg = [](double x, double y) { return Traversal{{x, y}, 0.01 * Matrix2::Identity()}; };
  {
    MapStore store(file);
    store.start("A");
    store.arrive("B", leg(1.0, 0.0));
  }
  const std::vector<int> fine = in_threads<int>([&](int k) {  // bits would share a word
    if (k == 0) {
      MapStore store(file);
      for (int lap = 0; lap < 20; ++lap) {
        store.arrive("A", leg(-1.0, 0.1));
        store.arrive("B", leg(1.0, 0.1));
      }
      return store.legs() == 42 ? 1 : 0;
    }
    std::int64_t legs = 2;
    for (int round = 0; round < 20; ++round) {
      const StoredMap read = read_map_store(file);
      if (read.legs < legs || read.map.landmarks() != 2) return 0;
      if (read.map.route(0).traversals != read.legs - 1) return 0;  // never a mixture
      legs = read.legs;
    }
    return 1;
  });
  EXPECT_EQ(fine, std::vector<int>(kThreads, 1));
}

TEST(Threads, AdjustPoseGraphsAtOnce) {
  PoseGraph graph = parse_g2o(
      "EDGE_SE2 0 1 1 0 1.57 100 0 0 100 0 100\nEDGE_SE2 1 2 1 0 1.57 100 0 0 100 0 100\n"
      "EDGE_SE2 2 3 1 0 1.57 100 0 0 100 0 100\nEDGE_SE2 3 0 1 0.1 1.57 100 0 0 100 0 100\n",
      "a square");
  expect_alone([&](int) { return numbers({adjust(graph).chi2}); });
}

/// They make threads of their own besides.
TEST(Threads, TourAtOnce) {
  TourOptions options;
  options.mesh = even_mesh({3, 3}, 1.0);
  options.tours = 2;
  options.seeds = 5;
  expect_alone([&](int) {
    std::string text;
    for (const MethodMetrics& tour : run_tours(options).tours) {
      for (const auto& [method, metrics] : tour) text += numbers({metrics.stretch_error.mean});
    }
    return text;
  });
}

}  // namespace
}  // namespace trussmap::thread_test
