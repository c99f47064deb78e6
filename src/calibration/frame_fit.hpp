#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/calibration/tracked_pose.hpp"
#include "spherical_actuator_calibration/estimation/calibration_model.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/estimation/model_point.hpp"
#include "spherical_actuator_calibration/estimation/whitened_observation.hpp"

namespace sac {

/// Tracker in stator and marker in rotor.
struct Frames {
  Eigen::Matrix3d R_stator_tracker = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_rotor_marker = Eigen::Matrix3d::Identity();
};

/// Both turned by half a turn about one axis, so that the pose with this orientation fits as
/// before.
Frames turnedByHalf(const Frames& frames,
                    const Eigen::Vector3d& axis_stator,
                    const Eigen::Matrix3d& R_stator_rotor);
/// The larger one of the angles between the two trackers and the two markers [rad].
double angleBetween(const Frames& a, const Frames& b);

/// Which poses take part.
using PoseSelection = std::vector<bool>;

/// Least squares of R(q) R_rotor_marker = R_stator_tracker R_tracker_marker over both frames and
/// what the description leaves open of the machine: coordinates x = root · w with w ~ N(0, 1).
class FrameFit {
 public:
  struct Solution {
    Frames frames;
    Eigen::VectorXd w;  ///< of the machine, in standard deviations
    double cost = 0.0;  ///< χ² of measurements and of w; as many degrees of freedom as 3 n − 6
  };
  struct Judgement {
    FrameCovariance covariance;
    FrameCovariance noise_covariance;
    std::vector<RegisteredPose> poses;  ///< all of them; rejected: takes no part
    /// By how much χ² falls without the pose; three degrees of freedom. Zero where it takes no
    /// part.
    std::vector<double> gain;
  };

  /// Keeps references to `poses` and `options`.
  FrameFit(const CalibratedDescription& description,
           const std::vector<TrackedPose>& poses,
           const EstimationOptions& options);

  /// In closed form, with the machine as it is described: the rotations next to the matrices that
  /// maximise Σ tr(R_stator_trackerᵀ R(q) R_rotor_marker R_tracker_markerᵀ) (Shah 2013).
  Frames start(const PoseSelection& used) const;
  /// From a start, by Levenberg–Marquardt. `noise_scale`: factor of all noise.
  Solution solve(const Frames& start, const PoseSelection& used, double noise_scale) const;
  Judgement judge(const Solution& solution, const PoseSelection& used, double noise_scale) const;

  /// R(q) of the description.
  const std::vector<Eigen::Matrix3d>& orientations() const { return R_stator_rotor_; }

 private:
  class Objective;
  struct Row {
    Eigen::Vector3d residual;      ///< as measured [rad]
    WhitenedObservation whitened;  ///< in all unknowns (ξ, ζ, w)
  };
  /// Where the derivatives of a residual are taken: those at the measurement lead to the least sum
  /// of squares. In information they count what a turn of the whole machine does to the residuals
  /// themselves, which tells nothing of it, and which grows with the number of poses.
  enum class Linearized { kAtMeasurement, kAtPrediction };
  ModelPoint pointOf(const Solution& at) const { return {model_, root_ * at.w}; }
  Row row(const ModelPoint& point,
          const Frames& frames,
          std::size_t pose,
          double noise_scale,
          Linearized at) const;
  Eigen::Index unknowns() const { return 6 + root_.cols(); }

  const std::vector<TrackedPose>& poses_;
  const EstimationOptions& options_;
  CalibrationModel model_;
  Eigen::MatrixXd root_;
  std::vector<Eigen::Matrix3d> R_stator_rotor_;
};

}  // namespace sac
