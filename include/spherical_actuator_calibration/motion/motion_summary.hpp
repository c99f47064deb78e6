#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/estimation/estimate.hpp"
#include "spherical_actuator_calibration/motion/motion_streams.hpp"

namespace sac {

/// Windows that did not serve, for one reason.
struct WindowsLeftOut {
  std::string reason;
  std::size_t count = 0;
};

/// How windows that did not serve agree with what was found without them. Then they serve, too.
struct HeldOutMotion {
  std::size_t windows = 0;
  std::size_t rejected = 0;  ///< beside them: they contradict as outliers do, and never serve
  std::size_t orientations = 0;
  double orientation_rms = 0.0;  ///< norm of the rotation error, with the tracker's noise [rad]
  double torque_rms = 0.0;       ///< norm of the mean torque error of a window [N·m]
  /// Squared misfit over the number of residuals, with the noise of the streams and the common
  /// uncertainty of the parameters: 1 on average when both are as stated.
  double reduced_chi_square = 0.0;
  double probability = 1.0;  ///< of such a misfit, or a larger one, when they are
  /// Of each window but the rejected ones; the index of the sample is that of the window.
  std::vector<ObservationResidual> residuals;
};

/// Of the means of orientations over windows.
struct WindowMeansMisfit {
  double squares = 0.0;  ///< χ²
  double freedom = 0.0;
  /// Reduced χ² that the noise of readings may make of them: neighbours have it in common where
  /// joints are read as seldom as the tracker.
  double expected = 1.0;
  double next_alike = 0.0;  ///< correlation of the means of neighbouring windows
  double alike = 0.0;       ///< the largest of means up to six windows apart, either sign

  double reduced() const { return freedom > 0.0 ? squares / freedom : 0.0; }
  /// Whether they are larger than chance makes them once in a thousand times.
  bool isMisfit() const;
};

/// Whitened residuals of windows by how fast they change. Those of noise are alike; what a model
/// lacks is slow, and where it passes for noise of the currents the fast ones are too small.
struct ResidualPace {
  double slow = 0.0;     ///< mean square with the slower half of the test functions
  double fast = 0.0;     ///< with the faster half
  double freedom = 0.0;  ///< values in each

  /// Of noise that is as much slower, by chance. What parameters take from the slow ones is not
  /// given back: it is too large rather than too small.
  double probability() const;
};

/// How far residuals of windows move what is estimated: Σ sᵀ N⁻¹ s over that of noise, with the
/// slopes s = Jᵀr of single windows and the information N of all. Noise that is as stated makes it
/// 1. Where it is another within windows, as where currents step between their readings or a clock
/// jumps, windows can fit as well as noise and yet mislead: estimates err by its root more.
struct ResidualAlignment {
  double ratio = 1.0;
  double chance = 0.0;  ///< standard deviation of it by noise alone, at the most

  /// What noise hardly exceeds, nor do recordings in which messages are lost.
  double limit() const { return 1.0 + 4.0 * chance; }
  bool isMisfit() const { return ratio > limit(); }
  /// Factor on the variance of what windows tell.
  double variance() const { return isMisfit() ? ratio : 1.0; }
};

/// A friction that the model lacks, and what the residuals tell of it.
struct OtherFriction {
  const char* law = "";   ///< "that grows with …"
  const char* unit = "";  ///< of both
  double value = 0.0;
  double stddev = 0.0;
};

/// What an error that the model lacks does to an estimate, which knows nothing of it.
struct EstimateShift {
  std::string most_shifted;  ///< of the parameters of joints, poles and coils
  double shift = 0.0;        ///< of it, in its standard deviations
  /// Of all of these together, in standard deviations, by their common covariance.
  double distance = 0.0;
};

/// By how much later than joint 1 the others seem to be read, where the estimate counts all as read
/// at once.
struct JointSkew : EstimateShift {
  Eigen::Vector2d value = Eigen::Vector2d::Zero();       ///< of joints 2 and 3 [s]
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of both; zero: nothing is told

  bool isTold() const { return covariance(0, 0) > 0.0; }
};

/// An error of sensors or of the torque curve that the model lacks, as large as the residuals tell
/// where there is no other.
struct UnmodelledError : EstimateShift {
  enum class Kind {
    kTurn,          ///< of a joint's readings once a turn: with their sine and cosine [rad]
    kScale,         ///< that grows over a joint's range, and with its square: at its ends [rad]
    kCurve,         ///< the torque curve is wider in angle by this share [1]
    kTrackerDrift,  ///< about the axes of the stator: one after the other in each shape [rad]
    kCurrentClock,  ///< stamps of the currents that drift, in each shape [s]
    kTrackerClock,  ///< of the tracker [s]
  };
  Kind kind = Kind::kTurn;
  std::size_t joint = 0;  ///< counted from 0, of kTurn and kScale
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

/// What became of a recording of motion.
struct MotionSummary {
  double duration = 0.0;    ///< of the windows that served [s]
  std::size_t windows = 0;  ///< cut from the recording
  std::size_t used = 0;     ///< that served
  std::size_t values = 0;   ///< residuals of a window
  std::vector<WindowsLeftOut> left_out;
  std::size_t orientations = 0;           ///< of the tracker, that served
  std::size_t orientations_rejected = 0;  ///< outliers
  // Noise as the streams themselves tell it.
  Eigen::Vector3d joint_stddev = Eigen::Vector3d::Zero();  ///< [rad]
  double current_stddev = 0.0;                             ///< [A]
  double orientation_stddev = 0.0;                         ///< per component [rad]
  /// How currents follow commands, in the longest span where these tell it.
  std::optional<CommandResponse> response;
  HeldOutMotion held_out;
  double window_chi_square = 0.0;       ///< reduced, of the windows that served
  double orientation_chi_square = 0.0;  ///< reduced, of means over windows: 1 without drift
};

}  // namespace sac
