#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/motion/live_estimate.hpp"
#include "spherical_actuator_calibration/motion/motion_options.hpp"
#include "spherical_actuator_calibration/motion/motion_slice.hpp"

namespace sac {

class LiveMotionWork;

/// The estimate from motion while it goes on (doc/motion.md): each window adds its information, and
/// estimate and covariance follow from the sum. Where the estimate has moved so far that the
/// derivatives of old windows mislead it, those that are kept are linearised anew. The first
/// estimate is estimateMotion() of the newest windows until then. Memory does not grow with the
/// motion.
///
/// Other than estimateMotion(), the prior counts as a measurement, and nothing is held out: the
/// last word has the cycle.
class LiveMotion {
 public:
  /// Keeps a reference to the model, which has the effects of withMotionEffects(). `free`:
  /// coordinates to estimate, ascending. Precondition: the model has a torque model.
  LiveMotion(const CalibrationModel& model,
             ParameterBelief prior,
             std::vector<Eigen::Index> free,
             const EstimationOptions& estimation,
             const MotionOptions& options = {},
             const LiveMotionOptions& live = {});
  LiveMotion(LiveMotion&& other) noexcept;
  LiveMotion& operator=(LiveMotion&& other) noexcept;
  ~LiveMotion();

  void add(MotionSlice slice);
  const LiveEstimate& estimate() const;

 private:
  std::unique_ptr<LiveMotionWork> work_;
};

}  // namespace sac
