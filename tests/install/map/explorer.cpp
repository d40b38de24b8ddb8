// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// A robot drives three times round a block of 10 m by 6 m and back, and maps it on the way; then
// from what it recorded; then as a pose graph.
#include <trussmap/build_map.hpp>
#include <trussmap/map_builder.hpp>
#include <trussmap/pose_graph.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace {

using namespace trussmap;

constexpr double kWheelbase = 0.34;  // m
const Vector2 kCorners[] = {{0.0, 0.0}, {10.0, 0.0}, {10.0, 6.0}, {0.0, 6.0}};
const char* const kNames[] = {"dock", "door", "stairs", "window"};

bool near(const Vector2& a, const Vector2& b) {
  return (a - b).norm() < 1e-6;
}

bool maps_on_the_way(Method method) {
  MapBuilder builder({.method = method});
  builder.start(kNames[0]);
  for (int leg = 0; leg < 12; ++leg) {
    const int from = leg % 4;
    const int to = (leg + 1) % 4;
    builder.arrive(kNames[to], {kCorners[to] - kCorners[from], 0.01 * Matrix2::Identity()});
  }
  for (int k = 0; k < 4; ++k) {
    if (!near(builder.position(*builder.find(kNames[k])), kCorners[k])) return false;
  }
  return true;
}

/// Straight on in rows of 0.5 m, turns on the spot in rows of 0.1 rad and a rest.
Recording drive_round_the_block() {
  Recording recording;
  recording.name = "round the block";
  Drive& drive = recording.drive;
  double t = 0.0;
  const auto row = [&](double left, double right) {
    t += 0.5;
    drive.t.push_back(t);
    drive.left.push_back(left);
    drive.right.push_back(right);
  };
  recording.sightings.push_back({0.0, kNames[0], kAbsent, kAbsent});
  for (int leg = 0; leg < 12; ++leg) {
    const double length = (kCorners[(leg + 1) % 4] - kCorners[leg % 4]).norm();
    for (int k = 0; k < 20; ++k) row(length / 20.0, length / 20.0);
    recording.sightings.push_back({t, kNames[(leg + 1) % 4], kAbsent, kAbsent});
    const double wheel = 0.5 * kWheelbase * 0.5 * std::numbers::pi / 16.0;
    for (int k = 0; k < 16; ++k) row(-wheel, wheel);
  }
  return recording;
}

bool maps_a_recording(Method method) {
  const BuiltMap built = build_map({drive_round_the_block()}, Model{}, {.method = method});
  for (int k = 0; k < 4; ++k) {
    if (!near(built.map.landmark(*built.map.find(kNames[k])).position, kCorners[k])) return false;
  }
  return built.legs == 12;
}

bool adjusts_a_pose_graph() {
  PoseGraph graph;
  for (int k = 0; k < 4; ++k) graph.vertices.push_back({k, VertexKind::pose, std::nullopt, false});
  for (int k = 0; k < 4; ++k) {
    const double length = (kCorners[(k + 1) % 4] - kCorners[k]).norm();
    graph.pose_edges.push_back(
        {k, (k + 1) % 4, {length, 0.0, 0.5 * std::numbers::pi}, Matrix3::Identity()});
  }
  return adjust(graph).chi2 < 1e-12;
}

}  // namespace

int main() {
  int failed = 0;
  const auto expect = [&failed](bool right, const std::string& what) {
    std::printf("%s: %s\n", what.c_str(), right ? "right" : "WRONG");
    failed += right ? 0 : 1;
  };
  for (const Method method : {Method::elastic, Method::elastic_printed, Method::gauss_markov}) {
    expect(maps_on_the_way(method), "on the way, " + name_of(method));
    expect(maps_a_recording(method), "from a recording, " + name_of(method));
  }
  expect(maps_a_recording(Method::adjustment), "from a recording, adjustment");
  expect(adjusts_a_pose_graph(), "pose graph");
  return failed;
}
