#include "spherical_actuator_calibration/control/calibrated_actuator.hpp"

#include <utility>

#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pseudo_inverse.hpp"

namespace sac {
namespace {

void requireFinite(const Eigen::Ref<const Eigen::VectorXd>& values, const char* what) {
  if (!values.allFinite()) {
    throw DataError(std::string(what) + ": a number is not finite.");
  }
}

}  // namespace

CalibratedActuator::CalibratedActuator(CalibratedDescription description)
    : description_(std::move(description)),
      predictor_(description_),
      geometry_(torqueGeometry(description_.actuator)) {
  if (description_.actuator.hasTorqueModel()) {
    curve_.emplace(*description_.actuator.torque_curve);
  }
}

CalibratedActuator CalibratedActuator::load(const std::string& path) {
  return CalibratedActuator(loadDescription(path));
}

void CalibratedActuator::requireTorqueModel() const {
  if (!hasTorqueModel()) {
    throw DataError("Without poles, coils and torque curve in the description there is no torque.");
  }
}

Predictor::Orientation CalibratedActuator::orientation(const Eigen::Vector3d& reading) const {
  requireFinite(reading, "joint angles");
  if (!hasJoints()) {
    throw DataError("The rotor has no joints: its orientation is measured, not predicted.");
  }
  return predictor_.orientation(reading);
}

Predictor::Torque CalibratedActuator::torque(const Eigen::Vector3d& reading,
                                             const Eigen::VectorXd& currents) const {
  requireTorqueModel();
  requireFinite(reading, "joint angles");
  requireFinite(currents, "currents");
  if (currents.size() != static_cast<Eigen::Index>(coils())) {
    throw DataError("There are " + std::to_string(currents.size()) + " currents for " +
                    std::to_string(coils()) + " coils.");
  }
  return predictor_.torque(reading, currents);
}

CalibratedActuator::Currents CalibratedActuator::currents(const Eigen::Vector3d& torque,
                                                          const Eigen::Vector3d& reading,
                                                          const AllocationOptions& options) const {
  requireTorqueModel();
  requireFinite(torque, "torque");
  const Eigen::Matrix3Xd Q =
      torquePerAmpere(*curve_, geometry_, predictor_.orientation(reading).R_stator_rotor);
  const AllocatedCurrents allocated = allocateCurrents(Q, torque, options);
  Currents result;
  result.outcome = allocated.outcome;
  result.currents = allocated.currents;
  const Predictor::Torque made = predictor_.torque(reading, allocated.currents);
  result.torque = made.torque;
  result.torque_stddev = made.stddev;
  // What is missing of the torque would come from Q⁺ times it.
  const Eigen::MatrixXd Q_inverse = pseudoInverse(Q);
  result.stddev = ((Q_inverse * made.covariance).cwiseProduct(Q_inverse).rowwise().sum())
                      .cwiseMax(0.0)
                      .cwiseSqrt();
  return result;
}

}  // namespace sac
