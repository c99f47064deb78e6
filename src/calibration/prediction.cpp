#include "spherical_actuator_calibration/calibration/prediction.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "covariance_record.hpp"
#include "spherical_actuator_calibration/actuator/rotor_dynamics.hpp"
#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/estimation/sample_prediction.hpp"

namespace sac {
namespace {

constexpr double kComponents = 3.0;

/// Of three components that follow from the parameters.
Eigen::Matrix3d covarianceOf(const ResidualJacobian& jacobian, const Eigen::MatrixXd& parameters) {
  return jacobian * parameters * jacobian.transpose();
}

double rootMeanVariance(double sum) {
  return std::sqrt(std::max(0.0, sum) / kComponents);
}

std::shared_ptr<const CalibrationModel> modelOf(const CalibratedDescription& description) {
  return std::make_shared<const CalibrationModel>(
      ParameterSpace(description.actuator, effectsOf(description.calibration)));
}

}  // namespace

Predictor::Predictor(const CalibratedDescription& description)
    : model_(modelOf(description)),
      point_(*model_, Eigen::VectorXd::Zero(model_->space().size())),
      covariance_(machineCovariance(model_->space(), description, false)),
      loaded_covariance_(machineCovariance(model_->space(), description, true)) {}

Predictor::Orientation Predictor::orientation(const Eigen::Vector3d& reading) const {
  Sample sample;
  sample.joint_position = reading;
  if (model_->space().joints() == 0) {
    return {point_.orientation(sample), 0.0, true};
  }
  sample.has_orientation = true;
  predictMeasurements(point_, sample);
  ResidualJacobian jacobian;
  point_.orientationResidual(sample, &jacobian);
  double variance = covarianceOf(jacobian, covariance_).trace();
  Orientation result;
  result.R_stator_rotor = sample.R_stator_rotor;
  const Actuator& actuator = model_->space().nominal();
  if (actuator.orientation_map) {
    const OrientationMap::Uncertainty map = actuator.orientation_map->uncertainty(reading);
    variance += map.of_rotor.sum();
    result.is_supported = map.support >= kLeastMapSupport;
  }
  result.stddev = rootMeanVariance(variance);
  return result;
}

Predictor::Torque Predictor::torque(const Eigen::Vector3d& reading,
                                    const Eigen::VectorXd& current) const {
  return torqueOfCoils(reading, current, covariance_);
}

Predictor::Torque Predictor::loadedTorque(const Eigen::Vector3d& reading,
                                          const Eigen::VectorXd& current) const {
  Torque result = torqueOfCoils(reading, current, loaded_covariance_);
  const Eigen::Vector3d& unbalance = model_->space().nominal().unbalance;
  result.torque += unbalance.cross(gravityDirection(orientation(reading).R_stator_rotor));
  return result;
}

Predictor::Torque Predictor::torqueOfCoils(const Eigen::Vector3d& reading,
                                           const Eigen::VectorXd& current,
                                           const Eigen::MatrixXd& covariance) const {
  Sample sample;
  sample.joint_position = reading;
  sample.current = current;
  const std::vector<Excitation> excitations = excitedCoils(sample, 0.0);
  ResidualJacobian jacobian;
  Torque result;
  result.torque = -point_.torqueResidual(sample, excitations, &jacobian);
  result.covariance = covarianceOf(jacobian, covariance);
  const Actuator& actuator = model_->space().nominal();
  if (actuator.orientation_map) {
    // A rotation error ξ acts on the torque as offsets do: ∂T/∂ξ = (∂T/∂offsets)(∂ξ/∂offsets)⁻¹.
    const OrientationMap::Uncertainty map = actuator.orientation_map->uncertainty(reading);
    const JointLinearization joints = linearizeRotorOrientation(jointGeometry(actuator), reading);
    Eigen::Matrix3d d_offset;
    for (std::size_t k = 0; k < kJoints; ++k) {
      d_offset.col(static_cast<Eigen::Index>(k)) = jacobian.col(model_->space().joint(k));
    }
    const Eigen::Matrix3d d_rotation =
        joints.d_offset.transpose().fullPivLu().solve(d_offset.transpose()).transpose();
    result.covariance += d_rotation * map.of_rotor.asDiagonal() * d_rotation.transpose();
  }
  result.stddev = rootMeanVariance(result.covariance.trace());
  return result;
}

}  // namespace sac
