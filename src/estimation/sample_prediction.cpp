#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"

#include <vector>

#include <boost/container/small_vector.hpp>

#include "spherical_actuator_calibration/base/rotations.hpp"

namespace sac {
namespace {

/// −T_model [N·m]: the residual of a torque that is zero.
Eigen::Vector3d negativeTorque(const CalibrationModel& model,
                               const Eigen::VectorXd& x,
                               Sample& sample) {
  const ParameterSpace& space = model.space();
  const std::vector<Excitation> excitations = excitedCoils(sample, 0.0);
  boost::container::small_vector<const double*, 32> coils;
  for (const Excitation& excitation : excitations) {
    coils.push_back(x.data() + space.coil(excitation.coil));
  }
  CalibrationModel::TorqueBlocks blocks;
  blocks.joints = x.data();
  blocks.poles = x.data() + space.pole(0);
  blocks.coils = coils.data();
  blocks.effects = x.data() + space.effect();
  sample.torque.setZero();
  return model.torqueResidual(sample, excitations, blocks);
}

}  // namespace

void predictMeasurements(const CalibrationModel& model, const Eigen::VectorXd& x, Sample& sample) {
  if (sample.has_orientation) {
    // y = ln(R_a Rᵀ)^∨ with R_a = 1 gives R = e^{−ŷ}.
    sample.R_stator_rotor.setIdentity();
    sample.R_stator_rotor = rotationExp(
        -model.orientationResidual(sample, {x.data(), x.data() + model.space().effect(), {}, {}}));
  }
  if (sample.has_torque) {
    sample.torque = -negativeTorque(model, x, sample);
  }
}

}  // namespace sac
