#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/actuator/description_file.hpp"
#include "spherical_actuator_calibration/base/atomic_file.hpp"
#include "spherical_actuator_calibration/calibration/calibration_config.hpp"
#include "spherical_actuator_calibration/calibration/tracked_pose.hpp"
#include "spherical_actuator_calibration/estimation/estimation_problem.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// The poses of samples whose "orientation" is that of the marker in the tracker; samples without
/// one are left out.
std::vector<TrackedPose> trackedPoses(const std::vector<Sample>& samples);

/// No fewer different poses are registered from: three would do, but could not show a mistake.
inline constexpr std::size_t kLeastRegistrationPoses = 6;
/// Poses that are no further apart count as one [rad].
inline constexpr double kSamePose = 0.05;

/// Where tracker and marker sit. Small rotations of the two frames are (ξ, ζ), six components: the
/// true frames are e^{ξ̂} R_stator_tracker, ξ in stator axes, and e^{ζ̂} R_rotor_marker, ζ in rotor
/// axes [rad].
struct FrameRegistration {
  using Covariance = FrameCovariance;

  bool success = false;
  std::string message;             ///< a sentence: what was found, or why nothing, and what to do
  std::vector<std::string> notes;  ///< what an operator should know, one sentence each
  Eigen::Matrix3d R_stator_tracker = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R_rotor_marker = Eigen::Matrix3d::Identity();
  /// Against the frames of the drawing [rad²]: of the measurements' noise, and of what the
  /// description leaves open of joint axes and offsets, which is common to all poses.
  Covariance covariance = Covariance::Zero();
  Covariance noise_covariance = Covariance::Zero();  ///< the measurements' part of it
  double residual_rms = 0.0;                         ///< norm of the residuals [rad]
  double reduced_chi_square = 0.0;
  std::size_t poses_used = 0;
  std::vector<RegisteredPose> poses;
};

/// Finds tracker and marker from poses of the rotor: R(q) R_rotor_marker = R_stator_tracker
/// R_tracker_marker (doc/registration.md). Turning the tracker and all joint axes alike changes no
/// pose, so the frames are those in which the description's joints are where it says they are:
/// manufacturing tolerances, or its stated uncertainty, are common errors of the result and are in
/// its covariance.
///
/// Refuses (success false) fewer than kLeastRegistrationPoses different poses, poses that are
/// turned about one axis alone, two solutions half a turn apart that fit alike, and poses that
/// contradict the mechanism or each other. Outliers are left out and told. Throws ConfigError when
/// the options are not valid.
FrameRegistration registerFrames(const CalibratedDescription& description,
                                 const std::vector<TrackedPose>& poses,
                                 const EstimationOptions& options);

/// Throws ConfigError where the description has no joints, which registration is by.
void requireJoints(const CalibratedDescription& description);

/// How many of the poses differ from each other by more than kSamePose.
std::size_t differentPoses(const CalibratedDescription& description,
                           const std::vector<TrackedPose>& poses);

/// "0 0 0 qx qy qz qw" for the launch arguments stator_tracker and rotor_marker. Their translations
/// move pictures only.
std::string launchArgument(const Eigen::Matrix3d& rotation);

/// Its covariance [rad²], row by row as "[c11, c12, …]", for
/// registration/tracker_and_marker/covariance of the configuration.
std::string covarianceArgument(const FrameRegistration& registration);

/// Writes what was found as YAML (doc/registration.md). Throws DataError when the file exists and
/// must not be replaced, or cannot be written.
void saveFrameRegistration(const std::string& path,
                           const Actuator& actuator,
                           const FrameRegistration& registration,
                           OverwritePolicy overwrite);

}  // namespace sac
