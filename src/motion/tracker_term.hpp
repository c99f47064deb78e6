#pragma once

#include <Eigen/Core>

#include "motion_point.hpp"
#include "motion_span.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"

namespace sac {

/// Misfit of the tracker's orientations at their own stamps less its delay, with the readings of
/// the joints there: y = ln(R_a R(q(t))ᵀ)^∨ [rad].
class TrackerTerm {
 public:
  TrackerTerm(const CalibrationModel& model, const MotionPlaces& places, const Eigen::VectorXd& x);

  /// False where readings are missing.
  bool evaluate(const MotionSpan& span, std::size_t orientation);
  const Eigen::Vector3d& residual() const { return residual_; }
  /// By all coordinates.
  const ResidualJacobian& jacobian() const { return jacobian_; }
  /// By the time at which joint k, counted from 0, is asked for [rad/s].
  Eigen::Vector3d byTime(std::size_t k) const {
    return rates_[static_cast<Eigen::Index>(k)] * jacobian_.col(space_.joint(k));
  }
  /// Of the joints then [rad].
  const Eigen::Vector3d& reading() const { return sample_.joint_position; }
  /// True time of the orientation, by the clock of the joints [s].
  double time() const { return time_; }

 private:
  const ParameterSpace& space_;
  const MotionPlaces& places_;
  ModelPoint point_;
  double delay_ = 0.0;
  double scale_ = 0.0;  ///< of the coordinate of the delay [s]
  double time_ = 0.0;
  Sample sample_;
  Eigen::Vector3d rates_ = Eigen::Vector3d::Zero();  ///< of the joints [rad/s]
  Eigen::Vector3d residual_ = Eigen::Vector3d::Zero();
  ResidualJacobian jacobian_;
};

}  // namespace sac
