#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "spherical_actuator_calibration/measurement/sample.hpp"
#include "wiring_case.hpp"

namespace sac {

// Mistakes of the force/torque sensor, of currents, coils and poles, one function each. Coils and
// poles count from 0. Torques that are in the stator's frame are turned by the measured
// orientation, or where there is none by that of the joint angles.

Hypothesis torqueFrame(const Eigen::Matrix3d& rotation);
/// Any rotation: it starts at `rotation_vector`.
Hypothesis torqueRotation(const Eigen::Vector3d& rotation_vector, double tolerance);
Hypothesis torqueInStatorFrame();
Hypothesis torqueSign();
Hypothesis currentSign();
/// Torque that is a factor too large or small, by its start; and currents likewise.
Hypothesis torqueUnit(double factor, double tolerance);
Hypothesis currentUnit(double factor, double tolerance);
/// Currents belong to the coil that is `steps` further.
Hypothesis coilShift(std::size_t steps);
Hypothesis coilSign(std::size_t coil);
Hypothesis coilSwap(std::size_t first, std::size_t second);
/// What is recorded as one of these coils flows in the next, and of the last in the first.
Hypothesis coilCircle(const std::vector<std::size_t>& coils);
Hypothesis coilDead(std::size_t coil);
Hypothesis coilGain(std::size_t coil, double gain, double tolerance);
Hypothesis polePolarity(std::size_t pole);
Hypothesis poleMissing(std::size_t pole);
/// A pole that is weaker or stronger by a factor, by its start.
Hypothesis poleGain(std::size_t pole, double gain, double tolerance);

/// Rotor orientation of a sample as good as it is known: measured, else by the nominal joints.
Eigen::Matrix3d knownOrientation(const Actuator& actuator, const Sample& sample);

}  // namespace sac
