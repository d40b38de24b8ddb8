// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
//
// CorrectedOdometry: a model on the robot.
#include "arrays.hpp"
#include "docs.hpp"
#include "inputs.hpp"
#include "parts.hpp"
#include "rows.hpp"
#include "trussmap/corrected_odometry.hpp"

#include <utility>

namespace trussmap::python {
namespace {

/// Pose and covariance.
py::tuple tuple_of(const PoseEstimate& estimate) {
  const Pose& pose = estimate.pose;
  return py::make_tuple(py::make_tuple(pose.x, pose.y, pose.heading),
                        array_of(estimate.covariance));
}

Pose pose_of(const py::object& values) {
  const auto three = matrix<Eigen::Vector3d>(values, "pose");
  return {three[0], three[1], three[2]};
}

WheelRow row_of(double duration, double left, double right, std::optional<double> compass,
                std::optional<double> yaw_rate, const std::vector<double>& readings) {
  WheelRow row;
  row.duration = duration;
  row.left = left;
  row.right = right;
  row.compass = compass.value_or(kAbsent);
  row.yaw_rate = yaw_rate.value_or(kAbsent);
  row.readings = readings;
  return row;
}

}  // namespace

void add_corrected_odometry(py::module_& module) {
  py::class_<CorrectedRow>(module, "CorrectedRow", "A row of wheels, corrected.")
      .def_property_readonly(
          "motion",
          [](const CorrectedRow& self) {
            const Pose& moved = self.motion.displacement;
            return py::make_tuple(moved.x, moved.y, moved.heading);
          },
          doc("CorrectedRow.motion"))
      .def_property_readonly(
          "motion_covariance",
          [](const CorrectedRow& self) { return array_of(self.motion.covariance); },
          "Of (x, y, heading) of the motion.")
      .def_property_readonly(
          "pose",
          [](const CorrectedRow& self) {
            const Pose& pose = self.pose.pose;
            return py::make_tuple(pose.x, pose.y, pose.heading);
          },
          doc("CorrectedRow.pose"))
      .def_property_readonly(
          "covariance", [](const CorrectedRow& self) { return array_of(self.pose.covariance); },
          "Of (x, y, heading) of the pose.")
      .def("__repr__", [](const CorrectedRow& self) {
        const Pose& pose = self.pose.pose;
        return "CorrectedRow(pose=(" + std::to_string(pose.x) + ", " + std::to_string(pose.y) +
               ", " + std::to_string(pose.heading) + "))";
      });
  py::class_<CorrectedOdometry>(module, "CorrectedOdometry",
                                doc("A model on the robot: its odometry corrected row by row, as "
                                    "the wheels turn.",
                                    "CorrectedOdometry")
                                    .c_str())
      .def(py::init([](const Model& model, std::vector<std::string> covariates, bool compass,
                       bool gyro) {
             return std::make_unique<CorrectedOdometry>(
                 model, OdometryInputs{std::move(covariates), compass, gyro});
           }),
           py::arg("model"), py::kw_only(), py::arg("covariates") = std::vector<std::string>(),
           py::arg("compass") = false, py::arg("gyro") = false)
      .def(
          "drive",
          [](CorrectedOdometry& self, double duration, double left, double right,
             std::optional<double> compass, std::optional<double> yaw_rate,
             const std::vector<double>& readings, const std::vector<double>& covariates) {
            return self.drive(row_of(duration, left, right, compass, yaw_rate, readings),
                              covariates);
          },
          py::arg("duration"), py::arg("left") = 0.0, py::arg("right") = 0.0, py::kw_only(),
          py::arg("compass") = py::none(), py::arg("yaw_rate") = py::none(),
          py::arg("readings") = std::vector<double>(),
          py::arg("covariates") = std::vector<double>(), doc("CorrectedOdometry.drive"))
      .def_property_readonly(
          "pose", [](const CorrectedOdometry& self) { return tuple_of(self.pose()); },
          "((x, y, heading), covariance) as the last row left them.")
      .def("reset", &CorrectedOdometry::reset, doc("CorrectedOdometry.reset"))
      .def(
          "set_map_pose",
          [](CorrectedOdometry& self, const py::object& pose) { self.set_map_pose(pose_of(pose)); },
          py::arg("pose"), doc("CorrectedOdometry.set_map_pose"))
      .def(
          "corrected",
          [](const CorrectedOdometry& self, double t, std::optional<double> range,
             std::optional<double> bearing) {
            Sighting sighting;
            sighting.t = t;
            sighting.range = range.value_or(kAbsent);
            sighting.bearing = bearing.value_or(kAbsent);
            const CorrectedSighting result = self.corrected(sighting);
            py::dict row;
            row["t"] = result.sighting.t;
            row["range"] = result.sighting.range;
            row["bearing"] = result.sighting.bearing;
            row["sensor"] = array_of(result.sensor_robot);
            return row;
          },
          py::arg("t"), py::arg("range") = py::none(), py::arg("bearing") = py::none(),
          doc("CorrectedOdometry.corrected"))
      .def("__repr__",
           [](const CorrectedOdometry&) { return std::string("<trussmap.CorrectedOdometry>"); });
}

}  // namespace trussmap::python
