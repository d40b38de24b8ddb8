// SPDX-FileCopyrightText: 2026 The trussmap authors
// SPDX-License-Identifier: MIT
#include "trussmap/corrected_odometry.hpp"

#include "fit/online_odometry.hpp"

namespace trussmap {

class __attribute__((visibility("hidden"))) CorrectedOdometry::State
    : public fitting::OnlineOdometry {
 public:
  using fitting::OnlineOdometry::OnlineOdometry;
};

CorrectedOdometry::CorrectedOdometry(const Model& model, const OdometryInputs& inputs)
    : state_(std::make_unique<State>(model, inputs)) {}
CorrectedOdometry::~CorrectedOdometry() = default;
CorrectedOdometry::CorrectedOdometry(CorrectedOdometry&&) noexcept = default;
CorrectedOdometry& CorrectedOdometry::operator=(CorrectedOdometry&&) noexcept = default;

CorrectedRow CorrectedOdometry::drive(const WheelRow& row, std::span<const double> covariates) {
  return state_->drive(row, covariates);
}
const PoseEstimate& CorrectedOdometry::pose() const {
  return state_->pose();
}
void CorrectedOdometry::reset() {
  state_->reset();
}
void CorrectedOdometry::set_map_pose(const Pose& pose_map) {
  state_->set_map_pose(pose_map);
}
CorrectedSighting CorrectedOdometry::corrected(const Sighting& sighting) const {
  return state_->corrected(sighting);
}

}  // namespace trussmap
