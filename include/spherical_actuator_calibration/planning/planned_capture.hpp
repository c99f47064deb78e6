#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/coil_pattern.hpp"
#include "spherical_actuator_calibration/measurement/sample.hpp"

namespace sac {

/// What is captured at one time: a pattern of a planned pose, without current where it has no coil.
struct PlannedCapture {
  Eigen::Vector3d joint_position = Eigen::Vector3d::Zero();  ///< raw sensor angles q [rad]
  CoilPattern pattern;
  double current = 0.0;  ///< commanded in each coil of the pattern, > 0 [A]
};

/// Why a sample does not serve the capture that it was made for.
enum class CaptureFlaw {
  kNone,
  kExcitation,   ///< there is none: coils do not carry what is commanded
  kOrientation,  ///< it has none
  kCurrents,     ///< of another pattern
  kTorque,       ///< it has none, though it has current
  kPose,         ///< away from it
  kRest,         ///< no sample without current is held of its rest
};

/// The first coil, counted from 0, that does not carry what the capture has it commanded, none for
/// most; nothing where all do. `measured` [A], one per coil.
std::optional<std::size_t> coilAmiss(const PlannedCapture& planned,
                                     const Eigen::VectorXd& measured,
                                     double current_threshold);

/// Judges a sample that is not held yet. What acts without current is taken off the torques of its
/// rest: where no held sample of that rest is without current, they still contain it.
CaptureFlaw captureFlaw(const Sample& sample,
                        const PlannedCapture& planned,
                        const std::vector<Sample>& held,
                        double current_threshold);

/// excitation, orientation, currents, torque, pose, rest, as in the service CapturePlanned; empty
/// for none.
std::string flawName(CaptureFlaw flaw);
/// What the operator is to see to, in a sentence; empty for none.
std::string flawInWords(CaptureFlaw flaw);
/// The same of a coil that does not carry what the capture has it commanded, see coilAmiss().
std::string amissInWords(const PlannedCapture& planned, std::size_t coil);

/// For how long to average [s], where a pattern with current takes `duration`: three times as long
/// without, but at most `longest`, as all torques of the rest share the error of what is measured
/// then. A `duration` beyond `longest` stays what it is.
double captureDuration(const PlannedCapture& planned, double duration, double longest);

}  // namespace sac
