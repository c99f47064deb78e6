#include "spherical_actuator_calibration/study/torque_matrix_error.hpp"

#include <limits>

#include <Eigen/SVD>

#include "spherical_actuator_calibration/actuator/spherical_joint.hpp"
#include "spherical_actuator_calibration/actuator/torque_curve.hpp"
#include "spherical_actuator_calibration/actuator/torque_model.hpp"
#include "spherical_actuator_calibration/base/error.hpp"
#include "spherical_actuator_calibration/base/pseudo_inverse.hpp"

namespace sac {
namespace {

/// Torque matrix of an actuator as a function of its joint sensors.
class TorqueMatrix {
 public:
  explicit TorqueMatrix(const Actuator& actuator)
      : joints_(jointGeometry(actuator)),
        torques_(torqueGeometry(actuator)),
        curve_(*actuator.torque_curve) {}

  Eigen::Matrix3Xd at(const Eigen::Vector3d& q) const {
    return torquePerAmpere(curve_, torques_, rotorOrientation(joints_, q));
  }

 private:
  JointGeometry joints_;
  TorqueGeometry torques_;
  TorqueCurve curve_;
};

}  // namespace

std::vector<TorqueMatrixError> torqueMatrixErrors(const Actuator& truth,
                                                  const Actuator& model,
                                                  const std::vector<Eigen::Vector3d>& poses) {
  validate(truth);
  validate(model);
  if (!truth.hasTorqueModel() || !model.hasTorqueModel() ||
      truth.coils.size() != model.coils.size()) {
    throw ConfigError("Both actuators need poles, a torque curve and as many coils.");
  }
  const TorqueMatrix true_matrix(truth);
  const TorqueMatrix model_matrix(model);
  std::vector<TorqueMatrixError> errors;
  errors.reserve(poses.size());
  for (const Eigen::Vector3d& q : poses) {
    const Eigen::Matrix3Xd Q_true = true_matrix.at(q);
    const Eigen::MatrixXd inverse = pseudoInverse(model_matrix.at(q));
    const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::MatrixXd>(Q_true).singularValues();
    const Eigen::Matrix3d difference = Q_true * inverse - Eigen::Matrix3d::Identity();
    errors.push_back(
        {Eigen::JacobiSVD<Eigen::Matrix3d>(difference).singularValues()[0],
         values[2],
         values[2] > 0.0 ? values[0] / values[2] : std::numeric_limits<double>::infinity()});
  }
  return errors;
}

}  // namespace sac
