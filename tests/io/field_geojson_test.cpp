// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// Fields over the floor as GeoJSON (RFC 7946).
#include "trussmap/diagnose.hpp"
#include "trussmap/map_files.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace trussmap::field_geojson_test {
namespace {

using nlohmann::json;

constexpr double kNever = std::numeric_limits<double>::quiet_NaN();

TEST(FieldGeojson, HasAClosedAnticlockwiseSquarePerCellThatWasDriven) {
  FieldOfPlaces field;
  field.channel = Channel::compass;
  field.x = 10.0;
  field.y = -2.0;
  field.cell = 0.5;
  field.columns = 3;
  field.rows = 2;
  field.mean = {0.01, kNever, -0.02, 0.0, 0.03, kNever};
  field.sd = {0.001, kNever, 0.002, 0.003, 0.004, kNever};
  const json file = json::parse(format_geojson(field));
  EXPECT_EQ(file["type"], "FeatureCollection");
  ASSERT_EQ(file["features"].size(), 4U);
  for (const json& one : file["features"]) {
    EXPECT_EQ(one["type"], "Feature");
    EXPECT_EQ(one["geometry"]["type"], "Polygon");
    EXPECT_EQ(one["properties"]["channel"], "compass");
    EXPECT_EQ(one["properties"]["unit"], "rad");
    ASSERT_EQ(one["geometry"]["coordinates"].size(), 1U);
    const json& ring = one["geometry"]["coordinates"][0];
    ASSERT_EQ(ring.size(), 5U);
    EXPECT_EQ(ring[0], ring[4]);
    double twice_area = 0.0;  // by the shoelace: above 0 anticlockwise
    for (std::size_t k = 0; k < 4; ++k) {
      twice_area += ring[k][0].get<double>() * ring[k + 1][1].get<double>() -
                    ring[k + 1][0].get<double>() * ring[k][1].get<double>();
    }
    EXPECT_NEAR(twice_area, 2.0 * 0.25, 1e-12);
  }
  // Row by row from the least y, along x: the third feature is the second row's first cell.
  const json& third = file["features"][2];
  EXPECT_DOUBLE_EQ(third["geometry"]["coordinates"][0][0][0].get<double>(), 9.75);
  EXPECT_DOUBLE_EQ(third["geometry"]["coordinates"][0][0][1].get<double>(), -1.75);
  EXPECT_DOUBLE_EQ(third["properties"]["mean"].get<double>(), 0.0);
  EXPECT_DOUBLE_EQ(third["properties"]["sd"].get<double>(), 0.003);
}

}  // namespace
}  // namespace trussmap::field_geojson_test
