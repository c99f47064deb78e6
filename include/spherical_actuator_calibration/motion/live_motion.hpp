#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/motion/motion_options.hpp"
#include "spherical_actuator_calibration/motion/motion_slice.hpp"

namespace sac {

/// When an estimate begins, and what is kept for it.
struct LiveMotionOptions {
  std::size_t first_windows = 24;  ///< nothing is told before
  /// The newest ones can be linearised anew. What older ones told stays as it was.
  std::size_t kept_windows = 200;
  /// By so many standard deviations the derivatives of old places may mislead the estimate.
  double tolerance = 0.1;
};

/// What is known after the last window.
struct LiveEstimate {
  bool is_told = false;  ///< else `belief` is the prior
  ParameterBelief belief;
  std::size_t windows = 0;   ///< that came
  std::size_t left_out = 0;  ///< of them: they contradict the others
  double duration = 0.0;     ///< of those that serve [s]
  std::size_t orientations = 0;
  double chi_square = 0.0;  ///< reduced, of the windows that serve; 0: not known
  int linearizations = 0;   ///< of all windows that are kept
};

/// The estimate from motion while it goes on (doc/motion.md): each window adds its information, and
/// estimate and covariance follow from the sum. Where the estimate has moved so far that the
/// derivatives of old windows mislead it, those that are kept are linearised anew. The first
/// estimate is estimateMotion() of the windows until then. Memory does not grow with the motion.
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
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace sac
