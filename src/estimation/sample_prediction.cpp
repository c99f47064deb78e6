#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {

void predictMeasurements(const ModelPoint& point, Sample& sample) {
  if (sample.has_orientation) {
    // y = ln(R_a Rᵀ)^∨ with R_a = 1 gives R = e^{−ŷ}.
    sample.R_stator_rotor.setIdentity();
    sample.R_stator_rotor = rotationExp(-point.orientationResidual(sample));
  }
  if (sample.has_torque) {
    // The residual of a torque that is zero is the model's, negative.
    sample.torque.setZero();
    sample.torque = -point.torqueResidual(sample, excitedCoils(sample, 0.0));
  }
}

}  // namespace sac
