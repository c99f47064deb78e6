#include "spherical_actuator_calibration/motion/live_motion.hpp"

#include <utility>

#include "live_motion_work.hpp"

namespace sac {

LiveMotion::LiveMotion(const CalibrationModel& model,
                       ParameterBelief prior,
                       std::vector<Eigen::Index> free,
                       const EstimationOptions& estimation,
                       const MotionOptions& options,
                       const LiveMotionOptions& live)
    : work_(std::make_unique<LiveMotionWork>(
          model, std::move(prior), std::move(free), estimation, options, live)) {}

LiveMotion::LiveMotion(LiveMotion&& other) noexcept = default;
LiveMotion& LiveMotion::operator=(LiveMotion&& other) noexcept = default;
LiveMotion::~LiveMotion() = default;

void LiveMotion::add(MotionSlice slice) {
  work_->add(std::move(slice));
}

const LiveEstimate& LiveMotion::estimate() const {
  return work_->estimate();
}

}  // namespace sac
